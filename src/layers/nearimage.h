/* What a wall of the grid adds to C = S - L of a pair of markers in the single layer: Blake's image of the Stokeslet in
   the wall less the image that regularised delta function and lattice make of it (docs/nearfield.md, Walls),

       C_wall = Blake(x, a, b) - L_half(x, a, b) + L(x, a - b),

   x the distance of the two along the wall, a and b their distances from it, L_half the mobility of the lattice in a
   half space. L_half is summed over stencils, which are folded at the wall, where marker and image are near one
   another; else the difference has a closed form (imagefar.h). There is one term for each wall and pair; those of two
   walls are added, so that images of images, and what a corner's walls do to one another, stay the grid's. Nothing
   crosses ranks. */
#pragma once
#include "layers/imagefar.h"
#include "layers/imagetable.h"
#include "layers/layersetting.h"
#include "markers/wallfold.h"

typedef struct {
  PetscReal y;             /* cells from the wall */
  PetscReal scale;         /* WallScale */
  PetscReal moment;        /* second moment across the wall of the tangential stencil, continued oddly */
  PetscInt first[2], n[2]; /* rows in ImageTable of the tangential and the normal component, folded */
  PetscReal weight[2][KERNEL_MAX_POINTS];
} ImageEnd;

/* The parts of a force among xx, yy, xy (x to a force along y), yx. */
static const ImagePlaces force_places = {
    IMAGE_PARTS, {{1, 0, 2, 3}, {0, 1, 3, 2}}, {[IMAGE_NT] = PETSC_TRUE, [IMAGE_TN] = PETSC_TRUE}};

/* Least and largest x and y of some markers. NearBoundsOf - of n at X[2n]. Not collective. */
typedef struct {
  PetscReal low[2], high[2];
} NearBounds;
PETSC_EXTERN NearBounds NearBoundsOf(PetscInt n, const PetscReal X[]);

typedef struct _p_NearImage *NearImage;
struct _p_NearImage {
  Markers markers; /* borrowed */
  PetscReal nu;
  PetscReal logarithm; /* ln(h/unit)/(4 pi): what a Stokeslet whose unit of length is `unit`, the h of the run's grid,
                          has less than one in cells of this grid; no number depends on the unit of lengths */
  ImageKernel kernel;
  const ImageTable *table;      /* borrowed */
  const PaddedStencil *stencil; /* [2M] unfolded, borrowed */
  ImageEnd *end[2][2];          /* [M] by direction of the normal and side; NULL without a wall */
  PetscReal *y[2][2];           /* [M] cells from the wall, in whole vectors (LANES), of which the rest is zero */
};

/* NearImageCreate - for markers on a grid with any walls; table: the half-space lattice's, kept by the caller, NULL
   without walls. Collective. */
PETSC_EXTERN PetscErrorCode NearImageCreate(const LayerSetting *set, const ImageTable *table, NearImage *image);
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

/* NearImageSeen - four points x and a point y as a wall sees them, in cells: x less y along it, the distances from it
   of x and of y. The wall is 2 times the direction of its normal plus its side. Not collective. */
static inline void NearImageSeen(Grid g, int wall, const Lanes x[2], const PetscReal y[2], Lanes seen[3]) {
  const int direction = wall / 2;
  const PetscReal inward = (wall % 2 ? -1 : 1) / g->h, place = wall % 2 ? g->hi[direction] : g->lo[direction];
  seen[0] = (x[1 - direction] - y[1 - direction]) / g->h;
  seen[1] = inward * (x[direction] - place);
  seen[2] = inward * (y[direction] - place) + (Lanes){0};
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
   that no stencils are summed: far[direction][side], or NULL; returns whether by all. Not collective. */
PETSC_EXTERN PetscBool NearImageIsFar(NearImage image, const PetscReal X[2], const NearBounds *box,
                                      PetscBool far[2][2]);

/* NearImageAddFar - add the parts of these walls, from which all markers are far, to C: of marker i's response to the n
   markers from j on or, with back, of theirs to it. d[2][n], C[4][n] as in NearImageAdd; arrays with room for whole
   vectors, d turned with back. Not collective. */
typedef struct {
  PetscInt i, j, n;
  PetscBool back;
  const PetscReal *d[2];
  PetscReal *C[4];
} NearImageRow;
PETSC_EXTERN void NearImageAddFar(NearImage image, const PetscBool walls[2][2], const NearImageRow *row);

/* NearImageBlake - Blake's image of the Stokeslet in a wall, less the Stokeslet, of four pairs in cells and of
   viscosity
   1. Not collective. */
PETSC_EXTERN void NearImageBlake(Lanes x, Lanes a, Lanes b, Lanes image[IMAGE_PARTS]);
