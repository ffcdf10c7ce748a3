/* Scenes in three dimensions (-dim 3): which options they have, and what follows from them. */
#pragma once
#include "scene/spec.h"

/* SceneSpaceMissing - an option's group, for OptionTable.missing: options of the plane in space. Not collective. */
PETSC_EXTERN const char *SceneSpaceMissing(const OptionRow *row, const void *scene);

/* SceneResolveSpace - check the options of a scene in three dimensions; the flow's rate or peak velocity from -flow_chi
   or -flow_ca; the rate of labels. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode SceneResolveSpace(Draft scene);

/* SceneViewSpace - the model in force. Collective. */
PETSC_EXTERN PetscErrorCode SceneViewSpace(Scene scene, PetscViewer viewer);

/* Flow3Velocities - u[3][n] of the background flow at X[3][n]. Shear (rate (y - y_c), 0, 0), extension (rate x, -rate
   y, 0), axial (rate x, -rate y/2, -rate z/2), poiseuille u_max (1 - ((y - y_c)/L)^2) along x, tube u_max (1 - (y^2 +
   z^2)/L^2) along x, uniform. Not collective. */
PETSC_EXTERN void Flow3Velocities(const Flow *flow, PetscInt n, const PetscReal X[], PetscReal u[]);
