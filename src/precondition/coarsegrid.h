/* The coarse grid of the preconditioner of many vesicles: what vesicles do to one another at a distance
   (docs/suspensions.md, Coarse grid).

   Its cells are some four times as large as the run's, and each vesicle has a few points on it, so that a Stokes solve
   costs a tenth or less. With E the interpolation at the points and A the Stokes operator of the coarse grid, the
   velocity by forces F is -E A^-1 E^T F/h^2, h its cells.

   Ranks share the rows of the grid as they do in the run. Where there are too few rows each rank has the whole grid and
   all points, and forces are gathered. */
#pragma once
#include "bodies/bodies.h"
#include "precondition/mobilitytable.h"
#include "fluid/stokes/stokes.h"

typedef struct _p_CoarseGrid *CoarseGrid;
struct _p_CoarseGrid {
  Layout layout; /* of the points */
  Layout all;    /* all points on every rank, where each rank has the whole grid; else NULL */
  Fluid fluid;
  Stokes stokes;
  Markers markers;     /* the points, between cells */
  MobilityTable table; /* mean mobility of two points: what the grid does to a vesicle itself */
  Vec work;            /* marker vector, of `all` if there is one */
};

/* CoarseGridCreate - for the quasi-steady fluid that spec makes and these bodies. NULL in unbounded fluid, and where
   the numbers of cells have no common divisor of 2 to 5 or the coarse cells would be fewer than 16. Collective. */
PETSC_EXTERN PetscErrorCode CoarseGridCreate(const FluidSpec *spec, Bodies bodies, const char kernel[],
                                             CoarseGrid *coarse);
PETSC_EXTERN PetscErrorCode CoarseGridDestroy(CoarseGrid *coarse);

/* CoarseGridPlace - at the points X of the own bodies; those nearer to a wall than
   markers may be are moved off it. Collective. */
PETSC_EXTERN PetscErrorCode CoarseGridPlace(CoarseGrid coarse, PetscScalar X[]);

/* CoarseGridApply - F := -E A^-1 E^T F/h^2 of the coarse grid, h its cells, own parts of marker vectors. Collective. */
PETSC_EXTERN PetscErrorCode CoarseGridApply(CoarseGrid coarse, PetscScalar F[]);
