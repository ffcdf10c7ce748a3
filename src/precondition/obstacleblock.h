/* The obstacles' block of the reduced problem, part of the preconditioner (docs/obstacles.md, Preconditioner):
       A = E G E^T/h^2 + C + D + beta N N^T
   between their markers, G the Stokes solution operator, C the near field, D its box part, N the normals. Few markers
   have its dense inverse in single precision, many an approximation by shapes of curves (obstaclemodes.h). E G E^T is
   that of meanmobility.h, or, where an obstacle stands on a wall, the grid's own, by Stokes solves.

   While obstacles rest in quasi-steady flow the factor is made once. For bodies that move it is the one of an earlier
   time, with forces and velocities turned with each body, because a body alone has one block wherever it is. In
   unsteady flow it may be that of a time step of another size. Such a factor is made anew by its age (age.h).

   With X = A^-1 K, K the obstacles' velocity by forces on the vesicles, the obstacles are eliminated: the vesicles'
   block gets the Schur complement Mob - K^T X, and X carries right-hand sides and forces across.

   Free bodies have their velocities q and rows in it (FreeBodiesBlock). The inertia of the fluid inside, which the
   near field bounds, is left to the iterations.

   One rank, the owner of the first body, has the factor; all ranks make parts of A. */
#pragma once
#include "bodies/freebodies.h"
#include "precondition/age.h"
#include "precondition/meanmobility.h"

typedef struct _p_ObstacleBlock *ObstacleBlock;

/* Of two steps whose factor is the same, and, where error control chooses steps, the blocks of vesicles among
   obstacles: a factor of 2 costs a stiff vesicle before a throat four iterations. */
#define OBSTACLE_STEP_RATIO 1.45

/* ObstacleBlockCreate - for the coupling's obstacles in the fluid that spec makes. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockCreate(const FluidSpec *spec, Coupling coupling, ObstacleBlock *block);
PETSC_EXTERN PetscErrorCode ObstacleBlockDestroy(ObstacleBlock *block);

/* ObstacleBlockSetUp - the factor for the fluid's coefficient alpha, where the coupling has been placed; failed, on
   every rank, when it is singular. Collective. ObstacleBlockSolved - a solve with it has taken so many iterations. Not
   collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockSetUp(ObstacleBlock block, PetscBool *failed);
PETSC_EXTERN void ObstacleBlockSolved(ObstacleBlock block, PetscInt its);

/* ObstacleBlockRenewed - whether the factor has been made anew since ObstacleBlockCouple, whose X has been dropped with
   the old one. Not collective. */
PETSC_EXTERN PetscBool ObstacleBlockRenewed(ObstacleBlock block);

/* ObstacleBlockIsOlder - whether a factor may be of an earlier time or of another time step: with moving bodies or in
   unsteady flow. Not collective. */
PETSC_EXTERN PetscBool ObstacleBlockIsOlder(Coupling coupling);

/* ObstacleBlockGetMemory, ObstacleBlockSetMemory - what is kept of such factors, for a checkpoint (precondition.h):
   memory[0] is the time at which the factor was made, then its age, with alpha, negative: none, in memory[1], then the
   places of free bodies at that time [3 free]. Set makes it again, with the coupling placed at that instant and for
   that alpha. Set is collective. */
#define OBSTACLE_BLOCK_MEMORY (1 + AGE_MEMORY)
PETSC_EXTERN PetscErrorCode ObstacleBlockGetMemory(ObstacleBlock block, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode ObstacleBlockSetMemory(ObstacleBlock block, const PetscReal memory[]);

/* ObstacleBlockCouple - from here on with what vesicles and obstacles do to one another where the coupling has been
   placed: X = A^-1 K, A the obstacles' block, K their velocity by forces on the vesicles, and Mob[2M][2M], the
   vesicles' mobility times h^2 on the owner of the first one, becomes that in the presence of the obstacles, Mob - h^2
   K^T X. Nothing where obstacles move. failed: as ObstacleBlockSetUp, left alone otherwise. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockCouple(ObstacleBlock block, MeanMobility mobility, PetscReal Mob[],
                                                PetscBool *failed);

/* ObstacleBlockBegin - A^-1 r of the own obstacles' residuals r[2w + 3 own free], kept in the block; U[2n] -= X^T r of
   the own vesicles. ObstacleBlockEnd - and with the own vesicles' forces F[2n]: F_w = A^-1 r - X F to solid[2w], with
   the velocities of free bodies behind; F is not looked at where nothing has been coupled, X = 0. solid comes with r.
   Collective. ObstacleBlockCoupled - whether it has been. Not collective. */
PETSC_EXTERN PetscErrorCode ObstacleBlockBegin(ObstacleBlock block, const PetscScalar r[], PetscScalar U[]);
PETSC_EXTERN PetscBool ObstacleBlockCoupled(ObstacleBlock block);
PETSC_EXTERN PetscErrorCode ObstacleBlockEnd(ObstacleBlock block, const PetscScalar F[], PetscScalar solid[]);
