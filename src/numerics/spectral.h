/* Derivatives along a closed curve, and shifts along it, by sums with circulant matrices (circulant.h).

   A curve of n markers X_k is the trigonometric polynomial through the markers, with k = n t/(2 pi) as its variable. In
   mode m the derivative d/dk multiplies by 2 pi i m/n and the shift by an angle phi by e^{i m phi}. All functions work
   on one rank. */
#pragma once
#include "base/base.h"

typedef struct _p_Spectral *Spectral;

/* SpectralCreate - for curves of n markers. Not collective. */
PETSC_EXTERN PetscErrorCode SpectralCreate(PetscInt n, Spectral *spectral);
PETSC_EXTERN PetscErrorCode SpectralDestroy(Spectral *spectral);

/* SpectralDerivative - Y += scale d^power X/dk^power, power 1, 2 or 4; X[2n], Y[2n] interlaced. The first derivative
   drops the Nyquist mode of an even n, so that it is antisymmetric. Not collective. */
PETSC_EXTERN void SpectralDerivative(Spectral spectral, int power, PetscReal scale, const PetscScalar X[],
                                     PetscScalar Y[]);

/* SpectralSlopes - slope[2][2][2n] (power - 1, place, marker) is scale[power - 1] d^power X/dk^power of X[2n] for the
   powers 1 and 2, at the points and then halfway to the next ones, as SpectralDerivative and SpectralShift have them.
   SpectralSlopesTranspose - Y[2n] += what the transpose of this map makes of slope. Both by fast
   transforms. Not collective. */
PETSC_EXTERN void SpectralSlopes(Spectral spectral, const PetscReal scale[2], const PetscScalar X[], PetscReal slope[]);
PETSC_EXTERN void SpectralSlopesTranspose(Spectral spectral, const PetscReal scale[2], const PetscReal slope[],
                                          PetscScalar Y[]);

/* SpectralTail - the part of a curve's bending in modes above part K, K = (n - 1)/2 the highest mode:

     root( SUM_{|m| > part K} m^4 |X_m|^2 / SUM_m m^4 |X_m|^2 ).

   It is small where the markers resolve the curve. Not collective. */
PETSC_EXTERN PetscReal SpectralTail(Spectral spectral, PetscReal part, const PetscScalar X[]);

/* SpectralShift - Y_k = X at the angle t_k + phi, t_k = 2 pi k/n, of the trigonometric polynomial through X; the
   Nyquist mode of an even n is multiplied by cos(n phi/2). `each`: numbers a marker, 1 or 2 (interlaced). For odd n the
   shift keeps the sum of squares. Y may be X. Not collective. */
PETSC_EXTERN void SpectralShift(Spectral spectral, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]);

/* TrigonometricCardinal - the trigonometric polynomial of n points that is 1 at the angle t = 0 and 0 at the other
   points. TrigonometricPoints - Y[2 times n], `times` as many points on the curve through the points X[2n]. Not
   collective. */
PETSC_EXTERN PetscReal TrigonometricCardinal(PetscInt n, PetscReal t);
PETSC_EXTERN void TrigonometricPoints(PetscInt n, const PetscReal X[], PetscInt times, PetscReal Y[]);
