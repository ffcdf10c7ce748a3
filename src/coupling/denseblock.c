#include "coupling/denseblock.h"
#include "coupling/blas.h"

PetscErrorCode DenseBlockCreate(Layout l, PetscInt vesicle, PetscInt end, DenseBlock *q) {
  PetscFunctionBeginUser;
  q->vesicle = vesicle;
  q->end = end;
  q->first = l->start[vesicle];
  const PetscInt n = q->n = l->start[end] - q->first;
  PetscCall(PetscMalloc6(4 * n * n, &q->N, n * n, &q->C, 2 * n * n, &q->K, 3 * n, &q->tau, 2 * n, &q->pivot_N, n,
                         &q->pivot_C));
  q->d = q->tau + 2 * n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockDestroy(DenseBlock *q) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(q->N, q->C, q->K, q->tau, q->pivot_N, q->pivot_C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = Dm U of a block's own arrays. */
static void Stretching(Membrane m, const DenseBlock *q, const PetscReal U[], PetscReal d[]) {
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = m->layout->start[v] - q->first;
    MembraneVesicleStretching(m, v, q->tau + 2 * own, U + 2 * own, d + own);
  }
}

/* F += alpha ds D4 X of a block's own arrays. */
static void Bending(Membrane m, const DenseBlock *q, PetscReal alpha, const PetscReal X[], PetscReal F[]) {
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = 2 * (m->layout->start[v] - q->first);
    MembraneVesicleBending(m, v, alpha, X + own, F + own);
  }
}

/* N^T = I + (c_b ds/(h^2 a0)) D4 M, or with motion in the place of I, column by column, and D = Dm M/h^2 (n x 2n). */
static void AssembleBlock(Membrane m, PetscReal h2, DenseBlock *q, PetscReal a0, const PetscReal Mob[],
                          const PetscReal motion[], PetscReal D[]) {
  const PetscInt n = q->n;
  for (PetscInt c = 0; c < 2 * n; c++) {
    PetscReal *column = q->N + c * 2 * n;
    (void)PetscArrayzero(column, 2 * n);
    if (m->bending > 0) Bending(m, q, m->bending / (h2 * a0), Mob + c * 2 * n, column);
    if (!motion) column[c] += 1;
    for (PetscInt k = 0; motion && k < 2 * n; k++) column[k] += motion[c * 2 * n + k];
    Stretching(m, q, Mob + c * 2 * n, D + c * n);
    for (PetscInt k = 0; k < n; k++) D[c * n + k] /= h2;
  }
}

/* N^T += ((v/a0) d/dt)^T, the labels' own motion: antisymmetric. */
static PetscErrorCode AddTreading(Membrane m, DenseBlock *q, PetscReal a0, const PetscReal treading[]) {
  PetscReal *unit;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * q->n, &unit));
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt at = 2 * (m->layout->start[v] - q->first);
    for (PetscInt c = 0; c < 2 * LayoutCount(m->layout, v) && treading[v - q->vesicle] != 0; c++) {
      unit[c] = 1;
      MembraneLabelDerivative(m, v, -treading[v - q->vesicle] / a0, unit, q->N + (at + c) * 2 * q->n + at);
      unit[c] = 0;
    }
  }
  PetscCall(PetscFree(unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockFactor(Membrane m, PetscReal h2, DenseBlock *q, PetscReal a0, const PetscReal treading[],
                                const PetscReal Mob[], const PetscReal motion[], PetscBool *factored) {
  const PetscInt n = q->n;
  PetscReal *D, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n * n, &D));
  AssembleBlock(m, h2, q, a0, Mob, motion, D);
  if (!motion) PetscCall(AddTreading(m, q, a0, treading));
  PetscCall(DenseFactor(2 * n, q->N, q->pivot_N, factored));
  if (*factored) {
    /* K = N^-1 M Dm^T/h^2; M is symmetric, so M Dm^T is D^T */
    for (PetscInt k = 0; k < n; k++)
      for (PetscInt c = 0; c < 2 * n; c++) q->K[k * 2 * n + c] = D[c * n + k];
    PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, n, q->K));
    /* C = Dm K/h^2, nearly singular for near circles: constant tension is pressure there */
    for (PetscInt k = 0; k < n; k++) {
      Stretching(m, q, q->K + k * 2 * n, q->C + k * n);
      for (PetscInt r = 0; r < n; r++) q->C[k * n + r] /= h2;
    }
    for (PetscInt k = 0; k < n; k++) trace += q->C[k * n + k];
    for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
    PetscCall(DenseFactor(n, q->C, q->pivot_C, factored));
  }
  PetscCall(PetscFree(D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockSolve(Membrane m, PetscReal h2, const DenseBlock *q, PetscInt nrhs, PetscScalar U[],
                               PetscScalar sigma[]) {
  const PetscInt n = q->n;
  PetscScalar *d = q->d;
  PetscFunctionBeginUser;
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, nrhs, U));
  for (PetscInt j = 0; j < nrhs; j++) {
    Stretching(m, q, U + j * 2 * n, d);
    for (PetscInt k = 0; k < n; k++) sigma[j * n + k] = d[k] / h2 - sigma[j * n + k];
  }
  PetscCall(DenseSolve(n, q->C, q->pivot_C, PETSC_FALSE, nrhs, sigma));
  for (PetscInt j = 0; j < nrhs; j++)
    PetscCall(DenseMultAdd(PETSC_FALSE, 2 * n, n, -1, q->K, sigma + j * n, U + j * 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
