/* The small Lagrangian problem inside the coupled preconditioner (DESIGN section 7), one dense block for all vesicles
   or, when their markers are many, one a vesicle: N = I + (c_b ds/(h^2 a0)) Mob D4,   C = Dm N^-1 Mob Dm^T/h^4,   sigma
   = C^-1 (Dm U1/h^2 - r_s), U3 = U1 - N^-1 Mob Dm^T sigma/h^2,  U1 = N^-1 U. */
#pragma once
#include "coupling/mobility.h"
#include "coupling/selfmobility.h"

/* Vesicles whose markers together are at most this many share one block, which knows how they move one another. */
#define DENSE_TOGETHER 800

typedef struct _p_DenseBlocks *DenseBlocks;

PETSC_EXTERN PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *blocks);
PETSC_EXTERN PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks);

/* DenseBlocksFactor - assemble Mob from the table at the coupling's markers, factor N and C for a0. self adds
   h^2 Theta to Mob, NULL nothing. Ranks share the work; the result has the same bits on all. Collective. */
PETSC_EXTERN PetscErrorCode DenseBlocksFactor(DenseBlocks blocks, Mobility mobility, const GreenTable *table,
                                              SelfMobility self, PetscReal a0);

/* DenseBlocksSolve - from U[2M] = E w1 and r_s[M]: sigma[M], and U overwritten by U3. */
PETSC_EXTERN PetscErrorCode DenseBlocksSolve(DenseBlocks blocks, PetscScalar U[], const PetscScalar r_s[],
                                             PetscScalar sigma[]);
