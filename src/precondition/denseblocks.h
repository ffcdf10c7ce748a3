/* Block Jacobi part of the coupled preconditioner: the dense problem (denseblock.h) of the membranes, one block for all
   vesicles whose markers are few, else one a vesicle (docs/solver.md, Preconditioner).

   The mobility of a block is M = Mob + h^2 C, Mob the grid's (meanmobility.h) and C the near field. A block of one
   vesicle that knows no obstacles is used in the frame of the vesicle for which it was made, turned and with labels
   shifted (rigidfit.h), so that it serves longer. With a shape memory, which goes with the labels, none are shifted.

   A block belongs to one rank, the owner of its first vesicle. All ranks make parts of Mob of a block for all. */
#pragma once
#include "precondition/obstacleblock.h"

/* Vesicles whose markers together are at most this many share one block, which knows how they move one another. */
#define DENSE_TOGETHER 300

typedef struct _p_DenseBlocks *DenseBlocks;

PETSC_EXTERN PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *blocks);
PETSC_EXTERN PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks);

/* DenseBlocksPlace - follow the coupling's new markers: the membranes' law is placed there, also where N and C are
   older. A block of one vesicle, which knows no obstacles, is turned, and its labels shifted, as the vesicle has been
   since the block was made. Not collective. */
PETSC_EXTERN void DenseBlocksPlace(DenseBlocks blocks);

/* DenseBlocksFactor - assemble Mob at the coupling's markers, factor N and
   C for a0 and the coupling's label speeds. A block for all is that in the presence of the obstacles, whose own block
   is `solid`, or NULL. Ranks share the sums of Mob of a block for all, its owner does the rest. factored is false, on
   every rank, when a matrix is singular. Collective. */
PETSC_EXTERN PetscErrorCode DenseBlocksFactor(DenseBlocks blocks, MeanMobility mobility, ObstacleBlock solid,
                                              PetscReal a0, PetscBool *factored);

/* DenseBlocksSolve - from the own U[2n] and sigma[n] = r_s: sigma, and U overwritten by U3. Collective. */
PETSC_EXTERN PetscErrorCode DenseBlocksSolve(DenseBlocks blocks, PetscScalar U[], PetscScalar sigma[]);
