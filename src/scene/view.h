/* -view: the model in force. */
#pragma once
#include "scene/spec.h"

/* SceneView - print which parts of the model are on, their numbers, and the defaults that depend on the scene, each
   with its reason. Collective. */
PETSC_EXTERN PetscErrorCode SceneView(Scene scene, PetscViewer viewer);
