/* -scheme_auto: boundaries, box and grid, where they are not given (docs/settings.md). */
#pragma once
#include "scene/spec.h"

/* Each function writes a setting's value as a user would, or nothing where the default stays, and the reason, or
   nothing where the setting is not worth a line. Boundaries come first, then a box as large as the error asks for,
   unless walls are part of the question, then the grid, for the vesicles and their distance from walls. Collective.
   Errors: no square cells, or too many of them. */
PETSC_EXTERN PetscErrorCode SceneSuggestBoundaryX(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestBoundaryY(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestBox(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
PETSC_EXTERN PetscErrorCode SceneSuggestCells(Draft scene, char value[AUTO_TEXT], char why[AUTO_TEXT]);
