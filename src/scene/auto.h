/* -scheme_auto: what is measured of grids, and how the choice is said. */
#pragma once
#include "scene/resolve.h"

/* What a grid leaves goes by the fluid: quasi-steady with the near field's box part, or without it, or with inertia. */
typedef enum { AUTO_BOX_PART, AUTO_NO_BOX_PART, AUTO_INERTIA } AutoFluid;

/* SceneAutoFluid - which it is when the largest vesicle has this radius. SceneGridError - what a grid of so many cells
   a R0 leaves, of markers or energy over R0, by the worst of the calibration; many: with 45 markers a vesicle or more.
   PETSC_MAX_REAL on grids coarser than any that was measured. SceneCellsFor - the fewest cells a R0 that leave no more,
   or the most that were measured. SceneWallError - what the grid leaves of R0 when a membrane begins `gap` from a wall
   (all lengths in R0), beside that of a grid without walls near it. Not collective. */
PETSC_EXTERN AutoFluid SceneAutoFluid(Scene scene, PetscReal R0);
PETSC_EXTERN PetscReal SceneGridError(AutoFluid fluid, PetscReal cells, PetscBool many);
PETSC_EXTERN PetscReal SceneCellsFor(AutoFluid fluid, PetscReal error, PetscBool many);
PETSC_EXTERN PetscReal SceneWallError(AutoFluid fluid, PetscReal gap, PetscReal h);

/* SceneSquareCells - the fewest square cells that fill a box, no larger than h, with a common divisor of their numbers
   that Fourier transforms like; false where it takes more than SCENE_MOST_ACROSS in a direction. SceneWallCells - those
   that are no larger than h and leave no more than `error` of R0 at a wall `gap` away; false where none does up to the
   finest that was measured. Not collective. */
#define SCENE_MOST_ACROSS 4096
PETSC_EXTERN PetscBool SceneSquareCells(const PetscReal box[4], PetscReal h, PetscInt cells[2]);
PETSC_EXTERN PetscBool SceneWallCells(AutoFluid fluid, const PetscReal box[4], PetscReal h, PetscReal R0, PetscReal gap,
                                      PetscReal error, PetscInt cells[2]);

/* SceneChooseBoundaries - where neither box nor boundaries are given, and walls are no part of the question: unbounded
   fluid, or with what needs a grid a period in x. SceneReportDomain - boundaries, box and cells, each with its reason.
   SceneReportGrid - what grid and walls leave, and what it would take. SceneSaySetting - one setting: its name, value,
   and why, or that it is the user's. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseBoundaries(Draft scene);
PETSC_EXTERN PetscErrorCode SceneReportDomain(Scene scene);
PETSC_EXTERN PetscErrorCode SceneReportGrid(Scene scene);
PETSC_EXTERN PetscErrorCode SceneSaySetting(Scene scene, const char name[], const char why[]);
