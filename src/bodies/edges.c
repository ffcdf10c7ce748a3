#include "bodies/membrane.h"

void MembraneEdges(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar e[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  if (m->derivative == DERIVATIVE_SPECTRAL) {
    (void)PetscArrayzero(e, 2 * n);
    SpectralDerivative(m->spectral[v], 1, 1, X, e);
    return;
  }
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) e[2 * k + c] = X[2 * k + c] - X[2 * (k ? k - 1 : n - 1) + c];
}

void MembraneEdgesTranspose(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar F[], PetscScalar Y[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  if (m->derivative == DERIVATIVE_SPECTRAL) { /* D is antisymmetric */
    SpectralDerivative(m->spectral[v], 1, -alpha, F, Y);
    return;
  }
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) Y[2 * k + c] += alpha * (F[2 * k + c] - F[2 * (k < n - 1 ? k + 1 : 0) + c]);
}

void MembraneVesicleTangents(Membrane m, PetscInt v, const PetscScalar X[], PetscReal tau[]) {
  MembraneEdges(m, v, X, tau);
  for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) tau[k] /= m->ds[v];
}

void MembraneTangents(Membrane m, const PetscScalar X[], PetscReal tau[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    MembraneVesicleTangents(m, v, X + at, tau + at);
  }
}

void MembraneVesicleStretching(Membrane m, PetscInt v, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]) {
  PetscScalar *e = m->work.stretching;
  MembraneEdges(m, v, U, e);
  for (PetscInt k = 0; k < LayoutCount(m->layout, v); k++) d[k] = tau[2 * k] * e[2 * k] + tau[2 * k + 1] * e[2 * k + 1];
}

void MembraneStretching(Membrane m, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = LayoutOffset(m->layout, v);
    MembraneVesicleStretching(m, v, tau + 2 * at, U + 2 * at, d + at);
  }
}

/* Whether all n numbers are zero, as the tension that turns with the edges is on most vesicles. */
static PetscBool TensionIsZero(PetscInt n, const PetscReal x[]) {
  for (PetscInt k = 0; k < n; k++)
    if (x[k] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

void MembraneStretchingTranspose(Membrane m, const PetscReal tau[], PetscReal alpha, const PetscScalar sigma[],
                                 PetscScalar F[]) {
  PetscScalar *pull = m->work.stretching;
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = LayoutOffset(m->layout, v);
    if (TensionIsZero(LayoutCount(m->layout, v), sigma + at)) continue;
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) pull[k] = tau[2 * at + k] * sigma[at + k / 2];
    MembraneEdgesTranspose(m, v, alpha, pull, F + 2 * at);
  }
}

void MembraneVesiclePull(Membrane m, PetscInt v, PetscReal alpha, const PetscReal tension[], const PetscScalar X[],
                         PetscScalar F[]) {
  PetscScalar *e = m->work.stretching;
  MembraneEdges(m, v, X, e);
  for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) e[k] *= tension[k / 2] / m->ds[v];
  MembraneEdgesTranspose(m, v, alpha, e, F);
}

void MembranePull(Membrane m, PetscReal alpha, const PetscReal tension[], const PetscScalar X[], PetscScalar F[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = LayoutOffset(m->layout, v);
    if (TensionIsZero(LayoutCount(m->layout, v), tension + at)) continue;
    MembraneVesiclePull(m, v, alpha, tension + at, X + 2 * at, F + 2 * at);
  }
}
