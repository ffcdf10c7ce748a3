/* Markers moved back to their membrane's area and edge lengths after a step (docs/method.md). */
#include "membrane/membrane.h"

#define MAX_NEWTON 20
#define CONVERGED 1e-10 /* of squared edges and area; Newton ends far below it or not at all */

/* e: edges at the vertices, dX/dk, or half the chord from k-1 to k+1, which is the mean of two edges. Returns the sum
   of their lengths. */
static PetscReal VertexEdges(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar e[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal size = 0;
  MembraneEdges(m, v, X, e);
  if (m->derivative != DERIVATIVE_SPECTRAL)
    for (PetscInt k = 0; k < n; k++)
      for (int c = 0; c < 2; c++) e[2 * k + c] = 0.5 * (X[2 * ((k + 1) % n) + c] - X[2 * ((k + n - 1) % n) + c]);
  for (PetscInt k = 0; k < n; k++) size += PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
  return size;
}

/* X += d times the normals of the edges e. */
static void MoveAlong(PetscInt n, PetscReal d, const PetscScalar e[], PetscScalar X[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal length = PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    const PetscReal normal[2] = {e[2 * k + 1] / length, -e[2 * k] / length};
    for (int c = 0; c < 2; c++) X[2 * k + c] += d * normal[c];
  }
}

PetscReal MembraneRestoreArea(Membrane m, PetscInt v, PetscScalar X[], PetscInt count, PetscScalar *const X_old[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *e = m->work.restore;
  PetscReal shift = 0;
  for (int it = 0; it < 6; it++) {
    Measures measures;
    MembraneMeasure(m, v, X, &measures);
    if (PetscAbsReal(measures.area / m->A0[v] - 1) < 1e-13) break;
    const PetscReal size = VertexEdges(m, v, X, e), d = (m->A0[v] - measures.area) / size; /* dA/dshift = SUM |e| */
    MoveAlong(n, d, e, X);
    for (PetscInt j = 0; j < count; j++) MoveAlong(n, d, e, X_old[j]);
    shift += d;
  }
  return shift;
}

void MembraneMoveNormally(Membrane m, PetscInt v, PetscReal distance, PetscScalar X[]) {
  (void)VertexEdges(m, v, X, m->work.restore);
  MoveAlong(LayoutCount(m->layout, v), distance, m->work.restore, X);
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
