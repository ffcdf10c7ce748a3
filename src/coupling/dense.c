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

/* Columns that this rank works out, of `count`. */
static PetscInt FirstColumn(Grid g, PetscMPIInt rank, PetscInt count) {
  return (PetscInt)((PetscInt64)count * rank / g->size);
}

/* Everybody's columns (of length rows) to everybody: the same bits on every rank. Collective. */
static PetscErrorCode ShareColumns(Grid g, PetscInt rows, PetscInt count, PetscReal A[]) {
  PetscMPIInt *counts, *starts;
  PetscFunctionBeginUser;
  if (g->size == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(g->size, &counts, g->size, &starts));
  for (PetscMPIInt r = 0; r < g->size; r++) {
    starts[r] = (PetscMPIInt)(rows * FirstColumn(g, r, count));
    counts[r] = (PetscMPIInt)(rows * FirstColumn(g, r + 1, count)) - starts[r];
  }
  PetscCallMPI(MPI_Allgatherv(MPI_IN_PLACE, 0, MPIU_REAL, A, counts, starts, MPIU_REAL, g->comm));
  PetscCall(PetscFree2(counts, starts));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* N^T = I + (c_b ds/(h^2 a0)) D4 Mob, column by column, and D = Dm Mob/h^2 (n x 2n). */
static PetscErrorCode AssembleBlock(DenseBlocks b, Block *q, PetscReal a0, const PetscReal Mob[], PetscReal work[],
                                    PetscReal D[]) {
  const Grid g = b->coupling->grid;
  const PetscReal h2 = PetscSqr(g->h), c_b = b->coupling->membrane->bending;
  const PetscInt n = q->n;
  PetscFunctionBeginUser;
  for (PetscInt c = FirstColumn(g, g->rank, 2 * n); c < FirstColumn(g, g->rank + 1, 2 * n); c++) {
    PetscReal *column = q->N + c * 2 * n;
    PetscCall(PetscArrayzero(column, 2 * n));
    if (c_b > 0) Bending(b, q, c_b / (h2 * a0), Mob + c * 2 * n, work, column);
    column[c] += 1;
    Stretching(b, q, Mob + c * 2 * n, work, D + c * n);
    for (PetscInt k = 0; k < n; k++) D[c * n + k] /= h2;
  }
  PetscCall(ShareColumns(g, 2 * n, 2 * n, q->N));
  PetscCall(ShareColumns(g, n, 2 * n, D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors of N and C. Columns are shared out among the ranks, the factorisations are every rank's own. */
static PetscErrorCode FactorBlock(DenseBlocks b, Block *q, PetscReal a0, const PetscReal Mob[]) {
  const Grid g = b->coupling->grid;
  const PetscReal h2 = PetscSqr(g->h);
  const PetscInt n = q->n, first = FirstColumn(g, g->rank, n), last = FirstColumn(g, g->rank + 1, n);
  PetscReal *work, *D, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * n, &work, 2 * n * n, &D));
  PetscCall(AssembleBlock(b, q, a0, Mob, work, D));
  PetscCall(DenseFactor(2 * n, q->N, q->pivot_N));
  /* K = N^-1 Mob Dm^T/h^2; Mob is symmetric, so Mob Dm^T is D^T */
  for (PetscInt k = first; k < last; k++)
    for (PetscInt c = 0; c < 2 * n; c++) q->K[k * 2 * n + c] = D[c * n + k];
  PetscCall(DenseSolve(2 * n, q->N, q->pivot_N, PETSC_TRUE, last - first, q->K + first * 2 * n));
  /* C = Dm K/h^2, nearly singular for near circles: constant tension is pressure there */
  for (PetscInt k = first; k < last; k++) {
    Stretching(b, q, q->K + k * 2 * n, work, q->C + k * n);
    for (PetscInt r = 0; r < n; r++) q->C[k * n + r] /= h2;
  }
  PetscCall(ShareColumns(g, 2 * n, n, q->K));
  PetscCall(ShareColumns(g, n, n, q->C));
  for (PetscInt k = 0; k < n; k++) trace += q->C[k * n + k];
  for (PetscInt k = 0; k < n; k++) q->C[k * n + k] += 1e-9 * trace / n;
  PetscCall(DenseFactor(n, q->C, q->pivot_C));
  PetscCall(PetscFree2(work, D));
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
