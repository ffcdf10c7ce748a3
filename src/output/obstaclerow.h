/* What obstacles add to a row of series.csv. */
#pragma once
#include "scheme/scheme.h"

#define OBSTACLE_ROW_FEW 40 /* obstacles, up to which each has columns of its own */
#define OBSTACLE_ROW_NAME 32

/* ObstacleRowCount - so many columns; 0 without obstacles. ObstacleRowName - of the k-th. Not collective. */
PETSC_EXTERN PetscInt ObstacleRowCount(const SceneObstacles *obstacles);
PETSC_EXTERN void ObstacleRowName(const SceneObstacles *obstacles, PetscInt k, char name[OBSTACLE_ROW_NAME]);

/* ObstacleRowTake - the columns' values of the present state: pressure_drop and flux (scheme/pressuredrop.h), force_x,
   force_y of the fluid on all obstacles (length^3/time^2, density 1), then force and torque about its middle
   (length^4/time^2) of each, and where bodies move its middle x, y (length) and the angle by which it has turned
   (radian). Collective. */
PETSC_EXTERN PetscErrorCode ObstacleRowTake(Scheme scheme, PetscReal values[]);
