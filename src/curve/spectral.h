/* Derivatives with respect to the marker index, and shifts of it, in the discrete Fourier space of one closed curve. */
#pragma once
#include "base/base.h"

typedef struct _p_Spectral *Spectral;

/* SpectralCreate - for a curve of n markers. */
PETSC_EXTERN PetscErrorCode SpectralCreate(PetscInt n, Spectral *spectral);
PETSC_EXTERN PetscErrorCode SpectralDestroy(Spectral *spectral);

/* SpectralDerivative - Y += scale d^power X/dk^power for power 1, 2 or 4, k the marker index; X[2n], Y[2n] interlaced
   x, y. Odd powers drop the Nyquist mode of an even n, so that the first derivative is antisymmetric. */
PETSC_EXTERN void SpectralDerivative(Spectral spectral, int power, PetscReal scale, const PetscScalar X[],
                                     PetscScalar Y[]);

/* SpectralShift - Y_k = X at the label t_k + phi, t_k = 2 pi k/n, of the trigonometric polynomial through X: mode m
   times e^{i m phi}, the Nyquist mode of an even n times cos(n phi/2). `each` numbers a marker, 1 or 2 (interlaced).
   For odd n it keeps the sum of squares. Y may be X. */
PETSC_EXTERN void SpectralShift(Spectral spectral, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]);
