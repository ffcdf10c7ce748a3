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

void MembraneTangents(Membrane m, PetscInt vesicle, PetscInt end, const PetscScalar X[], PetscReal tau[]) {
  const PetscInt *start = m->layout->start;
  for (PetscInt v = vesicle; v < end; v++) {
    PetscReal *own = tau + 2 * (start[v] - start[vesicle]);
    MembraneEdges(m, v, X + 2 * (start[v] - start[vesicle]), own);
    for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) own[k] /= m->ds[v];
  }
}

void MembraneVesiclePull(Membrane m, PetscInt v, PetscReal alpha, const PetscReal tension[], const PetscScalar X[],
                         PetscScalar F[]) {
  PetscScalar *e = m->work.stretching;
  MembraneEdges(m, v, X, e);
  for (PetscInt k = 0; k < 2 * LayoutCount(m->layout, v); k++) e[k] *= tension[k / 2] / m->ds[v];
  MembraneEdgesTranspose(m, v, alpha, e, F);
}
