/* -scheme_auto: boundaries, box and grid, where they are not given (docs/settings.md). */
#pragma once
#include "scene/spec.h"

/* Each of the settings has a function that writes its value as a user would, or nothing where the default stays
   (Collective; errors: no square cells, or too many of them), and one that says why it has the value in force (not
   collective; false: the setting is not worth a line). Boundaries come first, a box as large as the error asks for,
   unless walls are part of the question, then the grid, for the vesicles and their distance from walls. */
#define AUTO_TEXT 128
PETSC_EXTERN PetscErrorCode SceneChooseBoundaryX(Draft scene, char value[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneChooseBoundaryY(Draft scene, char value[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneChooseBox(Draft scene, char value[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneChooseCells(Draft scene, char value[AUTO_TEXT]);
PETSC_EXTERN PetscBool SceneExplainBoundaryX(Scene scene, char why[AUTO_TEXT]);
PETSC_EXTERN PetscBool SceneExplainBoundaryY(Scene scene, char why[AUTO_TEXT]);
PETSC_EXTERN PetscBool SceneExplainBox(Scene scene, char why[AUTO_TEXT]);
PETSC_EXTERN PetscBool SceneExplainCells(Scene scene, char why[AUTO_TEXT]);
