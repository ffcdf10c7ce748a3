/* The double layer of membranes nearer to a wall than to their next marker: the exact image on finer points. */
#pragma once
#include "coupling/doublelayer.h"

/* DoubleWallAdd - to the block of two curves whose images in a wall are nearer than two marker spacings, the difference
   between the exact image on finer points of both and on the markers; nothing to others. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleWallAdd(DoubleLayer layer, const DoubleBlock *block, PetscReal value[]);
