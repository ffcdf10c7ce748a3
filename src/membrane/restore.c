/* Markers moved back to their membrane's area and edge lengths after a step (docs/method.md). */
#include "membrane/membrane.h"

#define MAX_NEWTON 20
#define CONVERGED 1e-10 /* of squared edges and area; Newton ends far below it or not at all */

PetscReal MembraneRestoreArea(Membrane m, PetscInt v, PetscScalar X[], PetscScalar X_old[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *e = m->work.restore;
  PetscReal shift = 0;
  for (int it = 0; it < 6; it++) {
    PetscReal size = 0, d;
    Measures measures;
    MembraneMeasure(m, v, X, &measures);
    if (PetscAbsReal(measures.area / m->A0[v] - 1) < 1e-13) break;
    MembraneEdges(m, v, X, e);
    if (m->derivative != DERIVATIVE_SPECTRAL) /* half the chord from k-1 to k+1: the mean of two edges */
      for (PetscInt k = 0; k < n; k++)
        for (int c = 0; c < 2; c++) e[2 * k + c] = 0.5 * (X[2 * ((k + 1) % n) + c] - X[2 * ((k + n - 1) % n) + c]);
    for (PetscInt k = 0; k < n; k++) size += PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    d = (m->A0[v] - measures.area) / size; /* dA/dshift = SUM |e| */
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal length = PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
      const PetscReal normal[2] = {e[2 * k + 1] / length, -e[2 * k] / length};
      for (int c = 0; c < 2; c++) {
        X[2 * k + c] += d * normal[c];
        X_old[2 * k + c] += d * normal[c];
      }
    }
    shift += d;
  }
  return shift;
}

/* Largest relative error of an edge. */
static PetscReal EdgeError(Membrane m, PetscInt v, const PetscScalar X[]) {
  PetscScalar *e = m->work.restore;
  PetscReal largest = 0;
  MembraneEdges(m, v, X, e);
  for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++)
    largest = PetscMax(largest,
                       PetscAbsReal(PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1])) / m->ds[v] - 1));
  return largest;
}

PetscErrorCode MembraneRestoreEdges(Membrane m, PetscInt v, PetscReal tolerance, PetscScalar X[], PetscReal *error) {
  const PetscInt n = LayoutCount(m->layout, v);
  const PetscBool spectral = m->derivative == DERIVATIVE_SPECTRAL ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal found = EdgeError(m, v, X);
  PetscScalar *fitted = m->work.restore;
  PetscReal left;
  Measures measures;
  PetscFunctionBeginUser;
  *error = 0;
  if (!(found > tolerance)) PetscFunctionReturn(PETSC_SUCCESS);
  MembraneMeasure(m, v, X, &measures);
  for (PetscInt k = 0; k < 2 * n; k++) fitted[k] = X[k] - X[k % 2];
  PetscCall(CurveFit(n, spectral, n * m->ds[v], measures.area, fitted, MAX_NEWTON, &left));
  if (!(left < CONVERGED)) PetscFunctionReturn(PETSC_SUCCESS);
  *error = found;
  for (PetscInt k = 0; k < 2 * n; k++) fitted[k] += X[k % 2];
  PetscCall(PetscArraycpy(X, fitted, 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
