/* The exact single or double layer of one closed curve at any point, in unbounded fluid: with the density F (force
   times ds) or J (jump of the velocity) and the curve X(t) of n markers as complex numbers, r = X - z, the single layer
   (docs/nearfield.md) is

       u + i v = n/(8 pi^2 nu) INT -ln|r| F + r Re(F conj(r))/|r|^2 dt
       p = -n/(4 pi^2) INT Re(F/r) dt

   and the double layer (docs/contrast.md, Output)

       u + i v = -(1/4 pi i) INT J X'/r - J conj(X'/r) + conj(J) X'/conj(r) - r conj(J X'/r^2) dt
       p = (nu/pi) Im INT J X'/r^2 dt.

   The trapezoidal rule takes finer points, or the markers of a distant single layer, and next to the curve what the
   rule lacks at the integrands' poles comes on top in closed form. Nothing crosses ranks. */
#pragma once
#include "layers/pairkernel.h"
#include "numerics/fourierseries.h"

typedef struct _p_CurveLayer *CurveLayer;

/* CurveLayerCreate - of n markers X[2n] with densities density[2n], in a fluid of viscosity nu. Not collective. */
PETSC_EXTERN PetscErrorCode CurveLayerCreate(const PairKernel *kernel, PetscInt n, PetscReal nu, const PetscReal X[],
                                             const PetscReal density[], CurveLayer *layer);
PETSC_EXTERN PetscErrorCode CurveLayerDestroy(CurveLayer *layer);

/* CurveLayerAdd - add the velocity to u[2] (length/time) and the pressure to p (length^2/time^2, zero far away) at
   x[2]. A point on the curve gets the values outside. inside: whether x is inside the curve, where the finer
   points are summed. Not
   collective. */
PETSC_EXTERN void CurveLayerAdd(CurveLayer layer, const PetscReal x[2], PetscReal u[2], PetscReal *p,
                                PetscBool *inside);

/* CurveLayerContains - whether x, farther from the curve than its points are from one another, is inside. Not
   collective. */
PETSC_EXTERN PetscBool CurveLayerContains(CurveLayer layer, const PetscReal x[2]);
