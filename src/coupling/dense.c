#include "coupling/dense.h"
#include "base/agree.h"
#include "coupling/blas.h"

typedef struct {
  PetscInt vesicle, end; /* its vesicles: vesicle .. end - 1 */
  PetscInt first, n;     /* its markers */
  PetscReal *N, *C;      /* LU factors of N^T (2n x 2n) and C (n x n) */
  PetscReal *K;          /* N^-1 M Dm^T/h^2, (2n x n), columns contiguous */
  PetscReal *tau;        /* [2n] tangents at the present markers */
  PetscBLASInt *pivot_N, *pivot_C;
} Block;

struct _p_DenseBlocks {
  Coupling coupling;
  PetscBool together; /* one block for all vesicles, root's; else each rank has those of its own vesicles */
  PetscMPIInt root;
  PetscInt count; /* blocks of this rank */
  Block *block;
  PetscScalar *U, *sigma; /* together: [2M], [M] of all markers, on root */
  PetscScalar *d;         /* [M] work */
};

static PetscErrorCode CreateBlock(Layout l, PetscInt vesicle, PetscInt end, Block *q) {
  PetscFunctionBeginUser;
  q->vesicle = vesicle;
  q->end = end;
  q->first = l->start[vesicle];
  const PetscInt n = q->n = l->start[end] - q->first;
  PetscCall(PetscMalloc6(4 * n * n, &q->N, n * n, &q->C, 2 * n * n, &q->K, 2 * n, &q->tau, 2 * n, &q->pivot_N, n,
                         &q->pivot_C));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *out) {
  const Layout l = coupling->membrane->layout;
  DenseBlocks b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->coupling = coupling;
  b->together = l->M <= DENSE_TOGETHER ? PETSC_TRUE : PETSC_FALSE;
  b->root = LayoutOwner(l, 0);
  b->count = b->together ? l->rank == b->root : l->end - l->own;
  PetscCall(PetscCalloc1(b->count, &b->block));
  for (PetscInt k = 0; k < b->count; k++) {
    const PetscInt v = b->together ? 0 : l->own + k;
    PetscCall(CreateBlock(l, v, b->together ? l->bodies : v + 1, &b->block[k]));
  }
  PetscCall(PetscMalloc3(2 * l->M, &b->U, l->M, &b->sigma, l->M, &b->d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks) {
  DenseBlocks b = *blocks;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < b->count; k++) {
    Block *q = &b->block[k];
    PetscCall(PetscFree6(q->N, q->C, q->K, q->tau, q->pivot_N, q->pivot_C));
  }
  PetscCall(PetscFree(b->block));
  PetscCall(PetscFree3(b->U, b->sigma, b->d));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* d = Dm U of a block's own arrays. */
static void Stretching(Membrane m, const Block *q, const PetscReal U[], PetscReal d[]) {
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = m->layout->start[v] - q->first;
    MembraneVesicleStretching(m, v, q->tau + 2 * own, U + 2 * own, d + own);
  }
}

/* F += alpha ds D4 X of a block's own arrays. */
static void Bending(Membrane m, const Block *q, PetscReal alpha, const PetscReal X[], PetscReal F[]) {
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt own = 2 * (m->layout->start[v] - q->first);
    MembraneVesicleBending(m, v, alpha, X + own, F + own);
  }
}

/* N^T = I + (c_b ds/(h^2 a0)) D4 M, column by column, and D = Dm M/h^2 (n x 2n). */
static void AssembleBlock(Membrane m, PetscReal h2, Block *q, PetscReal a0, const PetscReal Mob[], PetscReal D[]) {
  const PetscInt n = q->n;
  for (PetscInt c = 0; c < 2 * n; c++) {
    PetscReal *column = q->N + c * 2 * n;
    (void)PetscArrayzero(column, 2 * n);
    if (m->bending > 0) Bending(m, q, m->bending / (h2 * a0), Mob + c * 2 * n, column);
    column[c] += 1;
    Stretching(m, q, Mob + c * 2 * n, D + c * n);
    for (PetscInt k = 0; k < n; k++) D[c * n + k] /= h2;
  }
}

/* N^T += ((v/a0) d/dt)^T, the labels' own motion: antisymmetric. */
static PetscErrorCode AddTreading(Membrane m, Block *q, PetscReal a0, const PetscReal treading[]) {
  PetscReal *unit;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * q->n, &unit));
  for (PetscInt v = q->vesicle; v < q->end; v++) {
    const PetscInt at = 2 * (m->layout->start[v] - q->first);
    for (PetscInt c = 0; c < 2 * LayoutCount(m->layout, v) && treading[v] != 0; c++) {
      unit[c] = 1;
      MembraneLabelDerivative(m, v, -treading[v] / a0, unit, q->N + (at + c) * 2 * q->n + at);
      unit[c] = 0;
    }
  }
  PetscCall(PetscFree(unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors of N and C for Mob with the near field in it. */
static PetscErrorCode FactorBlock(Membrane m, PetscReal h2, Block *q, PetscReal a0, const PetscReal treading[],
                                  const PetscReal Mob[], PetscBool *factored) {
  const PetscInt n = q->n;
  PetscReal *D, trace = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n * n, &D));
  AssembleBlock(m, h2, q, a0, Mob, D);
  PetscCall(AddTreading(m, q, a0, treading));
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

/* Mob by MobilityAssemble, zero in unbounded fluid. */
static PetscErrorCode AssembleTable(Mobility mobility, PetscInt first, PetscInt n, PetscInt part, PetscInt parts,
                                    PetscReal Mob[]) {
  PetscFunctionBeginUser;
  if (mobility)
    PetscCall(MobilityAssemble(mobility, first, n, part, parts, Mob));
  else
    PetscCall(PetscArrayzero(Mob, 4 * n * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The one block: every rank makes a part of Mob and adds its own rows of the near field, root has the sum. */
static PetscErrorCode AssembleTogether(DenseBlocks b, Mobility mobility, PetscReal Mob[]) {
  const Layout l = b->coupling->membrane->layout;
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(4 * l->M * l->M, &size));
  PetscCall(AssembleTable(mobility, 0, l->M, l->rank, l->size, Mob));
  if (b->coupling->near)
    PetscCall(NearFieldAdd(b->coupling->near, PetscSqr(b->coupling->fluid->grid->h), 0, l->M, Mob));
  if (l->size > 1)
    PetscCallMPI(MPI_Reduce(l->rank == b->root ? MPI_IN_PLACE : Mob, Mob, size, MPIU_REAL, MPI_SUM, b->root, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void DenseBlocksPlace(DenseBlocks b) {
  const Membrane m = b->coupling->membrane;
  for (PetscInt k = 0; k < b->count; k++) {
    const Block *q = &b->block[k];
    for (PetscInt v = q->vesicle; v < q->end; v++) {
      const PetscInt first = m->layout->start[v];
      MembraneVesicleTangents(m, v, b->coupling->markers->X + 2 * first, q->tau + 2 * (first - q->first));
    }
  }
}

PetscErrorCode DenseBlocksFactor(DenseBlocks b, Mobility mobility, PetscReal a0, PetscBool *factored) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->fluid->grid->h);
  PetscBool good = PETSC_TRUE, failed;
  PetscReal *Mob;
  PetscInt most = b->together ? m->layout->M : 0;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  for (PetscInt k = 0; k < b->count; k++) most = PetscMax(most, b->block[k].n);
  PetscCall(PetscMalloc1(4 * most * most, &Mob));
  if (b->together) PetscCall(AssembleTogether(b, mobility, Mob));
  for (PetscInt k = 0; k < b->count && good; k++) {
    Block *q = &b->block[k];
    if (!b->together) {
      PetscCall(AssembleTable(mobility, q->first, q->n, 0, 1, Mob));
      if (b->coupling->near) PetscCall(NearFieldAdd(b->coupling->near, h2, q->first, q->n, Mob));
    }
    PetscCall(FactorBlock(m, h2, q, a0, b->coupling->treading, Mob, &good));
  }
  PetscCall(PetscFree(Mob));
  PetscCall(AgreeFlag(m->layout->comm, good ? PETSC_FALSE : PETSC_TRUE, &failed));
  *factored = failed ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From U and sigma = r_s of a block's own arrays. */
static PetscErrorCode SolveBlock(DenseBlocks b, const Block *q, PetscScalar U[], PetscScalar sigma[]) {
  const PetscReal h2 = PetscSqr(b->coupling->fluid->grid->h);
  PetscScalar *d = b->d;
  PetscFunctionBeginUser;
  PetscCall(DenseSolve(2 * q->n, q->N, q->pivot_N, PETSC_TRUE, 1, U));
  Stretching(b->coupling->membrane, q, U, d);
  for (PetscInt k = 0; k < q->n; k++) sigma[k] = d[k] / h2 - sigma[k];
  PetscCall(DenseSolve(q->n, q->C, q->pivot_C, PETSC_FALSE, 1, sigma));
  PetscCall(DenseMultAdd(2 * q->n, q->n, -1, q->K, sigma, U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksSolve(DenseBlocks b, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = b->coupling->membrane->layout;
  PetscFunctionBeginUser;
  if (b->together) {
    PetscCall(LayoutToRank(l, b->root, 2, U, b->U));
    PetscCall(LayoutToRank(l, b->root, 1, sigma, b->sigma));
    for (PetscInt k = 0; k < b->count; k++) PetscCall(SolveBlock(b, &b->block[k], b->U, b->sigma));
    PetscCall(LayoutFromRank(l, b->root, 2, b->U, U));
    PetscCall(LayoutFromRank(l, b->root, 1, b->sigma, sigma));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < b->count; k++) {
    const Block *q = &b->block[k];
    PetscCall(SolveBlock(b, q, U + 2 * (q->first - l->first), sigma + q->first - l->first));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
