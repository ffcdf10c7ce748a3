#include "bodies/membrane.h"

PetscErrorCode MembraneSetWeight(Membrane m, const PetscReal weight[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->weight));
  PetscCall(PetscMalloc1(2 * m->layout->bodies, &m->weight));
  PetscCall(PetscArraycpy(m->weight, weight, 2 * m->layout->bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A constant pressure has no effect: with positions from the centroid numbers stay small. */
void MembraneVesicleGravity(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  const PetscReal *g = m->weight + 2 * v;
  PetscScalar *T = m->work.measures;
  Measures measures;
  MembraneMeasure(m, v, X, &measures);
  (void)PetscArrayzero(T, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, T);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal p = g[0] * (X[2 * k] - measures.center[0]) + g[1] * (X[2 * k + 1] - measures.center[1]);
    F[2 * k] += alpha * p * T[2 * k + 1];
    F[2 * k + 1] -= alpha * p * T[2 * k];
  }
}

void MembraneGravity(Membrane m, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  for (PetscInt v = m->layout->own; v < m->layout->end && m->weight; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v);
    MembraneVesicleGravity(m, v, alpha, X + at, F + at);
  }
}

PetscReal MembraneGravityEnergy(Membrane m, PetscInt v, const PetscScalar X[]) {
  Measures measures;
  if (!m->weight) return 0;
  MembraneMeasure(m, v, X, &measures);
  return -measures.area * (m->weight[2 * v] * measures.center[0] + m->weight[2 * v + 1] * measures.center[1]);
}

void MembraneCentroidVelocity(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[],
                              PetscReal velocity[2]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *T = m->work.measures;
  Measures measures;
  MembraneMeasure(m, v, X, &measures);
  (void)PetscArrayzero(T, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, T);
  velocity[0] = velocity[1] = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal across = U[2 * k] * T[2 * k + 1] - U[2 * k + 1] * T[2 * k];
    for (int c = 0; c < 2; c++) velocity[c] += (X[2 * k + c] - measures.center[c]) * across / measures.area;
  }
}
