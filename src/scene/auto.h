/* -scheme_auto: the settings that reach a wanted error, by what was measured. */
#pragma once
#include "scene/spec.h"

/* When a setting is chosen: before the checks, when lists are checked, or when vesicles are known. */
typedef enum { AUTO_FIRST, AUTO_DOMAIN, AUTO_STEPS } AutoStage;

/* SceneChooseByError - with -scheme_auto: the settings of a stage that the user does not give, and the reason of each.
   Errors: outside of what was measured, and schemes that have no error control. SceneChooseMarkers - with -scheme_auto,
   where the user gives neither their number nor their spacing: more markers than the default where the start needs
   them, in steps of a fifth up to three times as many, and not closer than the near field bears; the shape is made
   anew. SceneReport - print what is chosen, and why, and the warning of the model. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseByError(Draft scene, AutoStage stage);
PETSC_EXTERN PetscErrorCode SceneChooseMarkers(Draft scene);
PETSC_EXTERN PetscErrorCode SceneReport(Scene scene);
