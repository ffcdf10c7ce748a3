/* -scheme_auto: the settings that reach a wanted error, by what was measured. */
#pragma once
#include "scene/spec.h"

/* When a setting is chosen: before the checks, when lists are checked, or when vesicles are known; all in three
   dimensions. */
typedef enum { AUTO_FIRST, AUTO_DOMAIN, AUTO_STEPS, AUTO_SPACE } AutoStage;

/* SceneChooseByError - with -scheme_auto: the settings of a stage that the user does not give, and the reason of each.
   Errors: outside of what was measured, and schemes that have no error control. SceneChooseMarkers - with -scheme_auto,
   where the user gives neither their number nor their spacing: more markers than the default where the start needs
   them, in steps of a fifth up to three times as many, and not closer than the near field bears; the shape is made
   anew. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseByError(Draft scene, AutoStage stage);
PETSC_EXTERN PetscErrorCode SceneChooseMarkers(Draft scene);

/* Boundaries, box and grid (autodomain.c). Each function writes a setting's value as a user would, or nothing where the
   default stays, and the reason, or nothing where the setting is not worth a line. Boundaries come first, then a box as
   large as the error asks for, unless walls are part of the question, then the grid, for the vesicles and their
   distance from walls. Collective. Errors: no square cells, or too many of them. */
PETSC_EXTERN PetscErrorCode SceneSuggestBoundaryX(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestBoundaryY(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestBox(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestCells(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);

/* Three dimensions (autospace.c). SceneSpaceMeasured - whether degree and steps of such a scene have been measured: one
   spheroid of reduced volume 0.7 to 1 in shear, chi from 1 to 100; at 0.7 down to 1e-3. Degree, first step, tolerance
   and largest step, as above. Not collective. */
PETSC_EXTERN PetscBool SceneSpaceMeasured(Scene scene);
PETSC_EXTERN PetscErrorCode SceneSuggestDegree(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestSpaceStep(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestSpaceTolerance(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestSpaceMost(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);

/* The error of a grid depends on the fluid: quasi-steady with the near field's box part, quasi-steady without the box
   part, or with inertia. */
typedef enum { AUTO_BOX_PART, AUTO_NO_BOX_PART, AUTO_INERTIA } AutoFluid;

/* SceneAutoFluid - which it is when the largest vesicle has this radius. SceneCellsFor - the fewest cells a R0 that
   leave no more than an error over R0, or the most that were measured; many: with 45 markers a vesicle or more
   (autogrid.c). Not collective. */
PETSC_EXTERN AutoFluid SceneAutoFluid(Scene scene, PetscReal R0);
PETSC_EXTERN PetscReal SceneCellsFor(AutoFluid fluid, PetscReal error, PetscBool many);

/* SceneSquareCells - the fewest square cells that fill a box, no larger than h, with a common divisor of their numbers
   that Fourier transforms like; false where it takes more than SCENE_MOST_ACROSS in a direction. SceneWallCells - those
   that are no larger than h and leave no more than `error` of R0 at a wall `gap` away; false where none does up to the
   finest that was measured (autogrid.c). Not collective. */
#define SCENE_MOST_ACROSS 4096
PETSC_EXTERN PetscBool SceneSquareCells(const PetscReal box[4], PetscReal h, PetscInt cells[2]);
PETSC_EXTERN PetscBool SceneWallCells(AutoFluid fluid, const PetscReal box[4], PetscReal h, PetscReal R0, PetscReal gap,
                                      PetscReal error, PetscInt cells[2]);

/* SceneReportGrid - print what grid and walls leave, and what it would take (autogrid.c). SceneReport - print what is
   chosen, and why, and the warning of the model. Collective. */
PETSC_EXTERN PetscErrorCode SceneReportGrid(Scene scene);
PETSC_EXTERN PetscErrorCode SceneReport(Scene scene);

/* SceneRoughTail - the largest tail (SpectralTail beyond two thirds of the modes) of a shape that markers resolve:
   0.15, with -scheme_auto by the error wanted. Not collective. */
PETSC_EXTERN PetscReal SceneRoughTail(Scene scene);
