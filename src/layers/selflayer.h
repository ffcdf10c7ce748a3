/* The single layer of one closed curve on itself in unbounded fluid,

       S = [-1/2 ln(r^2) + r r^T/r^2]/(4 pi nu),

   by Kress' quadrature (docs/nearfield.md, Pairs of markers): on n markers at the parameters t_k = 2 pi k/n the
   trapezoidal rule takes r r^T/r^2 and ln(r^2) - ln(4 sin^2(t/2)), which are smooth, and Kress' weights take
   ln(4 sin^2(t/2)). Nothing crosses ranks. */
#pragma once
#include "layers/layersetting.h"
#include "numerics/spectral.h"

/* SelfLogarithm - own[n] by difference of two markers' numbers: Kress' weights of ln(4 sin^2(t/2)) less that logarithm,
   which is left out at 0. It comes on top of ln(r^2). Not collective. */
PETSC_EXTERN void SelfLogarithm(PetscInt n, PetscReal own[]);

/* SelfLayer - S[2n][2n] of the curve through the markers X[2n], entries interlaced x, y: velocity per force times ds,
   density 1 and the viscosity and unit of length of the setting. Symmetric. Not collective. */
PETSC_EXTERN PetscErrorCode SelfLayer(const LayerSetting *set, Spectral spectral, PetscInt n, const PetscReal X[],
                                      PetscReal S[]);
