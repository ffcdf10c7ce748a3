/* Scenes in three dimensions (-dim 3): which options they have, and what follows from them. */
#pragma once
#include "scene/spec.h"

/* SceneSpaceMissing - an option's group, for OptionTable.missing: options of the plane in space. Not collective. */
PETSC_EXTERN const char *SceneSpaceMissing(const OptionRow *row, const void *scene);

/* SceneResolveSpace - check the options of a scene in three dimensions; the flow's rate or peak velocity from -flow_chi
   or -flow_ca; the rate of labels. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode SceneResolveSpace(Draft scene);

/* First shapes (surfaces.c). SceneReadSurfaces - with -vesicle_file the lines of the file and the number of vesicles.
   SceneMakeSurfaces - space.X and space.R0; the lines are freed. Collective; stop with the user's message on a bad
   file. */
PETSC_EXTERN PetscErrorCode SceneReadSurfaces(Draft scene, SurfaceRows *rows);
PETSC_EXTERN PetscErrorCode SceneMakeSurfaces(Draft scene, SurfaceRows *rows);
