#include "coupling/dense.h"
#include "coupling/blas.h"

typedef struct {
  PetscInt vesicle, end; /* its vesicles: vesicle .. end - 1 */
  PetscInt first, n;     /* its markers */
  PetscReal *N, *C;      /* LU factors of N^T (2n x 2n) and C (n x n) */
  PetscReal *K;          /* N^-1 Mob Dm^T/h^2, (2n x n), columns contiguous */
  PetscBLASInt *pivot_N, *pivot_C;
} Block;

struct _p_DenseBlocks {
  Coupling coupling;
  PetscInt count;
  Block *block;
};

PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *out) {
  const Membrane m = coupling->membrane;
  const PetscBool together = m->M <= DENSE_TOGETHER ? PETSC_TRUE : PETSC_FALSE;
  DenseBlocks b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->coupling = coupling;
  b->count = together ? 1 : m->vesicles;
  PetscCall(PetscCalloc1(b->count, &b->block));
  for (PetscInt k = 0; k < b->count; k++) {
    Block *q = &b->block[k];
    q->vesicle = k;
    q->end = together ? m->vesicles : k + 1;
    q->first = m->start[q->vesicle];
    const PetscInt n = q->n = m->start[q->end] - q->first;
    PetscCall(PetscMalloc5(4 * n * n, &q->N, n * n, &q->C, 2 * n * n, &q->K, 2 * n, &q->pivot_N, n, &q->pivot_C));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks) {
  DenseBlocks b = *blocks;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < b->count; k++) {
    Block *q = &b->block[k];
    PetscCall(PetscFree5(q->N, q->C, q->K, q->pivot_N, q->pivot_C));
  }
  PetscCall(PetscFree(b->block));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = Dm U of a block's own arrays. */
static void Stretching(DenseBlocks b, const Block *q, const PetscReal U[], PetscReal work[], PetscReal d[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal *tau = b->coupling->tau + 2 * q->first;
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = 2 * (m->start[v] - q->first);
    MembraneEdges(m, v, U + own, work + own);
  }
  for (PetscInt k = 0; k < q->n; k++) d[k] = tau[2 * k] * work[2 * k] + tau[2 * k + 1] * work[2 * k + 1];
}

/* F += alpha ds D4 X of a block's own arrays. */
static void Bending(DenseBlocks b, const Block *q, PetscReal alpha, const PetscReal X[], PetscReal work[],
                    PetscReal F[]) {
  const Membrane m = b->coupling->membrane;
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = 2 * (m->start[v] - q->first);
    MembraneBendingVesicle(m, v, alpha, X + own, work + own, F + own);
  }
}

static PetscErrorCode FactorBlock(DenseBlocks b, Block *q, PetscReal a0, const PetscReal Mob[]) {
  const PetscReal h2 = PetscSqr(b->coupling->grid->h), c_b = b->coupling->membrane->bending;
  const PetscInt n = q->n;
  PetscReal *work, *d, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * n, &work, n, &d));
  /* N^T = I + (c_b ds/(h^2 a0)) D4 Mob, column by column */
  PetscCall(PetscArrayzero(q->N, 4 * n * n));
  for (PetscInt c = 0; c < 2 * n; c++) {
    if (c_b > 0) Bending(b, q, c_b / (h2 * a0), Mob + c * 2 * n, work, q->N + c * 2 * n);
    q->N[c * 2 * n + c] += 1;
  }
  PetscCall(DenseFactor(2 * n, q->N, q->pivot_N));
  /* K = N^-1 Mob Dm^T/h^2; Mob is symmetric, so a row of Mob Dm^T is Dm times a column of Mob */
  for (PetscInt c = 0; c < 2 * n; c++) {
    Stretching(b, q, Mob + c * 2 * n, work, d);
    for (PetscInt k = 0; k < n; k++) q->K[k * 2 * n + c] = d[k] / h2;
  }
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, n, q->K));
  /* C = Dm K/h^2, nearly singular for near circles: constant tension is pressure there */
  for (PetscInt k = 0; k < n; k++) {
    Stretching(b, q, q->K + k * 2 * n, work, q->C + k * n);
    for (PetscInt r = 0; r < n; r++) q->C[k * n + r] /= h2;
    trace += q->C[k * n + k];
  }
  for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
  PetscCall(DenseFactor(n, q->C, q->pivot_C));
  PetscCall(PetscFree2(work, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mob += h^2 Theta, a block a vesicle on Mob's diagonal. */
static void AddSelfMobility(DenseBlocks b, const Block *q, SelfMobility self, PetscReal Mob[]) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->grid->h);
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscReal *Theta = SelfMobilityBlock(self, v);
    const PetscInt own = 2 * (m->start[v] - q->first), n2 = 2 * (m->start[v + 1] - m->start[v]);
    for (PetscInt r = 0; r < n2; r++)
      for (PetscInt c = 0; c < n2; c++) Mob[(own + r) * 2 * q->n + own + c] += h2 * Theta[r * n2 + c];
  }
}

PetscErrorCode DenseBlocksFactor(DenseBlocks b, Mobility mobility, const GreenTable *table, SelfMobility self,
                                 PetscReal a0) {
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  for (PetscInt k = 0; k < b->count; k++) {
    Block *q = &b->block[k];
    PetscReal *Mob;
    PetscCall(PetscMalloc1(4 * q->n * q->n, &Mob));
    PetscCall(MobilityAssemble(mobility, table, q->first, q->n, Mob));
    if (self) AddSelfMobility(b, q, self, Mob);
    PetscCall(FactorBlock(b, q, a0, Mob));
    PetscCall(PetscFree(Mob));
  }
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksSolve(DenseBlocks b, PetscScalar U[], const PetscScalar r_s[], PetscScalar sigma[]) {
  const PetscReal h2 = PetscSqr(b->coupling->grid->h);
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < b->count; i++) {
    const Block *q = &b->block[i];
    PetscScalar *u = U + 2 * q->first, *s = sigma + q->first;
    PetscCall(DenseSolve(2 * q->n, q->N, q->pivot_N, PETSC_TRUE, 1, u));
    Stretching(b, q, u, b->coupling->work, s);
    for (PetscInt k = 0; k < q->n; k++) s[k] = s[k] / h2 - r_s[q->first + k];
    PetscCall(DenseSolve(q->n, q->C, q->pivot_C, PETSC_FALSE, 1, s));
    PetscCall(DenseMultAdd(2 * q->n, q->n, -1, q->K, s, u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
