/* What a wall of the grid adds to the near field's C = S - L of a pair of markers: Blake's image of the Stokeslet in
   the wall less the image that kernel and lattice make of it (docs/nearfield.md, Walls). One term for each wall and
   pair; two walls' terms are added, so that images of images, and what a corner's walls do to one another, stay the
   grid's. */
#pragma once
#include "coupling/imagefar.h"
#include "coupling/imagetable.h"
#include "markers/fold.h"

typedef struct {
  PetscReal y;             /* cells from the wall */
  PetscReal scale;         /* WallScale */
  PetscReal moment;        /* second moment across the wall of the tangential stencil, continued oddly */
  PetscInt first[2], n[2]; /* rows in ImageTable of the tangential and the normal component, folded */
  PetscReal weight[2][KERNEL_MAX_POINTS];
} ImageEnd;

/* A vesicle's least and largest x and y. */
typedef struct {
  PetscReal low[2], high[2];
} NearBounds;

typedef struct _p_NearImage *NearImage;
struct _p_NearImage {
  Markers markers; /* borrowed */
  PetscReal nu;
  PetscReal logarithm; /* NearLogarithm */
  ImageKernel kernel;
  const ImageTable *table;      /* borrowed */
  const PaddedStencil *stencil; /* [2M] unfolded, borrowed */
  ImageEnd *end[2][2];          /* [M] by direction of the normal and side; NULL without a wall */
  PetscReal *y[2][2];           /* [M] cells from the wall, in whole vectors (LANES), of which the rest is zero */
};

/* NearLogarithm - what a Stokeslet whose logarithm is that of a length over `unit` has less than one with the length in
   cells of the markers' grid, times nu. The unit is the h of the run's grid, also on the coarser ones of a box part, so
   that no number depends on what lengths are measured in. */
static inline PetscReal NearLogarithm(Markers markers, PetscReal unit) {
  return PetscLogReal(markers->grid->h / unit) / (4 * PETSC_PI);
}

/* NearImageCreate - for markers on a grid with any walls, in a fluid of viscosity nu, with this unit (NearLogarithm);
   table: the half-space lattice's, kept by the caller, NULL without walls. Collective. */
PETSC_EXTERN PetscErrorCode NearImageCreate(Markers markers, PetscReal nu, PetscReal unit, const ImageTable *table,
                                            NearImage *image);
PETSC_EXTERN PetscErrorCode NearImageDestroy(NearImage *image);

/* NearImagePlace - where the markers have been placed, whose unfolded stencils are stencil[2M] (kept by the caller).
   Not collective. */
PETSC_EXTERN PetscErrorCode NearImagePlace(NearImage image, const PaddedStencil stencil[]);

/* NearImageAdd - add all walls' parts, or all but those `without` by direction and side, to C of the response of marker
   i to marker j: xx, yy, xy (x to a force in y) and yx. d = X_i - X_j, in periodic directions to the image meant
   (length). L: the pair's free lattice mobility, which is S - C_free where that is known in closed form. Not
   collective. */
PETSC_EXTERN void NearImageAdd(NearImage image, const PetscBool without[2][2], PetscInt i, PetscInt j,
                               const PetscReal d[2], const PetscReal L[4], PetscReal C[4]);

/* NearImageAddBlake - C += alpha times all walls' exact images of the Stokeslet, (length), in the same form. Not
   collective. */
PETSC_EXTERN void NearImageAddBlake(NearImage image, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal alpha,
                                    PetscReal C[4]);

/* NearImageOff - how far X is from a wall (cells). Not collective. */
static inline PetscReal NearImageOff(Grid g, int direction, int side, const PetscReal X[2]) {
  return (side ? g->hi[direction] - X[direction] : X[direction] - g->lo[direction]) / g->h;
}

/* NearImageIsNear - whether stencils of a pair are summed. Not collective. */
static inline PetscBool NearImageIsNear(const ImagePair *p) {
  const PetscReal reach = PetscMin(p->a, p->b) < FOLD_SCALED ? IMAGE_CELLS : IMAGE_OFF;
  return p->x * p->x + PetscSqr(p->a + p->b) < reach * reach ? PETSC_TRUE : PETSC_FALSE;
}

/* NearImageGap - the least distance there can be between markers within `one` and images in a wall of markers within
   `other` (length). Not collective. */
PETSC_EXTERN PetscReal NearImageGap(Grid grid, int direction, int side, const NearBounds *one, const NearBounds *other);

/* NearImageIsFar - by which walls a marker at X and all in a box are off them, and so far from one another's images
   that no stencils are summed: far[direction][side], or NULL; returns whether by all. NearImageAddFar - the same as
   NearImageAdd for such a marker i and the n markers from j on, d = (x, y)[n] (and C with room for whole vectors), by
   the walls that are far and among `walls`: C[4][n] of i's response to them, or, with back, of theirs to it, d turned.
   Not collective. */
PETSC_EXTERN PetscBool NearImageIsFar(NearImage image, const PetscReal X[2], const NearBounds *box,
                                      PetscBool far[2][2]);
PETSC_EXTERN void NearImageAddFar(NearImage image, const PetscBool walls[2][2], const PetscBool far[2][2], PetscInt i,
                                  PetscInt j, PetscInt n, PetscBool back, const PetscReal x[], const PetscReal y[],
                                  PetscReal *const C[4]);

/* NearImageFar - BoxImages of the single layer, image: a NearImage. Not collective. */
PETSC_EXTERN void NearImageFar(const void *image, PetscInt n, const PetscReal X[], const PetscReal Y[2], PetscReal V[]);

/* NearImageBlake - Blake's image part of the Stokeslet in a wall, cells, viscosity 1. NearImageTurn - C += alpha times
   a pair's parts, turned from the wall with this normal and side to x and y. Not collective. */
PETSC_EXTERN void NearImageBlake(const ImagePair *pair, PetscReal image[IMAGE_PARTS]);
PETSC_EXTERN void NearImageTurn(int direction, int side, PetscReal alpha, const PetscReal part[IMAGE_PARTS],
                                PetscReal C[4]);
