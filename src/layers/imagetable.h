/* The half-space lattice, h = 1: what the grid's Stokes solve gives at a face per unit source above one wall, without
   inertia and with viscosity 1 (docs/nearfield.md, Walls). In mode theta along the wall the wall adds

       psi(j) = (A + B j) e^{-mu j},      mu = 2 asinh(sin(theta/2)),

   to the stream function of the free lattice, A and B such that both velocities are zero on the wall. The integral over
   theta is tabulated for rows of response and source and offsets along the wall. Nothing crosses ranks. */
#pragma once
#include "layers/imageform.h"
#include "layers/stencilsums.h"

#define IMAGE_CELLS 20 /* from a marker to another one's image, up to which stencils are summed if one is folded, */
#define IMAGE_OFF 14   /* and if both are off the wall */
#define IMAGE_ROWS 25  /* rows from the wall: t at row + 1/2, n at row (0 on the wall, zero) */
#define IMAGE_SHIFT 28 /* largest offset along the wall */
#define IMAGE_WIDTH (2 * IMAGE_SHIFT + 1)

/* Parts of a force's image seen from a wall, response and source: tangential and normal to it. */
enum { IMAGE_TT, IMAGE_NN, IMAGE_NT, IMAGE_TN, IMAGE_PARTS };

/* Velocity per unit source by part (ImagePlaces), rows of response and source and the offset along the wall, entry of
   the response minus that of the source as in the free lattice's table, with the wall along x. */
typedef struct {
  PetscReal value[IMAGE_MOST_PARTS][IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH];
} ImageTable;

/* A mode along the wall: k, s, sinh mu, cosh mu, and by row from row 0 F = g1 - s g2, g2 and e^{-mu j} (imagetable.c).
 */
#define IMAGE_LINES (IMAGE_ROWS + 2)
#define IMAGE_NODES 64 /* of Gauss and Legendre; 50 give the same to rounding, 40 to 6e-13 */
typedef struct {
  PetscReal k, s, sinh, cosh, F[IMAGE_LINES], g2[IMAGE_LINES], e[IMAGE_LINES];
} ImageMode;

/* ImagePsi - psi(j) = (A + B j) e^{-mu j} of A and of minus the sum of psi's next neighbours, psi(1) - psi(-1) = -jump.
   Not collective. */
PETSC_EXTERN void ImagePsi(const ImageMode *mode, PetscReal A, PetscReal jump, PetscReal psi[IMAGE_LINES]);

/* A block of a table of the half-space lattice. Of psi a response along the wall has the difference from its row to the
   next, minus that with half = 1, one across it has k psi; along the wall, i the offset, times cos(i theta) or, with
   half = -1 or 1, sin((i + half/2) theta). ImageBlockFill - all its rows. Not collective. */
typedef struct {
  void (*psi)(const ImageMode *mode, int source, int row, PetscReal psi[IMAGE_LINES]); /* of a source in this row */
  const OffsetTable *lattice; /* the free lattice's, of a reach of IMAGE_SHIFT at least */
  int source;                 /* the block in it */
  int component;              /* of the response: 0 along the wall, 1 across it */
  int half;
  int below;       /* off the offset across the wall in the lattice's table */
  PetscReal level; /* of all entries */
} ImageBlock;
PETSC_EXTERN PetscErrorCode ImageBlockFill(const ImageBlock *block,
                                           PetscReal value[IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH]);

/* The parts of a pair seen from a wall: where each is in x and y by the direction of the wall's normal, which are odd
   in the distance from the wall and change their sign at the upper end, and what meets in each: the component of the
   response, 0 along the wall, 1 across it, and the number of the source: 0 along (x or xx), 1 across, 2 xy. ImageTurn -
   out += alpha times parts seen from a wall, 2 times the direction of its normal plus its side. Not collective. */
typedef struct {
  int parts, place[2][IMAGE_MOST_PARTS];
  PetscBool odd[IMAGE_MOST_PARTS];
  int response[IMAGE_MOST_PARTS], source[IMAGE_MOST_PARTS];
} ImagePlaces;
static inline void ImageTurn(const ImagePlaces *p, int wall, PetscReal alpha, const PetscReal part[], PetscReal out[]) {
  for (int q = 0; q < p->parts; q++) out[p->place[wall / 2][q]] += (wall % 2 && p->odd[q] ? -alpha : alpha) * part[q];
}

/* A stencil at a wall: its rows from the wall, folded, and the stencil itself, which counts along the wall. */
typedef struct {
  PetscInt first, n;
  const PetscReal *weight;
  const PaddedStencil *along;
} ImageRows;

/* ImageSum - the sum of a table over the rows of a response and a source and over their stencils along the wall, in
   direction t, whose markers are x cells apart there. Not collective. */
PETSC_EXTERN PetscReal ImageSum(const PetscReal (*table)[IMAGE_ROWS][IMAGE_WIDTH], Grid grid, int t, PetscReal x,
                                const ImageRows *response, const ImageRows *source);
