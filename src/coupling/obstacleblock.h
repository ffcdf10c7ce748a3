/* The obstacles' block of the reduced problem, E A^-1 E^T/h^2 + C + D + beta N N^T between their markers, as a dense
   factor in single precision: part of the preconditioner (docs/obstacles.md, Preconditioner). E A^-1 E^T is that of a
   periodic box of the same cells (mobility.h), or, where an obstacle stands on a wall, the grid's own
   (mobilitysolves.h). Obstacles rest, so that in quasi-steady flow it is made once. */
#pragma once
#include "coupling/mobility.h"

typedef struct _p_ObstacleBlock *ObstacleBlock;

/* ObstacleBlockCreate - for the coupling's obstacles in the fluid that spec makes. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockCreate(const FluidSpec *spec, Coupling coupling, ObstacleBlock *block);
PETSC_EXTERN PetscErrorCode ObstacleBlockDestroy(ObstacleBlock *block);

/* ObstacleBlockSetUp - the factor for the fluid's coefficient alpha, where the coupling has been placed; failed, on
   every rank, when it is singular. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockSetUp(ObstacleBlock block, PetscBool *failed);

/* ObstacleBlockSolve - F[2w] of the own obstacles from their rows' residuals, in place. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockSolve(ObstacleBlock block, PetscScalar F[]);
