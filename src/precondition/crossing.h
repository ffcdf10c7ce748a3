/* What vesicles and free bodies do to one another, inside the preconditioner of many vesicles: the velocity W of the
   markers of the one kind by forces on those of the other, on a coarse grid (coarsegrid.h) with its correction between
   near markers (coarsecorrection.h). */
#pragma once
#include "precondition/coarsecorrection.h"
#include "precondition/curvepoints.h"

typedef struct _p_Crossing *Crossing;

/* CrossingCreate - for the quasi-steady fluid that spec makes; NULL where no coarse cells fit. Collective. */
PETSC_EXTERN PetscErrorCode CrossingCreate(const FluidSpec *spec, Mobility mobility, Crossing *crossing);
PETSC_EXTERN PetscErrorCode CrossingDestroy(Crossing *crossing);

/* CrossingPlace - where the mobility has been placed. Collective. */
PETSC_EXTERN PetscErrorCode CrossingPlace(Crossing crossing);

/* CrossingApply - W += the velocity at own vesicles (to vesicles, W[2n]) or own obstacles (W[2w]) by the force F[2(n +
   w)] on the others, which is zero on these. Collective. */
PETSC_EXTERN PetscErrorCode CrossingApply(Crossing crossing, PetscBool to_vesicles, const PetscScalar F[],
                                          PetscScalar W[]);
