#include "coupling/obstacleblock.h"
#include "base/agree.h"
#include "coupling/blas.h"
#include "coupling/mobilitysolves.h"

struct _p_ObstacleBlock {
  const FluidSpec *spec; /* borrowed */
  Coupling coupling;     /* borrowed */
  Obstacles obstacles;   /* borrowed */
  PetscMPIInt root;      /* the rank that has the factor */
  PetscReal alpha;       /* that it is for; negative: none yet */
  float *factor;         /* [2W][2W], on root */
  PetscBLASInt *pivot;   /* [2W] */
  PetscScalar *all;      /* [2W] */
};

PetscErrorCode ObstacleBlockCreate(const FluidSpec *spec, Coupling coupling, ObstacleBlock *out) {
  const Obstacles o = coupling->bodies->obstacles;
  const PetscInt n = 2 * o->layout->M;
  ObstacleBlock b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->coupling = coupling;
  b->obstacles = o;
  b->alpha = -1;
  b->root = LayoutOwner(o->layout, 0);
  PetscCall(PetscMalloc1(n, &b->all));
  if (o->layout->rank == b->root) PetscCall(PetscMalloc2(n * n, &b->factor, n, &b->pivot));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockDestroy(ObstacleBlock *block) {
  PetscFunctionBeginUser;
  if (!*block) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*block)->factor, (*block)->pivot));
  PetscCall(PetscFree((*block)->all));
  PetscCall(PetscFree(*block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether an obstacle stands on a wall, which the table of a periodic box does not know. */
static PetscBool OnWall(Obstacles o) {
  for (PetscInt v = 0; v < o->layout->bodies; v++)
    if (o->kind[v].type == CURVE_OPEN) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* E A^-1 E^T: every rank makes a part of the table's sums, or root has all from solves. */
static PetscErrorCode AssembleMobility(ObstacleBlock b, PetscReal A[]) {
  const Layout l = b->obstacles->layout;
  Mobility mobility;
  PetscFunctionBeginUser;
  if (OnWall(b->obstacles)) {
    if (l->rank != b->root) PetscCall(PetscArrayzero(A, 4 * l->M * l->M));
    PetscCall(MobilitySolves(b->coupling, b->root, A));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MobilityCreate(b->spec, b->coupling, PETSC_MAX_REAL, &mobility));
  PetscCall(MobilitySetUp(mobility, b->alpha));
  PetscCall(MobilityAssemble(mobility, b->obstacles->all->M - l->M, l->M, l->rank, l->size, A));
  PetscCall(MobilityDestroy(&mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The block times h^2, on root: every rank adds its own rows of the near field. */
static PetscErrorCode Assemble(ObstacleBlock b, PetscReal A[]) {
  const Layout l = b->obstacles->layout;
  const PetscInt n = 2 * l->M, first = b->obstacles->all->M - l->M;
  const PetscReal h2 = PetscSqr(b->coupling->fluid->grid->h);
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(AssembleMobility(b, A));
  PetscCall(NearFieldAdd(b->coupling->near, h2, PETSC_TRUE, first, l->M, A));
  for (PetscInt v = l->own; v < l->end; v++)
    for (PetscInt i = 2 * l->start[v]; i < 2 * l->start[v + 1]; i++)
      for (PetscInt j = 2 * l->start[v]; j < 2 * l->start[v + 1]; j++)
        A[j * n + i] += h2 * b->obstacles->beta * b->obstacles->N[i] * b->obstacles->N[j];
  PetscCall(PetscMPIIntCast(n * n, &size));
  if (l->size > 1)
    PetscCallMPI(MPI_Reduce(l->rank == b->root ? MPI_IN_PLACE : A, A, size, MPIU_REAL, MPI_SUM, b->root, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockSetUp(ObstacleBlock b, PetscBool *failed) {
  const Layout l = b->obstacles->layout;
  const PetscInt n = 2 * l->M;
  const PetscReal over = 1 / PetscSqr(b->coupling->fluid->grid->h);
  PetscBool factored = PETSC_TRUE;
  PetscReal *A;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  if (b->alpha == b->coupling->fluid->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetvesEvent("FactorObstacles", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  b->alpha = b->coupling->fluid->alpha;
  PetscCall(PetscMalloc1(n * n, &A));
  PetscCall(Assemble(b, A));
  if (l->rank == b->root) {
    for (PetscInt k = 0; k < n * n; k++) A[k] *= over;
    PetscCall(DenseFactor(n, A, b->pivot, &factored));
    for (PetscInt k = 0; k < n * n; k++) b->factor[k] = (float)A[k];
  }
  PetscCall(PetscFree(A));
  PetscCall(AgreeFlag(l->comm, factored ? PETSC_FALSE : PETSC_TRUE, failed));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockSolve(ObstacleBlock b, PetscScalar F[]) {
  const Layout l = b->obstacles->layout;
  PetscFunctionBeginUser;
  PetscCall(LayoutToRank(l, b->root, 2, F, b->all));
  if (l->rank == b->root) PetscCall(DenseSolveSingle(2 * l->M, b->factor, b->pivot, b->all));
  PetscCall(LayoutFromRank(l, b->root, 2, b->all, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}
