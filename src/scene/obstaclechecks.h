/* What goes with obstacles, and where they and the vesicles among them may be. */
#pragma once
#include "scene/spec.h"

/* SceneCheckObstacles - method, places and sizes of the obstacles and of the vesicles among them; finds what is around
   each. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode SceneCheckObstacles(Draft scene);
