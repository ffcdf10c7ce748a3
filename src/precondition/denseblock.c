#include "precondition/denseblock.h"
#include "numerics/blas.h"

PetscErrorCode DenseBlockCreate(Membrane m, Forces forces, PetscReal h, PetscInt vesicle, PetscInt end, DenseBlock *q) {
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  q->membrane = m;
  q->forces = forces;
  q->h2 = h * h;
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
static void BlockStretching(const DenseBlock *q, const PetscReal U[], PetscReal d[]) {
  const Membrane m = q->membrane;
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = m->layout->start[v] - q->first;
    MembraneVesicleStretching(m, v, q->tau + 2 * own, U + 2 * own, d + own);
  }
}

/* D[n][2n] = Dm/h^2 of vesicle v: rows are contiguous. unit[2n] is 1 at marker 0, first[2n] is work. */
static void StretchingMatrix(const DenseBlock *q, PetscInt v, const PetscReal unit[], PetscReal first[],
                             PetscReal D[]) {
  const Layout l = q->membrane->layout;
  const PetscInt n = LayoutCount(l, v);
  const PetscReal *tau = q->tau + 2 * (l->start[v] - q->first);
  MembraneEdges(q->membrane, v, unit, first);
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < n; j++)
      for (int c = 0; c < 2; c++)
        D[(k * n + j) * 2 + c] = tau[2 * k + c] * first[2 * (k < j ? k - j + n : k - j)] / q->h2;
}

/* Of vesicle v alone: q->K = M Dm^T/h^2, N = M K/(h^2 a0) of the forces' K, and without motion the labels' own one,
   (v/a0) d/dt. M is symmetric. */
static PetscErrorCode AssembleVesicle(DenseBlock *q, PetscReal a0, PetscInt v, PetscReal treading,
                                      const PetscReal Mob[]) {
  const Membrane m = q->membrane;
  const PetscInt rows = 2 * q->n, n = LayoutCount(m->layout, v), own = m->layout->start[v] - q->first;
  const DenseView M = {Mob + 2 * own * rows, rows, 2 * n, rows};
  PetscReal *unit, *first, *D, *K, *N = q->N + 2 * own * rows;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(2 * n, &unit, 2 * n, &first, 2 * n * n, &D, 4 * n * n, &K));
  unit[0] = 1;
  StretchingMatrix(q, v, unit, first, D);
  PetscCall(DenseProductWithin(PETSC_FALSE, M, (DenseView){D, 2 * n, n, 2 * n}, 0, q->K + own * rows, rows));
  PetscCall(ForcesDense(q->forces, v, 1 / (q->h2 * a0), K));
  PetscCall(DenseProductWithin(PETSC_FALSE, M, (DenseView){K, 2 * n, 2 * n, 2 * n}, 0, N, rows));
  if (treading != 0) {
    PetscCall(PetscArrayzero(first, 2 * n));
    MembraneLabelDerivative(m, v, treading / a0, unit, first);
    DenseAddCirculant(n, first, rows, N + 2 * own);
  }
  PetscCall(PetscFree4(unit, first, D, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C = Dm K/h^2, nearly singular for near circles, where constant tension is pressure. */
static PetscErrorCode AssembleTension(DenseBlock *q) {
  const Layout l = q->membrane->layout;
  const PetscInt n = q->n;
  PetscReal *unit, *first, *D, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(2 * n, &unit, 2 * n, &first, 2 * n * n, &D));
  unit[0] = 1;
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = l->start[v] - q->first, nv = LayoutCount(l, v);
    const DenseView K = {q->K + 2 * own, 2 * nv, n, 2 * n};
    StretchingMatrix(q, v, unit, first, D);
    PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){D, 2 * nv, nv, 2 * nv}, K, 0, q->C + own, n));
  }
  for (PetscInt k = 0; k < n; k++) trace += q->C[k * n + k];
  for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
  PetscCall(PetscFree3(unit, first, D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockFactor(DenseBlock *q, PetscReal a0, const PetscReal treading[], const PetscReal Mob[],
                                const PetscReal motion[], PetscBool *factored) {
  const PetscInt n = q->n, rows = 2 * n;
  PetscFunctionBeginUser;
  for (PetscInt v = q->vesicle; v < q->end; v++)
    PetscCall(AssembleVesicle(q, a0, v, motion ? 0 : treading[v - q->vesicle], Mob));
  for (PetscInt c = 0; c < rows && !motion; c++) q->N[c * rows + c] += 1;
  for (PetscInt c = 0; c < rows && motion; c++)
    for (PetscInt k = 0; k < rows; k++) q->N[c * rows + k] += motion[k * rows + c];
  PetscCall(DenseFactor(rows, q->N, q->pivot_N, factored));
  if (!*factored) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DenseSolve(rows, q->N, q->pivot_N, PETSC_FALSE, n, q->K));
  PetscCall(AssembleTension(q));
  PetscCall(DenseFactor(n, q->C, q->pivot_C, factored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockSolve(const DenseBlock *q, PetscInt nrhs, PetscScalar U[], PetscScalar sigma[]) {
  const PetscInt n = q->n;
  PetscScalar *d = q->d;
  PetscFunctionBeginUser;
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_FALSE, nrhs, U));
  for (PetscInt j = 0; j < nrhs; j++) {
    BlockStretching(q, U + j * 2 * n, d);
    for (PetscInt k = 0; k < n; k++) sigma[j * n + k] = d[k] / q->h2 - sigma[j * n + k];
  }
  PetscCall(DenseSolve(n, q->C, q->pivot_C, PETSC_FALSE, nrhs, sigma));
  for (PetscInt j = 0; j < nrhs; j++)
    PetscCall(DenseMultAdd(PETSC_FALSE, 2 * n, n, -1, q->K, sigma + j * n, U + j * 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
