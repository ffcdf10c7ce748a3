#include "precondition/denseblock.h"
#include "numerics/blas.h"

PetscErrorCode DenseBlockCreate(Membrane m, Forces forces, PetscReal h, PetscInt vesicle, PetscInt end, DenseBlock *q) {
  PetscFunctionBeginUser;
  q->forces = forces;
  PetscCall(LawCreate(m, h, vesicle, end, &q->law));
  const PetscInt n = q->law->n;
  PetscCall(
      PetscMalloc6(4 * n * n, &q->N, n * n, &q->C, 2 * n * n, &q->K, n, &q->d, 2 * n, &q->pivot_N, n, &q->pivot_C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockDestroy(DenseBlock *q) {
  PetscFunctionBeginUser;
  PetscCall(LawDestroy(&q->law));
  PetscCall(PetscFree6(q->N, q->C, q->K, q->d, q->pivot_N, q->pivot_C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of vesicle v alone: q->K = M D^T, N = M K/(h^2 a0) of the forces' K. */
static PetscErrorCode AssembleVesicle(DenseBlock *q, PetscReal a0, PetscInt v, const PetscReal Mob[]) {
  const Layout l = q->law->membrane->layout;
  const PetscInt rows = 2 * q->law->n, n = LayoutCount(l, v), own = l->start[v] - q->law->first;
  const DenseView M = {Mob + 2 * own * rows, rows, 2 * n, rows};
  PetscReal *D, *K, *N = q->N + 2 * own * rows;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n * n, &D, 4 * n * n, &K));
  PetscCall(LawBlock(q->law, v, D));
  PetscCall(DenseProductWithin(PETSC_FALSE, M, (DenseView){D, 2 * n, n, 2 * n}, 0, q->K + own * rows, rows));
  PetscCall(ForcesDense(q->forces, v, 1 / (q->law->h2 * a0), K));
  PetscCall(DenseProductWithin(PETSC_FALSE, M, (DenseView){K, 2 * n, 2 * n, 2 * n}, 0, N, rows));
  PetscCall(PetscFree2(D, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockFactor(DenseBlock *q, PetscReal a0, const PetscReal Mob[], const PetscReal motion[],
                                PetscBool *factored) {
  const PetscInt n = q->law->n, rows = 2 * n;
  PetscFunctionBeginUser;
  for (PetscInt v = q->law->vesicle; v < q->law->end; v++) PetscCall(AssembleVesicle(q, a0, v, Mob));
  for (PetscInt c = 0; c < rows; c++)
    for (PetscInt k = 0; k < rows; k++) q->N[c * rows + k] += motion[k * rows + c];
  PetscCall(DenseFactor(rows, q->N, q->pivot_N, factored));
  if (!*factored) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DenseSolve(rows, q->N, q->pivot_N, PETSC_FALSE, n, q->K));
  PetscCall(LawSchur(q->law, q->K, q->C));
  PetscCall(DenseFactor(n, q->C, q->pivot_C, factored));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlockSolve(const DenseBlock *q, PetscInt nrhs, PetscScalar U[], PetscScalar sigma[]) {
  const PetscInt n = q->law->n;
  PetscScalar *d = q->d;
  PetscFunctionBeginUser;
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_FALSE, nrhs, U));
  for (PetscInt j = 0; j < nrhs; j++) {
    LawRows(q->law, U + j * 2 * n, NULL, d);
    for (PetscInt k = 0; k < n; k++) sigma[j * n + k] = d[k] - sigma[j * n + k];
  }
  PetscCall(DenseSolve(n, q->C, q->pivot_C, PETSC_FALSE, nrhs, sigma));
  for (PetscInt j = 0; j < nrhs; j++)
    PetscCall(DenseMultAdd(PETSC_FALSE, 2 * n, n, -1, q->K, sigma + j * n, U + j * 2 * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}
