/* The matrices of one pattern. */
#pragma once
#include "coupling/patterns.h"

/* PatternMake - inverse, forces, and with a coarse grid self, weight and points, for the patterns' a0 and tables. good
   is false when a matrix is singular. Not collective. */
PETSC_EXTERN PetscErrorCode PatternMake(Patterns patterns, Pattern *pattern, PetscBool *good);
