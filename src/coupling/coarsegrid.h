/* What vesicles do to one another, on a grid of cells some four times as large and with a few points a vesicle: for the
   preconditioner (docs/suspensions.md, Coarse grid). */
#pragma once
#include "coupling/mobilitytable.h"
#include "fluid/stokes.h"

typedef struct _p_CoarseGrid *CoarseGrid;
struct _p_CoarseGrid {
  Layout layout; /* of the points */
  Layout all;    /* all points on every rank, where its rows are too few for the ranks and each has the whole grid; else
                    NULL */
  Fluid fluid;
  Stokes stokes;
  Markers markers;     /* the points, between cells */
  MobilityTable table; /* what the coarse grid does to the vesicle itself */
  Vec X, F;            /* marker vectors, of `all` if there is one */
};

/* CoarseGridCreate - for the quasi-steady fluid that spec makes and vesicles with these initial lengths, whose layout
   is `fine`. NULL in unbounded fluid, and where the numbers of cells have no common divisor of 2 to 5 or the coarse
   cells would be fewer than 16. Collective. */
PETSC_EXTERN PetscErrorCode CoarseGridCreate(const FluidSpec *spec, Layout fine, const PetscReal length[],
                                             const char kernel[], CoarseGrid *coarse);
PETSC_EXTERN PetscErrorCode CoarseGridDestroy(CoarseGrid *coarse);

/* CoarseGridPlace - at the points X of the own vesicles; those nearer to a wall than
   markers may be are moved off it. Collective. */
PETSC_EXTERN PetscErrorCode CoarseGridPlace(CoarseGrid coarse, PetscScalar X[]);

/* CoarseGridApply - F := E A^-1 (-E^T F/h^2) of the coarse grid, h its cells, own parts of marker vectors. Collective.
 */
PETSC_EXTERN PetscErrorCode CoarseGridApply(CoarseGrid coarse, PetscScalar F[]);
