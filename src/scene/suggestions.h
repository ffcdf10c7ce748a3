/* What people ask for by names that the program does not have: the option that does it, or that nothing does; and what
   a scene has no use for. */
#pragma once
#include "scene/spec.h"

/* SceneCheckUsed - stop when the user gave an option of the table that the scene does not use. SceneCheckUnused - stop
   when the options database holds an option that nothing has read: one of a solver that the scene does not have, or one
   that there is not; when all solvers are set up. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckUsed(Scene scene);
PETSC_EXTERN PetscErrorCode SceneCheckUnused(Scene scene);
