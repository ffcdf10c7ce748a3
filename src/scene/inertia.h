/* How much inertia a scene has, and which model of the fluid goes with it. */
#pragma once
#include "scene/spec.h"

/* SceneChooseInertia - the Reynolds number (speed R0/nu with R0 of the largest vesicle and the speed of the scene: rate
   R0 of shear and extension, u_max of poiseuille, c_b/(nu R0^2) of a quiescent fluid; 0 without vesicles), the model
   that -fluid_inertia auto stands for, and the warning that goes with it. Stops with the user's message when the model
   does not fit the scene. SceneHasInertia - whether -fluid_inertia, or what auto stands for when the largest vesicle
   has this radius (0: none), has inertia; the flow is known. Collective; not collective. */
PETSC_EXTERN PetscErrorCode SceneChooseInertia(Draft scene);
PETSC_EXTERN PetscBool SceneHasInertia(Scene scene, PetscReal R0);
