/* Checks that involve more than one option. */
#pragma once
#include "scene/spec.h"

#define SCENE_MOST_FREE 30 /* vesicles in unbounded fluid: all pairs are summed, beyond it a large box is faster */

/* SceneCheck - scheme, lists, background flow and vesicles, before anything is made. SceneCheckCells - that cells are
   square; the box is known. SceneCheckBodies - unbounded fluid, a custom flow's divergence, gravity, drive and
   viscosities; the vesicles are known. Collective; stop with the user's message. */
PETSC_EXTERN PetscErrorCode SceneCheck(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckCells(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckBodies(Scene scene);
