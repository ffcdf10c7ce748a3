/* The double layer of curves near one another, on finer points (docs/nearfield.md, Close membranes). */
#pragma once
#include "coupling/doublelayer.h"
#include "coupling/finecurve.h"

/* DoubleCloseAdd - what finer points change in a block [2 n_column][2 n_row], if its curves are near one another. Not
   collective. */
PETSC_EXTERN PetscErrorCode DoubleCloseAdd(DoubleLayer layer, const DoubleBlock *block, PetscReal value[]);

/* DoubleCloseNormals - n w of the marker's spacing at the points of a curve in use: N[2 count] from the markers'
   normal[2n]. Not collective. */
PETSC_EXTERN void DoubleCloseNormals(const FineCurve *curve, const PetscReal normal[], PetscReal N[]);
