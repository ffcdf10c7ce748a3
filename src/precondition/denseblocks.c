#include "precondition/denseblocks.h"
#include "bodies/seepage.h"
#include "base/agree.h"
#include "problem/contrast.h"
#include "precondition/denseblock.h"
#include "numerics/rigidfit.h"

/* The frame of the one curve that a block was made for. */
typedef struct {
  PetscBool turns; /* false: a block of several vesicles, or one that knows obstacles, stays where it was made */
  PetscBool made;
  PetscReal *X;         /* [2n] the curve, centred */
  PetscReal *U, *sigma; /* [2n], [n] work */
  RigidFit fit;         /* of the present curve */
} BlockFrame;

struct _p_DenseBlocks {
  Coupling coupling;
  PetscBool together; /* one block for all vesicles, root's; else each rank has those of its own vesicles */
  PetscMPIInt root;
  PetscInt count; /* blocks of this rank */
  DenseBlock *block;
  BlockFrame *frame;      /* of each block */
  PetscScalar *U, *sigma; /* together: [2M], [M] of all markers, on root */
};

PetscErrorCode DenseBlocksCreate(Coupling coupling, DenseBlocks *out) {
  const Layout l = coupling->membrane->layout;
  DenseBlocks b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->coupling = coupling;
  b->together = l->M <= DENSE_TOGETHER;
  b->root = LayoutOwner(l, 0);
  b->count = b->together ? l->rank == b->root : l->end - l->own;
  PetscCall(PetscCalloc2(b->count, &b->block, b->count, &b->frame));
  for (PetscInt k = 0; k < b->count; k++) {
    const PetscInt v = b->together ? 0 : l->own + k;
    BlockFrame *f = &b->frame[k];
    PetscCall(DenseBlockCreate(coupling->membrane, coupling->forces, coupling->fluid->grid->h, v,
                               b->together ? l->bodies : v + 1, &b->block[k]));
    f->turns = b->block[k].law->end - v == 1 && !(b->together && coupling->bodies->obstacles);
    const PetscInt n = f->turns ? b->block[k].law->n : 0;
    PetscCall(PetscMalloc3(2 * n, &f->X, 2 * n, &f->U, n, &f->sigma));
  }
  PetscCall(PetscMalloc2(2 * l->M, &b->U, l->M, &b->sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksDestroy(DenseBlocks *blocks) {
  DenseBlocks b = *blocks;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < b->count; k++) {
    PetscCall(DenseBlockDestroy(&b->block[k]));
    PetscCall(PetscFree3(b->frame[k].X, b->frame[k].U, b->frame[k].sigma));
  }
  PetscCall(PetscFree2(b->block, b->frame));
  PetscCall(PetscFree2(b->U, b->sigma));
  PetscCall(PetscFree(*blocks));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* B of the blocks, transposed, in free space (ContrastMatrix): made for a block's owner. Collective
   where the block is for all. */
static PetscErrorCode AssembleMotion(DenseBlocks b, PetscInt first, PetscInt n, PetscReal **motion) {
  const Layout l = b->coupling->membrane->layout;
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(PetscMPIIntCast(4 * n * n, &size));
  PetscCall(PetscCalloc1(4 * n * n, motion));
  PetscCall(ContrastMatrix(b->coupling, PETSC_FALSE, first, n, *motion));
  if (l->size > 1 && b->together)
    PetscCallMPI(
        MPI_Reduce(l->rank == b->root ? MPI_IN_PLACE : *motion, *motion, size, MPIU_REAL, MPI_SUM, b->root, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The law of block k, placed at the present markers in the block's frame. */
static void PlaceLaw(DenseBlocks b, PetscInt k) {
  const MembraneLaw law = b->block[k].law;
  const BlockFrame *f = &b->frame[k];
  const PetscReal *X = b->coupling->markers->X + 2 * law->first;
  if (f->turns && f->made) RigidFitInto(&f->fit, 2, law->n, X, f->U);
  LawPlace(law, b->coupling->fluid->a0, f->turns && f->made ? f->U : X);
}

void DenseBlocksPlace(DenseBlocks b) {
  for (PetscInt k = 0; k < b->count; k++) {
    const MembraneLaw law = b->block[k].law;
    BlockFrame *f = &b->frame[k];
    if (f->turns && f->made) {
      RigidFitCentre(law->n, b->coupling->markers->X + 2 * law->first, f->U);
      f->fit = RigidFitCurves(law->n, !b->coupling->membrane->memory, f->U, f->X);
    }
    PlaceLaw(b, k);
  }
}

/* The frames of blocks made for the present markers. */
static void BeginFrames(DenseBlocks b) {
  for (PetscInt k = 0; k < b->count; k++) {
    const MembraneLaw law = b->block[k].law;
    BlockFrame *f = &b->frame[k];
    f->made = PETSC_TRUE;
    f->fit = (RigidFit){.turn = {1, 0}};
    if (f->turns) RigidFitCentre(law->n, b->coupling->markers->X + 2 * law->first, f->X);
    PlaceLaw(b, k);
  }
}

PetscErrorCode DenseBlocksFactor(DenseBlocks b, MeanMobility mobility, ObstacleBlock solid, PetscReal a0,
                                 PetscBool *factored) {
  const Membrane m = b->coupling->membrane;
  const PetscReal h2 = PetscSqr(b->coupling->fluid->grid->h);
  const MarkerRange all = {0, m->layout->M};
  PetscBool good = PETSC_TRUE, singular = PETSC_FALSE, failed;
  PetscReal *Mob, *motion = NULL;
  PetscInt most = b->together ? m->layout->M : 0;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorMobility", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  BeginFrames(b);
  for (PetscInt k = 0; k < b->count; k++) most = PetscMax(most, b->block[k].law->n);
  PetscCall(PetscMalloc1(4 * most * most, &Mob));
  if (b->together) {
    PetscCall(MeanMobilityOnRoot(mobility, &all, &all, b->root, Mob));
    if (solid) PetscCall(ObstacleBlockCouple(solid, mobility, Mob, &singular));
    if (singular) good = PETSC_FALSE;
    PetscCall(AssembleMotion(b, 0, m->layout->M, &motion));
  }
  for (PetscInt k = 0; k < b->count && good; k++) {
    const MembraneLaw law = b->block[k].law;
    if (!b->together) {
      const MarkerRange own = {law->first, law->n};
      PetscCall(MeanMobilityAssemble(mobility, &own, &own, 0, 1, Mob));
      /* the box part does not change the iterations of one vesicle's block but costs more than the rest of it */
      if (b->coupling->mobility->near)
        PetscCall(NearFieldAdd(b->coupling->mobility->near, h2, PETSC_FALSE, &own, &own, Mob));
      PetscCall(AssembleMotion(b, law->first, law->n, &motion));
    }
    SeepageBlock(law, b->coupling->markers->X + 2 * law->first, motion, Mob);
    PetscCall(ContrastTread(m, law->vesicle, law->end, b->coupling->treading + law->vesicle, a0, 2 * law->n, motion));
    PetscCall(DenseBlockFactor(&b->block[k], a0, Mob, motion, &good));
    if (!b->together) PetscCall(PetscFree(motion));
  }
  PetscCall(PetscFree(motion));
  PetscCall(PetscFree(Mob));
  PetscCall(AgreeFlag(m->layout->comm, good ? PETSC_FALSE : PETSC_TRUE, &failed));
  *factored = failed ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Block k's problem, in its frame. */
static PetscErrorCode SolveBlock(DenseBlocks b, PetscInt k, PetscScalar U[], PetscScalar sigma[]) {
  const DenseBlock *q = &b->block[k];
  const PetscInt n = q->law->n;
  BlockFrame *f = &b->frame[k];
  PetscFunctionBeginUser;
  if (!f->turns) {
    PetscCall(DenseBlockSolve(q, 1, U, sigma));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  RigidFitInto(&f->fit, 2, n, U, f->U);
  RigidFitInto(&f->fit, 1, n, sigma, f->sigma);
  PetscCall(DenseBlockSolve(q, 1, f->U, f->sigma));
  RigidFitBack(&f->fit, 2, n, f->U, U);
  RigidFitBack(&f->fit, 1, n, f->sigma, sigma);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseBlocksSolve(DenseBlocks b, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = b->coupling->membrane->layout;
  PetscFunctionBeginUser;
  if (b->together) {
    PetscCall(LayoutToRank(l, b->root, 2, U, b->U));
    PetscCall(LayoutToRank(l, b->root, 1, sigma, b->sigma));
    for (PetscInt k = 0; k < b->count; k++) PetscCall(SolveBlock(b, k, b->U, b->sigma));
    PetscCall(LayoutFromRank(l, b->root, 2, b->U, U));
    PetscCall(LayoutFromRank(l, b->root, 1, b->sigma, sigma));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < b->count; k++) {
    const PetscInt at = b->block[k].law->first - l->first;
    PetscCall(SolveBlock(b, k, U + 2 * at, sigma + at));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
