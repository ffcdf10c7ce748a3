/* The options of a scene: read, shown, written. */
#pragma once
#include "scene/defaults.h"

/* Pairs of options that say one thing in two ways, the last ones NULL: of two sources the later one's counts. */
PETSC_EXTERN const char *const scene_alternatives[][2];

/* SceneReadOptions - every option of the table, or its default. Collective. */
PETSC_EXTERN PetscErrorCode SceneReadOptions(MPI_Comm comm, Draft scene);

/* SceneOptionRow - the i-th option of the table, NULL past the last one. Not collective, and also before PETSc starts.
 */
PETSC_EXTERN const OptionRow *SceneOptionRow(PetscInt i);

/* SceneWriteOptions - write every option of the table that the scene uses, defaults included, one "-name value" a
   line. */
PETSC_EXTERN PetscErrorCode SceneWriteOptions(Scene scene, FILE *file);
