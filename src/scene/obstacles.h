/* The solid bodies of a scene. */
#pragma once
#include "scene/spec.h"

/* SceneMakeObstacles - the markers of the scene's obstacles, equally spaced, and what their surfaces do; that the rest
   of the scene goes with them. The vesicles are known. Collective; stops with the user's message. SceneDropObstacles -
   free them. */
PETSC_EXTERN PetscErrorCode SceneMakeObstacles(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropObstacles(Draft scene);
