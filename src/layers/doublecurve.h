/* The exact double layer of one closed curve at any point, in unbounded fluid (docs/contrast.md, Output):
   with the density J and the curve X(t) as complex numbers, r = X - z,

       u + i v = -(1/4 pi i) INT J X'/r - J conj(X'/r) + conj(J) X'/conj(r) - r conj(J X'/r^2) dt
       p = (nu/pi) Im INT J X'/r^2 dt

   by the trapezoidal rule on finer points, and next to the curve with what the rule lacks at the integrands' poles in
   closed form. Nothing crosses ranks. */
#pragma once
#include "numerics/fourierseries.h"

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

/* CurveNearest - the nearest to z of n points X[2n], and how far it is. CurveRoot - the complex parameter t0, from
   about t0 on, where the curve of n modes is at z, and the slope there; false unless it is found so near to the real
   line that the trapezoidal rule on N points lacks something, which is within `close` of their spacings. CurvePole -
   what that rule lacks of INT f dt over a period of 2 pi, f with the pole twice/(t - t0)^2 + once/(t - t0). Not
   collective. */
PETSC_EXTERN PetscInt CurveNearest(PetscInt n, const PetscReal X[], Point z, PetscReal *distance);
PETSC_EXTERN PetscBool CurveRoot(PetscInt n, const Point curve[], PetscInt N, PetscReal close, Point z, Point *t0,
                                 Point *slope);
PETSC_EXTERN Point CurvePole(PetscInt N, Point t0, Point twice, Point once);
