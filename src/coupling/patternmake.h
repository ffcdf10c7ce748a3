/* The matrices of one pattern. */
#pragma once
#include "coupling/patterns.h"

/* PatternMake - inverse, forces, and with a coarse grid self, weight and points, for the patterns' a0 and tables. good
   is false when a matrix is singular. Not collective. */
PETSC_EXTERN PetscErrorCode PatternMake(Patterns patterns, Pattern *pattern, PetscBool *good);

/* PatternSend - a pattern's matrices to a rank that calls PatternReceive, with the sender's rank, for it. */
PETSC_EXTERN PetscErrorCode PatternSend(Patterns patterns, Pattern *pattern, PetscMPIInt rank);
PETSC_EXTERN PetscErrorCode PatternReceive(Patterns patterns, Pattern *pattern, PetscMPIInt rank);
