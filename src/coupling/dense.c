#include "coupling/dense.h"
#include <petscblaslapack.h>

typedef struct {
  PetscInt n;       /* markers */
  PetscReal *N, *C; /* LU factors of N^T (2n x 2n) and C (n x n) */
  PetscReal *K;     /* N^-1 Mob Dm^T/h^2, (2n x n), columns contiguous */
  PetscBLASInt *pivot_N, *pivot_C;
} Block;

struct _p_DenseBlocks {
  Coupling coupling;
  Block *block;
};

PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *out) {
  const Membrane m = coupling->membrane;
  DenseBlocks b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->coupling = coupling;
  PetscCall(PetscCalloc1(m->vesicles, &b->block));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    Block *q = &b->block[v];
    const PetscInt n = q->n = m->start[v + 1] - m->start[v];
    PetscCall(PetscMalloc5(4 * n * n, &q->N, n * n, &q->C, 2 * n * n, &q->K, 2 * n, &q->pivot_N, n, &q->pivot_C));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks) {
  DenseBlocks b = *blocks;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < b->coupling->membrane->vesicles; v++) {
    Block *q = &b->block[v];
    PetscCall(PetscFree5(q->N, q->C, q->K, q->pivot_N, q->pivot_C));
  }
  PetscCall(PetscFree(b->block));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Factor(PetscInt n, PetscReal A[], PetscBLASInt pivot[]) {
  PetscBLASInt size, info;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&size, &size, A, &size, pivot, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_MAT_LU_ZRPVT, "singular Lagrangian block, pivot %d", (int)info);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* X = A^-1 B or A^-T B for the factored A, nrhs columns. */
static PetscErrorCode Solve(PetscInt n, const PetscReal A[], const PetscBLASInt pivot[], const char transpose[],
                            PetscInt nrhs, PetscReal X[]) {
  PetscBLASInt size, columns, info;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(nrhs, &columns));
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_(transpose, &size, &columns, (PetscReal *)A, &size, (PetscBLASInt *)pivot, X,
                                            &size, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = Dm U of one vesicle, tau its tangents. */
static void Stretching(PetscInt n, const PetscReal tau[], const PetscReal U[], PetscReal d[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1;
    d[k] = tau[2 * k] * (U[2 * k] - U[2 * p]) + tau[2 * k + 1] * (U[2 * k + 1] - U[2 * p + 1]);
  }
}

static PetscErrorCode FactorBlock(DenseBlocks b, PetscInt v, PetscReal a0, const PetscReal Mob[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->grid->h), *tau = b->coupling->tau + 2 * m->start[v];
  Block *q = &b->block[v];
  const PetscInt n = q->n;
  PetscReal *work, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &work));
  /* N^T = I + (c_b ds/(h^2 a0)) D4 Mob, column by column */
  PetscCall(PetscArrayzero(q->N, 4 * n * n));
  for (PetscInt c = 0; c < 2 * n; c++) {
    if (m->bending > 0) MembraneBendingVesicle(m, v, m->bending / (h2 * a0), Mob + c * 2 * n, work, q->N + c * 2 * n);
    q->N[c * 2 * n + c] += 1;
  }
  PetscCall(Factor(2 * n, q->N, q->pivot_N));
  /* K = N^-1 Mob Dm^T/h^2 */
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt p = k ? k - 1 : n - 1;
    for (PetscInt r = 0; r < 2 * n; r++)
      q->K[k * 2 * n + r] = (tau[2 * k] * (Mob[2 * k * 2 * n + r] - Mob[2 * p * 2 * n + r]) +
                             tau[2 * k + 1] * (Mob[(2 * k + 1) * 2 * n + r] - Mob[(2 * p + 1) * 2 * n + r])) /
                            h2;
  }
  PetscCall(Solve(2 * n, q->N, q->pivot_N, "T", n, q->K));
  /* C = Dm K/h^2, nearly singular for near circles: constant tension is pressure there */
  for (PetscInt k = 0; k < n; k++) {
    Stretching(n, tau, q->K + k * 2 * n, q->C + k * n);
    for (PetscInt r = 0; r < n; r++) q->C[k * n + r] /= h2;
    trace += q->C[k * n + k];
  }
  for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
  PetscCall(Factor(n, q->C, q->pivot_C));
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksFactor(DenseBlocks b, Mobility mobility, const GreenTable *table, PetscReal a0) {
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  for (PetscInt v = 0; v < b->coupling->membrane->vesicles; v++) {
    const PetscInt n = b->block[v].n;
    PetscReal *Mob;
    PetscCall(PetscMalloc1(4 * n * n, &Mob));
    PetscCall(MobilityAssemble(mobility, table, v, Mob));
    PetscCall(FactorBlock(b, v, a0, Mob));
    PetscCall(PetscFree(Mob));
  }
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksSolve(DenseBlocks b, PetscScalar U[], const PetscScalar r_s[], PetscScalar sigma[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->grid->h), one = 1, minus = -1;
  const PetscBLASInt step = 1;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const Block *q = &b->block[v];
    const PetscInt n = q->n, first = m->start[v];
    PetscScalar *u = U + 2 * first, *s = sigma + first;
    PetscBLASInt rows, columns;
    PetscCall(PetscBLASIntCast(2 * n, &rows));
    PetscCall(PetscBLASIntCast(n, &columns));
    PetscCall(Solve(2 * n, q->N, q->pivot_N, "T", 1, u));
    Stretching(n, b->coupling->tau + 2 * first, u, s);
    for (PetscInt k = 0; k < n; k++) s[k] = s[k] / h2 - r_s[first + k];
    PetscCall(Solve(n, q->C, q->pivot_C, "N", 1, s));
    PetscCallBLAS("BLASgemv", BLASgemv_("N", &rows, &columns, &minus, q->K, &rows, s, &step, &one, u, &step));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
