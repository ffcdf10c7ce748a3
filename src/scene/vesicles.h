/* The initial markers of a scene's vesicles. */
#pragma once
#include "scene/packed.h"

/* SceneMakeShape - the initial markers of the scene's vesicles, all edges of a vesicle equal to 1e-12, and their
   bending stiffnesses. Every rank gets all of it. Collective; stops with the user's message on a bad file, spacing or
   position, and when a packing has no room. SceneDropShape - what it has made is gone, so that it can be made anew. */
PETSC_EXTERN PetscErrorCode SceneMakeShape(Draft scene);
PETSC_EXTERN PetscErrorCode SceneDropShape(Draft scene);

/* KindExtend - make the rectangle around[4] (x_min, x_max, y_min, y_max; KIND_NOWHERE is empty) hold a kind's curve,
   turned and moved. Not collective. */
#define KIND_NOWHERE                                                                                                   \
  { PETSC_MAX_REAL, -PETSC_MAX_REAL, PETSC_MAX_REAL, -PETSC_MAX_REAL }
PETSC_EXTERN void KindExtend(const Kind *kind, const Pose *at, PetscReal around[4]);
