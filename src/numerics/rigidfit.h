/* The rigid motion by which one closed curve fits another best (Procrustes or Kabsch fit), labels included.

   For two centred curves of n markers as complex numbers, x_k and y_k, the shift j of labels and the turn theta that
   leave the least SUM |x_{k+j} - e^{i theta} y_k|^2 are those of the correlation
       c_j = SUM_k conj(y_k) x_{k+j},      j: |c_j| is largest,      e^{i theta} = c_j/|c_j|.
   What is left is a distance of two shapes. The sizes of a curve's modes bound it from below at a small cost. */
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

/* RigidFitCurves - how the other centred curve Y lies on the centred curve X, n markers each, with labels shifted
   or only turned. Not collective. */
PETSC_EXTERN RigidFit RigidFitCurves(PetscInt n, PetscBool shifted, const PetscReal X[], const PetscReal Y[]);

/* RigidFitTurn - n vectors x turned from the other curve's frame to this one's, or (back) the other way. RigidFitInto -
   y is in the other curve's frame what x is at the n markers of this one: vectors (each = 2) turned, numbers (1) as
   they are. RigidFitBack - y is at the markers of this curve what x is in the other curve's frame. Not collective. */
PETSC_EXTERN void RigidFitTurn(const RigidFit *fit, PetscBool back, PetscInt n, const PetscReal x[], PetscReal y[]);
PETSC_EXTERN void RigidFitInto(const RigidFit *fit, int each, PetscInt n, const PetscReal x[], PetscReal y[]);
PETSC_EXTERN void RigidFitBack(const RigidFit *fit, int each, PetscInt n, const PetscReal x[], PetscReal y[]);
