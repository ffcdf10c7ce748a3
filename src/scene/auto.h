/* -scheme_auto: the settings that reach a wanted error, by what was measured. */
#pragma once
#include "scene/spec.h"

/* When a setting is chosen: before the checks, when lists are checked, when vesicles are known; or never. */
typedef enum { AUTO_FIRST, AUTO_DOMAIN, AUTO_STEPS, AUTO_NEVER } AutoStage;

/* SceneChooseByError - with -scheme_auto: the settings of a stage that the user does not give. Collective. Errors:
   outside of what was measured, and schemes that have no error control. SceneReport - print what -scheme_auto has
   chosen, and why, and the warning of the model. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseByError(Draft scene, AutoStage stage);
PETSC_EXTERN PetscErrorCode SceneReport(Scene scene);
