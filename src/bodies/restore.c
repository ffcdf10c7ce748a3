#include "bodies/membrane.h"

#define MAX_NEWTON 20
/* Relative error of squared edges and area: Newton's method ends far below it or does not converge. */
#define CONVERGED 1e-10
#define LENGTH_RIGHT 1e-13
#define CIRCLE 1e-3 /* sin^2 of the angle between the gradients of area and length; below it they are parallel */

/* Edges e at the vertices: dX/dk, or half the chord from k-1 to k+1, the mean of two edges. Returns the sum of their
   lengths. */
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

PetscReal MembraneRestoreArea(Membrane m, PetscInt v, PetscScalar X[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *e = m->work.restore;
  PetscReal shift = 0;
  for (int it = 0; it < 6; it++) {
    Measures measures;
    MembraneMeasure(m, v, X, &measures);
    if (PetscAbsReal(measures.area / m->A0[v] - 1) < 1e-13) break;
    const PetscReal size = VertexEdges(m, v, X, e), d = (m->A0[v] - measures.area) / size; /* dA/dshift = SUM |e| */
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal length = PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
      X[2 * k] += d * e[2 * k + 1] / length;
      X[2 * k + 1] -= d * e[2 * k] / length;
    }
    shift += d;
  }
  return shift;
}

void MembraneAreaGradient(Membrane m, PetscInt v, const PetscScalar X[], PetscReal z[]) {
  PetscScalar *e = m->work.restore;
  (void)VertexEdges(m, v, X, e);
  for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++) {
    z[2 * k] = e[2 * k + 1];
    z[2 * k + 1] = -e[2 * k];
  }
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

/* Gradients of the area and of the length by the markers: vertex normals, and D^T of the unit edges. */
static void RestoreGradients(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar area[], PetscScalar length[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *e = m->work.restore;
  MembraneAreaGradient(m, v, X, area);
  MembraneEdges(m, v, X, e);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal size = PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    for (int c = 0; c < 2; c++) e[2 * k + c] /= size;
  }
  (void)PetscArrayzero(length, 2 * n);
  MembraneEdgesTranspose(m, v, 1, e, length);
}

PetscErrorCode MembraneRestoreLength(Membrane m, PetscInt v, PetscReal tolerance, PetscScalar X[]) {
  const PetscInt n = 2 * LayoutCount(m->layout, v);
  PetscScalar *area, *length;
  PetscReal wanted = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &area, n, &length));
  for (int it = 0; it < 4; it++) {
    PetscReal aa = 0, al = 0, ll = 0;
    Measures measures;
    MembraneMeasure(m, v, X, &measures);
    if (it == 0) wanted = measures.area;
    const PetscReal long_by = measures.length - m->L0[v], large_by = measures.area - wanted;
    if (PetscAbsReal(long_by) < LENGTH_RIGHT * m->L0[v] || !(PetscAbsReal(long_by) < tolerance * m->L0[v])) break;
    RestoreGradients(m, v, X, area, length);
    for (PetscInt k = 0; k < n; k++) {
      aa += area[k] * area[k];
      al += area[k] * length[k];
      ll += length[k] * length[k];
    }
    const PetscReal det = aa * ll - al * al;
    if (!(det > CIRCLE * aa * ll)) break;
    for (PetscInt k = 0; k < n; k++)
      X[k] -= ((aa * long_by - al * large_by) * length[k] + (ll * large_by - al * long_by) * area[k]) / det;
  }
  PetscCall(PetscFree2(area, length));
  PetscFunctionReturn(PETSC_SUCCESS);
}
