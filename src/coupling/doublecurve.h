/* The exact double layer of one closed curve at any point, in unbounded fluid (docs/contrast.md, Output):
   with the density J and the curve X(t) as complex numbers, r = X - z,

       u + i v = -(1/4 pi i) INT J X'/r - J conj(X'/r) + conj(J) X'/conj(r) - r conj(J X'/r^2) dt
       p = (nu/pi) Im INT J X'/r^2 dt

   by the trapezoidal rule on finer points, and next to the curve with what the rule lacks at the poles in closed form.
 */
#pragma once
#include "base/base.h"

typedef struct _p_DoubleCurve *DoubleCurve;

/* DoubleCurveCreate - of n markers X[2n] with densities J[2n], in a fluid of viscosity nu. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleCurveCreate(PetscInt n, PetscReal nu, const PetscReal X[], const PetscReal J[],
                                              DoubleCurve *curve);
PETSC_EXTERN PetscErrorCode DoubleCurveDestroy(DoubleCurve *curve);

/* DoubleCurveAdd - add the velocity to u[2] (length/time) and the pressure to p (length^2/time^2) at x[2]; inside:
   whether x is inside the curve. Not collective. */
PETSC_EXTERN void DoubleCurveAdd(DoubleCurve curve, const PetscReal x[2], PetscReal u[2], PetscReal *p,
                                 PetscBool *inside);

/* DoubleCurveContains - whether x, farther from the curve than its points are from one another, is inside. Not
   collective. */
PETSC_EXTERN PetscBool DoubleCurveContains(DoubleCurve curve, const PetscReal x[2]);
