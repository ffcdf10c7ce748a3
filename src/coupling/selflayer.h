/* The exact mobility of one closed curve in unbounded fluid: the free-space single layer by Kress' quadrature
   (docs/nearfield.md, Pairs of markers). */
#pragma once
#include "curve/spectral.h"

/* SelfLayer - S[2n][2n] of the curve through the markers X[2n], entries interlaced x, y: velocity per force times ds,
   density 1 and viscosity nu; `unit`: the length whose logarithm is 0. Symmetric. Not collective. */
PETSC_EXTERN PetscErrorCode SelfLayer(Spectral spectral, PetscInt n, PetscReal nu, PetscReal unit, const PetscReal X[],
                                      PetscReal S[]);
