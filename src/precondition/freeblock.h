/* The unknown velocities of free bodies in the obstacles' block of the preconditioner. With A the block of the markers
   and R the rigid motions of the bodies,

       A F + m R q = r,   R^T F - a0 M q = s:
       q = (R^T A^-1 m R + a0 M)^-1 (R^T A^-1 r - s),   F = A^-1 r - A^-1 m R q,

   M the bodies' masses (0 without inertia). The inertia of the fluid inside, which the near field bounds, is left to
   the iterations.

   A^-1 is in single precision; a rigid part added to F gives R^T F = s + a0 M q to rounding. All is on one rank, for
   the bodies as they stood when A was made. */
#pragma once
#include "bodies/freebodies.h"

typedef struct _p_FreeBlock *FreeBlock;

/* A product y = A^-1 x, [2W] each. */
typedef PetscErrorCode FreeBlockInverse(void *context, const float x[], float y[]);

/* FreeBlockCreate - for the free bodies among the obstacles. FreeBlockSetUp - where they have been placed, with this
   A^-1 and mass[3 free] (NULL: 0); done is false where the small matrix is singular. FreeBlockSolve - q[3 free] is
   s and becomes the velocities, F[2W] is A^-1 r and becomes the forces. Not collective. */
PETSC_EXTERN PetscErrorCode FreeBlockCreate(Obstacles obstacles, FreeBlock *block);
PETSC_EXTERN PetscErrorCode FreeBlockDestroy(FreeBlock *block);
PETSC_EXTERN PetscErrorCode FreeBlockSetUp(FreeBlock block, PetscReal a0, const PetscReal mass[],
                                           FreeBlockInverse *inverse, void *context, PetscBool *done);
PETSC_EXTERN PetscErrorCode FreeBlockSolve(FreeBlock block, PetscScalar q[], PetscScalar F[]);
