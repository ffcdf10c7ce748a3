/* What a wall of the grid adds to C = K - L of a pair of markers: the exact fluid's image of the source in the wall
   less the image that regularised delta functions and lattice make of it (docs/nearfield.md, Walls; docs/contrast.md,
   Walls),

       C_wall = K_image(x, a, b) - L_half(x, a, b) + L(x, a - b),

   x the distance of the two along the wall, a and b their distances from it, L_half the mobility of the lattice in a
   half space. L_half is summed over stencils, which are folded at the wall, where marker and image are near one
   another; else the difference has a closed form (imageform.h). There is one term for each wall and pair; those of two
   walls are added, so that images of images, and what a corner's walls do to one another, stay the grid's. Walls are
   numbered: 2 times the direction of the normal plus the side. Nothing crosses ranks. */
#pragma once
#include "layers/pairkernel.h"
#include "markers/wallfold.h"

/* Rows in ImageTable of a component of a velocity, or of a part of a source, folded. */
typedef struct {
  PetscInt first, n;
  PetscReal weight[KERNEL_MAX_POINTS];
} WallRows;

/* What a marker's velocity has of a wall. */
typedef struct {
  PetscReal scale;  /* WallScale */
  PetscReal moment; /* second moment across the wall of the tangential stencil, continued oddly */
  WallRows row[2];  /* tangential, normal */
} ImageEnd;

/* Least and largest x and y of some markers. NearBoundsOf - of n at X[2n]. Not collective. */
typedef struct {
  PetscReal low[2], high[2];
} NearBounds;
PETSC_EXTERN NearBounds NearBoundsOf(PetscInt n, const PetscReal X[]);

typedef struct _p_WallImage *WallImage;
struct _p_WallImage {
  const PairKernel *kernel;
  Markers markers;     /* borrowed */
  PetscReal scale;     /* of parts seen from a wall in cells: 1 over the viscosity, or over h */
  PetscReal logarithm; /* of forces ln(h/unit)/(4 pi): what a Stokeslet whose unit of length is `unit`, the h of the
                          run's grid, has less than one in cells of this grid; no number depends on that unit */
  ImageKernel form;
  const ImageTable *table; /* NULL without walls */
  ImageTable *made;        /* the table, if it is not borrowed */
  PetscBool owner;         /* of ends and distances */
  ImageEnd *end[4];        /* [M] by wall; NULL without a wall */
  PetscReal *y[4];         /* [M] cells from the wall, in whole vectors (LANES), of which the rest is zero */
  WallRows *row[4];        /* [sources M] of sources with stencils of their own, else NULL */
  const PaddedStencil *velocity, *source; /* [2M], [sources M] unfolded, borrowed; source NULL: those of velocities */
};

/* WallImageCreate - for markers on a grid with any walls; lattice: the kernel's tables; half: the half-space lattice's,
   kept by the caller, NULL: made from the former where there are walls. velocities: an image of the same markers that
   keeps what responses have of walls, or NULL. Collective. */
PETSC_EXTERN PetscErrorCode WallImageCreate(const PairKernel *kernel, const LayerSetting *set,
                                            const OffsetTable *lattice, const ImageTable *half, WallImage velocities,
                                            WallImage *image);
PETSC_EXTERN PetscErrorCode WallImageDestroy(WallImage *image);

/* WallImagePlace - where the markers have been placed, with the unfolded stencils of velocities and, if they have their
   own, of sources, which the caller keeps. Not collective. */
PETSC_EXTERN PetscErrorCode WallImagePlace(WallImage image, const PaddedStencil velocity[],
                                           const PaddedStencil source[]);

/* WallImageAdd - add all walls' parts, or all but those `without`, to C of the response of marker i to marker j, by
   parts (PairKernel). d = X_i - X_j, in periodic directions to the image meant (length). L: the pair's free lattice
   mobility. Not collective. */
PETSC_EXTERN void WallImageAdd(WallImage image, const PetscBool without[4], PetscInt i, PetscInt j,
                               const PetscReal d[2], const PetscReal L[], PetscReal C[]);

/* WallImageAddExact - C += alpha times all walls' exact images, in the same form. Not collective. */
PETSC_EXTERN void WallImageAddExact(WallImage image, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal alpha,
                                    PetscReal C[]);

/* WallImageFour - parts of four pairs that a wall sees, in cells: the exact fluid's image, or C_wall of markers that
   are off the wall and far from one another's images. kernel: the image's own, a constant where the compiler knows it.
   Not collective. */
__attribute__((always_inline)) static inline void WallImageFour(const PairKernel *const kernel, WallImage m, int wall,
                                                                const PetscBool exact, const Lanes seen[3], Lanes K[]) {
  const ImagePlaces *p = &kernel->places;
  const PetscReal alpha[2] = {m->scale, wall % 2 ? -m->scale : m->scale};
  Lanes part[PAIR_PARTS];
  if (exact) {
    kernel->image_exact(&m->form, seen[0], seen[1], seen[2], part);
    for (int q = 0; q < 2; q++) part[q] += m->logarithm; /* along and across to themselves */
  } else
    kernel->image_far(&m->form, seen[0], seen[1], seen[2], NULL, part);
  for (int q = 0; q < p->parts; q++) K[p->place[wall / 2][q]] = alpha[p->odd[q]] * part[q];
}

/* WallImageSeen - four points x and a point y as a wall sees them, in cells: x less y along it, the distances from it
   of x and of y. Not collective. */
static inline void WallImageSeen(Grid g, int wall, const Lanes x[2], const PetscReal y[2], Lanes seen[3]) {
  const int direction = wall / 2;
  const PetscReal inward = (wall % 2 ? -1 : 1) / g->h, place = wall % 2 ? g->hi[direction] : g->lo[direction];
  seen[0] = (x[1 - direction] - y[1 - direction]) / g->h;
  seen[1] = inward * (x[direction] - place);
  seen[2] = inward * (y[direction] - place) + (Lanes){0};
}

/* WallGap - the least distance there can be between markers within `one` and images in a wall of markers within `other`
   (length). Not collective. */
PETSC_EXTERN PetscReal WallGap(Grid grid, int wall, const NearBounds *one, const NearBounds *other);

/* WallsAreFar - by which walls a marker at X and all in a box are off them, and so far from one another's images that
   no stencils are summed: far[4], or NULL; returns whether by all. Not collective. */
PETSC_EXTERN PetscBool WallsAreFar(Grid grid, const PetscReal X[2], const NearBounds *box, PetscBool far[4]);
