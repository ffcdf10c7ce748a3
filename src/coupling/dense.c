#include "coupling/dense.h"
#include "coupling/blas.h"

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

/* d = Dm U of one vesicle's own arrays, tau its tangents. */
static void Stretching(Membrane m, PetscInt v, const PetscReal tau[], const PetscReal U[], PetscReal work[],
                       PetscReal d[]) {
  MembraneEdges(m, v, U, work);
  for (PetscInt k = 0; k < m->start[v + 1] - m->start[v]; k++)
    d[k] = tau[2 * k] * work[2 * k] + tau[2 * k + 1] * work[2 * k + 1];
}

static PetscErrorCode FactorBlock(DenseBlocks b, PetscInt v, PetscReal a0, const PetscReal Mob[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->grid->h), *tau = b->coupling->tau + 2 * m->start[v];
  Block *q = &b->block[v];
  const PetscInt n = q->n;
  PetscReal *work, *d, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * n, &work, n, &d));
  /* N^T = I + (c_b ds/(h^2 a0)) D4 Mob, column by column */
  PetscCall(PetscArrayzero(q->N, 4 * n * n));
  for (PetscInt c = 0; c < 2 * n; c++) {
    if (m->bending > 0) MembraneBendingVesicle(m, v, m->bending / (h2 * a0), Mob + c * 2 * n, work, q->N + c * 2 * n);
    q->N[c * 2 * n + c] += 1;
  }
  PetscCall(DenseFactor(2 * n, q->N, q->pivot_N));
  /* K = N^-1 Mob Dm^T/h^2; Mob is symmetric, so a row of Mob Dm^T is Dm times a column of Mob */
  for (PetscInt c = 0; c < 2 * n; c++) {
    Stretching(m, v, tau, Mob + c * 2 * n, work, d);
    for (PetscInt k = 0; k < n; k++) q->K[k * 2 * n + c] = d[k] / h2;
  }
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, n, q->K));
  /* C = Dm K/h^2, nearly singular for near circles: constant tension is pressure there */
  for (PetscInt k = 0; k < n; k++) {
    Stretching(m, v, tau, q->K + k * 2 * n, work, q->C + k * n);
    for (PetscInt r = 0; r < n; r++) q->C[k * n + r] /= h2;
    trace += q->C[k * n + k];
  }
  for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
  PetscCall(DenseFactor(n, q->C, q->pivot_C));
  PetscCall(PetscFree2(work, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksFactor(DenseBlocks b, Mobility mobility, const GreenTable *table, SelfMobility self,
                                 PetscReal a0) {
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  for (PetscInt v = 0; v < b->coupling->membrane->vesicles; v++) {
    const PetscInt n = b->block[v].n;
    PetscReal *Mob;
    PetscCall(PetscMalloc1(4 * n * n, &Mob));
    PetscCall(MobilityAssemble(mobility, table, v, Mob));
    if (self) { /* Mob + h^2 Theta */
      const PetscReal *Theta = SelfMobilityBlock(self, v), h2 = PetscSqr(b->coupling->grid->h);
      for (PetscInt k = 0; k < 4 * n * n; k++) Mob[k] += h2 * Theta[k];
    }
    PetscCall(FactorBlock(b, v, a0, Mob));
    PetscCall(PetscFree(Mob));
  }
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksSolve(DenseBlocks b, PetscScalar U[], const PetscScalar r_s[], PetscScalar sigma[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->grid->h);
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const Block *q = &b->block[v];
    const PetscInt n = q->n, first = m->start[v];
    PetscScalar *u = U + 2 * first, *s = sigma + first;
    PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, 1, u));
    Stretching(m, v, b->coupling->tau + 2 * first, u, b->coupling->work, s);
    for (PetscInt k = 0; k < n; k++) s[k] = s[k] / h2 - r_s[first + k];
    PetscCall(DenseSolve(n, q->C, q->pivot_C, PETSC_FALSE, 1, s));
    PetscCall(DenseMultAdd(2 * n, n, -1, q->K, s, u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
