/* The double layer of curves near one another, on finer points (docs/nearfield.md, Close membranes). */
#pragma once
#include "coupling/doublelayer.h"

/* DoubleCloseAdd - what finer points change in a block [2 n_column][2 n_row], if its curves are near one another. Not
   collective. */
PETSC_EXTERN PetscErrorCode DoubleCloseAdd(DoubleLayer layer, const DoubleBlock *block, PetscReal value[]);
