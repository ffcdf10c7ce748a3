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

/* SpectralTail - how much of a curve's bending is in modes above `part` of the highest, K = (n - 1)/2: the root of
   SUM m^4 |X_m|^2 over |m| > part K, divided by that over all modes. Small where markers resolve the curve. */
PETSC_EXTERN PetscReal SpectralTail(Spectral spectral, PetscReal part, const PetscScalar X[]);

/* TrigonometricCardinal - the function of trigonometric interpolation on n points: 1 at t = 0, 0 at the others, t the
   distance from 0 to 2 pi. TrigonometricPoints - the curve through n points X[2n] at `times` as many, Y[2 times n]. Not
   collective. */
PETSC_EXTERN PetscReal TrigonometricCardinal(PetscInt n, PetscReal t);
PETSC_EXTERN void TrigonometricPoints(PetscInt n, const PetscReal X[], PetscInt times, PetscReal Y[]);

/* SpectralShift - Y_k = X at the label t_k + phi, t_k = 2 pi k/n, of the trigonometric polynomial through X: mode m
   times e^{i m phi}, the Nyquist mode of an even n times cos(n phi/2). `each` numbers a marker, 1 or 2 (interlaced).
   For odd n it keeps the sum of squares. Y may be X. */
PETSC_EXTERN void SpectralShift(Spectral spectral, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]);
