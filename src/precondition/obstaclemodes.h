/* An approximate inverse of the obstacles' block A of the reduced problem, for many markers (docs/obstacles.md, Many
   markers).

   D is the dense block of each curve alone; curves that are equal but for their place share it. What the other curves
   do is smooth along a curve, so a few points of each curve hold it: with Q the interpolation from points to markers
   (curvepoints.h) and M the grid's mobility between the points of different curves,
       A ~ D + Q M Q^T,     A^-1 = D^-1 - D^-1 Q K Q^T D^-1,     K = (I + M G)^-1 M,     G = Q^T D^-1 Q.
   The matrices are in single precision on one rank, root; all ranks make parts of D and M. */
#pragma once
#include "bodies/freebodies.h"
#include "precondition/meanmobility.h"

#define OBSTACLE_MODES 3000 /* at most, of all curves: K is dense */

typedef struct _p_ObstacleModes *ObstacleModes;

/* ObstacleModesCreate - for the coupling's obstacles in the fluid that spec makes; the matrices are root's. Collective.
 */
PETSC_EXTERN PetscErrorCode ObstacleModesCreate(const FluidSpec *spec, Coupling coupling, PetscMPIInt root,
                                                ObstacleModes *modes);
PETSC_EXTERN PetscErrorCode ObstacleModesDestroy(ObstacleModes *modes);

/* ObstacleModesSetUp - for the fluid's coefficient alpha, where the coupling has been placed; failed, on every rank,
   when a matrix is singular. Collective. */
PETSC_EXTERN PetscErrorCode ObstacleModesSetUp(ObstacleModes modes, PetscReal alpha, PetscBool *failed);

/* ObstacleModesApply - y = A^-1 x, [2W + 3 free] each, on root. Not collective. ObstacleModesCount - how many there
 * are. */
PETSC_EXTERN PetscErrorCode ObstacleModesApply(ObstacleModes modes, float x[], float y[]);
PETSC_EXTERN PetscInt ObstacleModesCount(ObstacleModes modes);
