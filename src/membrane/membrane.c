#include "membrane/membrane.h"

/* Arc length of one vesicle's curve by spectral derivatives. */
static PetscReal ArcLength(Membrane m, PetscInt v, const PetscScalar X[]) {
  const PetscInt n = m->start[v + 1] - m->start[v];
  PetscReal length = 0;
  (void)PetscArrayzero(m->work, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, m->work);
  for (PetscInt k = 0; k < n; k++) length += PetscSqrtReal(PetscSqr(m->work[2 * k]) + PetscSqr(m->work[2 * k + 1]));
  return length;
}

PetscErrorCode MembraneCreate(const Shape *shape, PetscReal bending, DerivativeType derivative, Membrane *out) {
  Membrane m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->vesicles = shape->vesicles;
  m->M = shape->start[shape->vesicles];
  m->bending = bending;
  m->derivative = derivative;
  PetscCall(PetscMalloc6(m->vesicles + 1, &m->start, m->vesicles, &m->ds, m->vesicles, &m->A0, m->vesicles, &m->L0,
                         m->vesicles, &m->spectral, m->vesicles, &m->arc));
  PetscCall(PetscMalloc4(m->M, &m->previous, m->M, &m->next, m->M, &m->spacing, 2 * m->M, &m->work));
  PetscCall(PetscArraycpy(m->start, shape->start, m->vesicles + 1));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const PetscInt first = m->start[v], n = m->start[v + 1] - first;
    Measures measures;
    for (PetscInt k = 0; k < n; k++) {
      m->previous[first + k] = first + (k + n - 1) % n;
      m->next[first + k] = first + (k + 1) % n;
    }
    PetscCall(SpectralCreate(n, &m->spectral[v]));
    m->arc[v] = ArcLength(m, v, shape->X + 2 * first);
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
  for (PetscInt v = 0; v < m->vesicles; v++) PetscCall(SpectralDestroy(&m->spectral[v]));
  PetscCall(PetscFree6(m->start, m->ds, m->A0, m->L0, m->spectral, m->arc));
  PetscCall(PetscFree4(m->previous, m->next, m->spacing, m->work));
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

void MembraneEdges(Membrane m, PetscInt v, const PetscScalar X[], PetscScalar e[]) {
  const PetscInt n = m->start[v + 1] - m->start[v];
  if (m->derivative == DERIVATIVE_SPECTRAL) {
    (void)PetscArrayzero(e, 2 * n);
    SpectralDerivative(m->spectral[v], 1, 1, X, e);
    return;
  }
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) e[2 * k + c] = X[2 * k + c] - X[2 * (k ? k - 1 : n - 1) + c];
}

void MembraneEdgesTranspose(Membrane m, PetscInt v, PetscReal alpha, const PetscScalar F[], PetscScalar Y[]) {
  const PetscInt n = m->start[v + 1] - m->start[v];
  if (m->derivative == DERIVATIVE_SPECTRAL) { /* antisymmetric */
    SpectralDerivative(m->spectral[v], 1, -alpha, F, Y);
    return;
  }
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) Y[2 * k + c] += alpha * (F[2 * k + c] - F[2 * (k < n - 1 ? k + 1 : 0) + c]);
}

void MembraneTangents(Membrane m, const PetscScalar X[], PetscReal tau[]) {
  for (PetscInt v = 0; v < m->vesicles; v++) MembraneEdges(m, v, X + 2 * m->start[v], tau + 2 * m->start[v]);
  for (PetscInt k = 0; k < 2 * m->M; k++) tau[k] /= m->spacing[k / 2];
}

void MembraneStretching(Membrane m, const PetscReal tau[], const PetscScalar U[], PetscScalar d[]) {
  PetscScalar *work = m->work;
  for (PetscInt v = 0; v < m->vesicles; v++) MembraneEdges(m, v, U + 2 * m->start[v], work + 2 * m->start[v]);
  for (PetscInt k = 0; k < m->M; k++) d[k] = tau[2 * k] * work[2 * k] + tau[2 * k + 1] * work[2 * k + 1];
}

void MembraneStretchingTranspose(Membrane m, const PetscReal tau[], PetscReal alpha, const PetscScalar sigma[],
                                 PetscScalar F[]) {
  PetscScalar *work = m->work;
  for (PetscInt k = 0; k < 2 * m->M; k++) work[k] = tau[k] * sigma[k / 2];
  for (PetscInt v = 0; v < m->vesicles; v++)
    MembraneEdgesTranspose(m, v, alpha, work + 2 * m->start[v], F + 2 * m->start[v]);
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
  if (m->derivative != DERIVATIVE_FD) {
    SpectralDerivative(m->spectral[v], 4, alpha * m->ds[v] * PetscPowRealInt(n / m->arc[v], 4), X, F);
    return;
  }
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
  const PetscInt n = m->start[v + 1] - m->start[v];
  const PetscScalar *own = X + 2 * m->start[v];
  PetscScalar *C = m->work;
  PetscReal sum = 0;
  (void)PetscArrayzero(C, 2 * n);
  if (m->derivative == DERIVATIVE_FD)
    AddSecondDifference(n, 1 / PetscSqr(m->ds[v]), own, C);
  else
    SpectralDerivative(m->spectral[v], 2, PetscSqr(n / m->arc[v]), own, C);
  for (PetscInt k = 0; k < 2 * n; k++) sum += PetscSqr(C[k]);
  return 0.5 * m->bending * sum * m->ds[v];
}
