#include "membrane/membrane.h"

PetscErrorCode MembraneCreate(const Shape *shape, PetscReal bending, Membrane *out) {
  Membrane m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->vesicles = shape->vesicles;
  m->M = shape->start[shape->vesicles];
  m->bending = bending;
  PetscCall(PetscMalloc4(m->vesicles + 1, &m->start, m->vesicles, &m->ds, m->vesicles, &m->A0, m->vesicles, &m->L0));
  PetscCall(PetscMalloc3(m->M, &m->previous, m->M, &m->next, m->M, &m->spacing));
  PetscCall(PetscArraycpy(m->start, shape->start, m->vesicles + 1));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const PetscInt first = m->start[v], n = m->start[v + 1] - first;
    Measures measures;
    for (PetscInt k = 0; k < n; k++) {
      m->previous[first + k] = first + (k + n - 1) % n;
      m->next[first + k] = first + (k + 1) % n;
    }
    MembraneMeasure(m, v, shape->X, &measures);
    m->A0[v] = measures.area;
    m->L0[v] = measures.length;
    m->ds[v] = measures.length / n;
    for (PetscInt k = 0; k < n; k++) m->spacing[first + k] = m->ds[v];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneDestroy(Membrane *membrane) {
  Membrane m = *membrane;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4(m->start, m->ds, m->A0, m->L0));
  PetscCall(PetscFree3(m->previous, m->next, m->spacing));
  PetscCall(PetscFree(*membrane));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneCreateMarkerVec(Membrane m, Vec *X) {
  PetscFunctionBeginUser;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 2 * m->M, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneCreateTensionVec(Membrane m, Vec *sigma) {
  PetscFunctionBeginUser;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, m->M, sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MembraneTangents(Membrane m, const PetscScalar X[], PetscReal tau[]) {
  for (PetscInt k = 0; k < m->M; k++)
    for (int c = 0; c < 2; c++) tau[2 * k + c] = (X[2 * k + c] - X[2 * m->previous[k] + c]) / m->spacing[k];
}

void MembraneStretching(Membrane m, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]) {
  for (PetscInt k = 0; k < m->M; k++) {
    const PetscInt p = m->previous[k];
    d[k] = tau[2 * k] * (U[2 * k] - U[2 * p]) + tau[2 * k + 1] * (U[2 * k + 1] - U[2 * p + 1]);
  }
}

void MembraneStretchingTranspose(Membrane m, const PetscReal tau[], PetscReal alpha, const PetscScalar sigma[],
                                 PetscScalar F[]) {
  for (PetscInt k = 0; k < m->M; k++) {
    const PetscInt n = m->next[k];
    for (int c = 0; c < 2; c++) F[2 * k + c] += alpha * (tau[2 * k + c] * sigma[k] - tau[2 * n + c] * sigma[n]);
  }
}

/* Y += w (second difference of X) around a closed curve of n points. */
static void AddSecondDifference(PetscInt n, PetscReal w, const PetscScalar X[], PetscScalar Y[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1, q = k < n - 1 ? k + 1 : 0;
    for (int c = 0; c < 2; c++) Y[2 * k + c] += w * (X[2 * p + c] - 2 * X[2 * k + c] + X[2 * q + c]);
  }
}

void MembraneBendingVesicle(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar X[], PetscScalar work[],
                            PetscScalar F[]) {
  const PetscInt n = m->start[v + 1] - m->start[v];
  (void)PetscArrayzero(work, 2 * n);
  AddSecondDifference(n, 1 / PetscSqr(m->ds[v]), X, work);
  AddSecondDifference(n, alpha / m->ds[v], work, F); /* ds/ds^2 */
}

void MembraneBending(Membrane m, PetscReal alpha, const PetscScalar X[], PetscScalar work[], PetscScalar F[]) {
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const PetscInt first = 2 * m->start[v];
    MembraneBendingVesicle(m, v, alpha, X + first, work + first, F + first);
  }
}

PetscReal MembraneBendingEnergy(Membrane m, PetscInt v, const PetscScalar X[]) {
  PetscReal sum = 0;
  for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++)
    for (int c = 0; c < 2; c++)
      sum += PetscSqr((X[2 * m->previous[k] + c] - 2 * X[2 * k + c] + X[2 * m->next[k] + c]) / PetscSqr(m->ds[v]));
  return 0.5 * m->bending * sum * m->ds[v];
}
