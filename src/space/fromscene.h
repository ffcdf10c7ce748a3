/* The vesicles of a scene in three dimensions. */
#pragma once
#include "scene/scene.h"
#include "scene/space.h"
#include "space/space.h"

/* SpaceFromScene - the space of a resolved scene, its vesicles at the start. Collective. Errors: the user's message
   where vesicles overlap. */
PETSC_EXTERN PetscErrorCode SpaceFromScene(Scene scene, Space *space);
