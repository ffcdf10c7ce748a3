/* The matrices of one shape. */
#pragma once
#include "precondition/shapeset.h"

/* SharedShapeMake - inverse, forces, and with a coarse grid self, weight and points, for the shapes' a0 and tables.
   good is false when a matrix is singular. Not collective. */
PETSC_EXTERN PetscErrorCode SharedShapeMake(SharedShapes shapes, SharedShape *shape, PetscBool *good);
