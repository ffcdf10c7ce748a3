/* -scheme_auto: what the start of a scene asks for. A vesicle that the flow compresses along its length wrinkles, and
   errors of its steps grow with the wrinkles; thin shapes and thin films need more markers (docs/settings.md). */
#pragma once
#include "scene/spec.h"

/* SceneSqueeze - nu R0^3/c_b times the rate at which the flow shortens a vesicle of the start along its length, the
   largest; 0 where it is so small that none wrinkles. Not collective. */
PETSC_EXTERN PetscReal SceneSqueeze(Scene scene);

/* SceneChooseMarkers - with -scheme_auto, where the user gives neither their number nor their spacing: more than the
   default where the start needs it, in steps of a fifth up to three times, and not closer than the near field bears;
   the shape is made anew. SceneReportFilm - print what the thinnest film of the start leaves. Collective. */
PETSC_EXTERN PetscErrorCode SceneChooseMarkers(Draft scene);
PETSC_EXTERN PetscErrorCode SceneReportFilm(Scene scene);
