/* -scheme_auto: what grids leave, by what was measured (docs/speed_accuracy/calibration.csv). */
#pragma once
#include "scene/spec.h"

/* The error of a grid depends on the fluid: quasi-steady with the near field's box part, quasi-steady without the box
   part, or with inertia. */
typedef enum { AUTO_BOX_PART, AUTO_NO_BOX_PART, AUTO_INERTIA } AutoFluid;

/* SceneAutoFluid - which it is when the largest vesicle has this radius. SceneCellsFor - the fewest cells a R0 that
   leave no more than an error over R0, or the most that were measured; many: with 45 markers a vesicle or more. Not
   collective. */
PETSC_EXTERN AutoFluid SceneAutoFluid(Scene scene, PetscReal R0);
PETSC_EXTERN PetscReal SceneCellsFor(AutoFluid fluid, PetscReal error, PetscBool many);

/* SceneSquareCells - the fewest square cells that fill a box, no larger than h, with a common divisor of their numbers
   that Fourier transforms like; false where it takes more than SCENE_MOST_ACROSS in a direction. SceneWallCells - those
   that are no larger than h and leave no more than `error` of R0 at a wall `gap` away; false where none does up to the
   finest that was measured. Not collective. */
#define SCENE_MOST_ACROSS 4096
PETSC_EXTERN PetscBool SceneSquareCells(const PetscReal box[4], PetscReal h, PetscInt cells[2]);
PETSC_EXTERN PetscBool SceneWallCells(AutoFluid fluid, const PetscReal box[4], PetscReal h, PetscReal R0, PetscReal gap,
                                      PetscReal error, PetscInt cells[2]);

/* SceneReportGrid - print what grid and walls leave, and what it would take. Collective. */
PETSC_EXTERN PetscErrorCode SceneReportGrid(Scene scene);
