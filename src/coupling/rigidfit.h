/* How a curve lies: its markers' mean, and the shift of labels and the turn by which another curve fits it best. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscInt shift;     /* marker k of the other curve is marker k + shift of this one */
  PetscReal turn[2];  /* cosine and sine of the turn from the other curve to this one */
  PetscReal distance; /* root mean square of what is left (length) */
} RigidFit;

/* RigidFitCentre - y = X less the mean of its n markers: [2n], interlaced x, y. Not collective. */
PETSC_EXTERN void RigidFitCentre(PetscInt n, const PetscReal X[], PetscReal Y[]);

/* RigidFitSizes - of a centred curve what no turn and no shift of labels changes: |a_m| of the modes a_m = (1/n) SUM
   x_k e^{-i m k 2 pi/n}, m = 1, -1, 2, -2, .., and the root of the sum of squares of all others. RigidFitLeast - of two
   curves' sizes: the distance of RigidFitCurves is not less. Not collective. */
#define RIGIDFIT_SIZES 9
PETSC_EXTERN void RigidFitSizes(PetscInt n, const PetscReal X[], PetscReal size[RIGIDFIT_SIZES]);
PETSC_EXTERN PetscReal RigidFitLeast(const PetscReal a[RIGIDFIT_SIZES], const PetscReal b[RIGIDFIT_SIZES]);

/* RigidFitCurves - of the centred curve X to the centred curve Y, n markers each: in complex numbers the j with the
   largest |c_j|, c_j = SUM_k conj(y_k) x_{k+j}, and e^{i theta} = c_j/|c_j|, which leave the least SUM |x_{k+j} - e^{i
   theta} y_k|^2. Not collective. */
PETSC_EXTERN RigidFit RigidFitCurves(PetscInt n, const PetscReal X[], const PetscReal Y[]);

/* RigidFitTurn - n vectors x turned from the other curve's frame to this one's, or (back) the other way. RigidFitInto -
   y is in the other curve's frame what x is at the n markers of this one: vectors (each = 2) turned, numbers (1) as
   they are. RigidFitBack - the other way round. Not collective. */
PETSC_EXTERN void RigidFitTurn(const RigidFit *fit, PetscBool back, PetscInt n, const PetscReal x[], PetscReal y[]);
PETSC_EXTERN void RigidFitInto(const RigidFit *fit, int each, PetscInt n, const PetscReal x[], PetscReal y[]);
PETSC_EXTERN void RigidFitBack(const RigidFit *fit, int each, PetscInt n, const PetscReal x[], PetscReal y[]);
