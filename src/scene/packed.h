/* Where vesicles lie: at the centres given, or packed into the box. */
#pragma once
#include "curve/packing.h"
#include "scene/vesiclekinds.h"

/* ScenePlace - pose[vesicles] by -vesicle_center and -vesicle_angle, or packed. Collective; stops with the user's
   message when there is no room. */
PETSC_EXTERN PetscErrorCode ScenePlace(Scene scene, const Kinds *kinds, Pose pose[]);
