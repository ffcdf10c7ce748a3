#include "precondition/obstacleblock.h"
#include "base/agree.h"
#include "numerics/blas.h"
#include "numerics/symmetric.h"
#include "precondition/obstaclemodes.h"

struct _p_ObstacleBlock {
  const FluidSpec *spec; /* borrowed */
  Coupling coupling;     /* borrowed */
  Obstacles obstacles;   /* borrowed */
  PetscMPIInt root;      /* the rank that has the factor */
  Age age;               /* of the factor, for the coefficient alpha of H */
  Instant made_at;       /* at which the bodies were where the factor has them */
  PetscInt n;            /* 2W + 3 free, F and q of all bodies (freebodies.h) */
  float *inverse;        /* n x n (symmetric.h), on root; NULL with modes */
  ObstacleModes modes;   /* NULL: dense inverse */
  PetscScalar *own;      /* [2w + 3 own free] work */
  PetscScalar *all;      /* [n] work */
  float *from, *to;      /* [n] work, what has been found */
  PetscInt coupled;      /* number of the factor that X and the vesicles' block are of; 0: they know no obstacles */
  float *response;       /* [2M][2W] X, on root; not made unless coupled */
  PetscScalar *force;    /* [2M] of vesicles, work */
  float *single;         /* [2M] of vesicles in single precision, work */
};

PetscErrorCode ObstacleBlockCreate(const FluidSpec *spec, Coupling coupling, ObstacleBlock *out) {
  const Obstacles o = coupling->bodies->obstacles;
  const PetscInt m = 2 * coupling->membrane->layout->M;
  ObstacleBlock b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->coupling = coupling;
  b->obstacles = o;
  b->age = AgeNone();
  b->root = LayoutOwner(coupling->bodies->layout, 0);
  b->n = 2 * o->layout->M + 3 * o->free->M;
  PetscCall(PetscMalloc6(b->n, &b->all, 2 * o->layout->n + 3 * o->free->n, &b->own, b->n, &b->from, b->n, &b->to, m,
                         &b->force, m, &b->single));
  if (o->modes) PetscCall(ObstacleModesCreate(spec, coupling, b->root, &b->modes));
  if (o->layout->rank != b->root) PetscFunctionReturn(PETSC_SUCCESS);
  if (!b->modes) PetscCall(PetscMalloc1(SymmetricSize(b->n), &b->inverse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockDestroy(ObstacleBlock *block) {
  PetscFunctionBeginUser;
  if (!*block) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ObstacleModesDestroy(&(*block)->modes));
  PetscCall(PetscFree((*block)->inverse));
  PetscCall(PetscFree((*block)->response));
  PetscCall(VecDestroy(&(*block)->made_at.place));
  PetscCall(PetscFree6((*block)->all, (*block)->own, (*block)->from, (*block)->to, (*block)->force, (*block)->single));
  PetscCall(PetscFree(*block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the mobility is had from Stokes solves: an obstacle stands on a wall, which the table of a periodic box does
   not know, and the stream function serves. */
static PetscBool IsBySolves(ObstacleBlock b) {
  const Fluid f = b->coupling->fluid;
  if (!f->tridiagonal || (f->grid->wall[0] && !f->grid->wall[1])) return PETSC_FALSE;
  for (PetscInt v = 0; v < b->obstacles->layout->bodies; v++)
    if (b->obstacles->kind[v].type == CURVE_OPEN) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A h^2 of the grid's own mobility with its near field, on root: the mobility applied to a unit force for each column.
 */
static PetscErrorCode MobilityBySolves(ObstacleBlock b, PetscReal A[]) {
  const Coupling c = b->coupling;
  const Layout l = b->obstacles->layout;
  const PetscInt n = 2 * l->M, own = BodiesFirstObstacle(c->bodies);
  PetscScalar *a;
  Vec F, G, U;
  PetscFunctionBeginUser;
  PetscCall(LayoutCreateVec(c->bodies->layout, 2, &F));
  PetscCall(LayoutCreateVec(c->bodies->layout, 2, &U));
  PetscCall(LayoutCreateVec(c->membrane->layout, 2, &G));
  for (PetscInt j = 0; j < n; j++) {
    PetscCall(VecGetArray(F, &a));
    for (PetscInt k = 0; k < 2 * l->n; k++) a[own + k] = k == j - 2 * l->first ? -PetscSqr(c->fluid->grid->h) : 0;
    PetscCall(VecRestoreArray(F, &a));
    PetscCall(MobilityApply(c->mobility, F, G, U));
    PetscCall(VecGetArray(U, &a));
    PetscCall(LayoutToRank(l, b->root, 2, a + own, l->rank == b->root ? A + j * n : b->all));
    PetscCall(VecRestoreArray(U, &a));
  }
  PetscCall(VecDestroy(&F));
  PetscCall(VecDestroy(&G));
  PetscCall(VecDestroy(&U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A h^2 of the mean mobility, on root. */
static PetscErrorCode MobilityByMean(ObstacleBlock b, PetscReal A[]) {
  const Obstacles o = b->obstacles;
  const MarkerRange solid = {o->all->M - o->layout->M, o->layout->M};
  MeanMobility mobility;
  PetscFunctionBeginUser;
  PetscCall(MeanMobilityCreate(b->spec, b->coupling, PETSC_MAX_REAL, &mobility));
  PetscCall(MeanMobilitySetUp(mobility, b->coupling->fluid->alpha));
  PetscCall(MeanMobilityOnRoot(mobility, &solid, &solid, b->root, A));
  PetscCall(MeanMobilityDestroy(&mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cost of a new factor in iterations, those with the grid's own mobility by 2W solves. With modes the inverse K counts.
   The near field's part of an iteration was measured at 500 to 5000 markers of all bodies. */
static PetscReal ObstacleRenewalCost(ObstacleBlock b) {
  const Grid g = b->coupling->fluid->grid;
  const PetscReal cells = (PetscReal)g->n[0] * g->n[1], W = b->obstacles->layout->M;
  const PetscReal M = (PetscReal)b->coupling->bodies->layout->M,
                  modes = b->modes ? (PetscReal)ObstacleModesCount(b->modes) : 0;
  const PetscReal making = b->modes ? 2.5e-10 * modes * modes * modes : W * W * (5e-10 * W + 6e-7);
  return (IsBySolves(b) ? 2 * W : 0) + making / (1.5e-8 * cells + 2e-9 * M * PetscMin(M, 5000) + 5e-5);
}

/* The whole block's inverse, on root. */
static PetscErrorCode MakeObstacleInverse(ObstacleBlock b, PetscBool *failed) {
  const Layout l = b->obstacles->layout;
  const InnerFluid inner = b->coupling->mobility->inner;
  PetscBool done = PETSC_TRUE;
  PetscReal *A;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(b->n * b->n, &A));
  PetscCall(IsBySolves(b) ? MobilityBySolves(b, A) : MobilityByMean(b, A));
  if (l->rank == b->root) {
    PetscCall(FreeBodiesBlock(b->obstacles, 0, l->bodies, b->coupling->fluid->grid->h, b->age.made_for,
                              inner ? inner->mass : NULL, A));
    PetscCall(SymmetricInvert(b->n, A, b->inverse, &done));
  }
  PetscCall(PetscFree(A));
  PetscCall(AgreeFlag(l->comm, done ? PETSC_FALSE : PETSC_TRUE, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = A^-1 x of the block's approximation, on root. */
static PetscErrorCode InvertObstacles(ObstacleBlock b, float x[], float y[]) {
  PetscFunctionBeginUser;
  if (b->modes)
    PetscCall(ObstacleModesApply(b->modes, x, y));
  else
    SymmetricMult(b->n, b->inverse, x, y);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeObstacleFactor(ObstacleBlock b, PetscBool *failed) {
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetvesEvent("FactorObstacles", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  AgeRenew(&b->age, b->coupling->fluid->alpha);
  PetscCall(InstantCopy(b->obstacles->at, &b->made_at));
  if (b->modes)
    PetscCall(ObstacleModesSetUp(b->modes, b->age.made_for, failed));
  else
    PetscCall(MakeObstacleInverse(b, failed));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockSetUp(ObstacleBlock b, PetscBool *failed) {
  const PetscReal alpha = b->coupling->fluid->alpha;
  PetscFunctionBeginUser;
  if (!b->obstacles->moving && b->age.made_for == alpha) PetscFunctionReturn(PETSC_SUCCESS); /* it is no older */
  if (AgeIsOver(&b->age, alpha, OBSTACLE_STEP_RATIO, ObstacleRenewalCost(b))) PetscCall(MakeObstacleFactor(b, failed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ObstacleBlockSolved(ObstacleBlock b, PetscInt its) {
  AgeSolved(&b->age, its);
}

PetscBool ObstacleBlockIsOlder(Coupling c) {
  const Obstacles o = c->bodies->obstacles;
  return o && (o->moving || !c->fluid->steady) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode ObstacleBlockGetMemory(ObstacleBlock b, PetscReal memory[]) {
  const PetscScalar *place;
  PetscFunctionBeginUser;
  memory[0] = b->made_at.t;
  AgeGetMemory(&b->age, memory + 1);
  if (!b->made_at.place) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(b->made_at.place, &place));
  PetscCall(PetscArraycpy(memory + OBSTACLE_BLOCK_MEMORY, place, 3 * b->obstacles->free->M));
  PetscCall(VecRestoreArrayRead(b->made_at.place, &place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockSetMemory(ObstacleBlock b, const PetscReal memory[]) {
  PetscBool failed;
  PetscFunctionBeginUser;
  PetscCall(MakeObstacleFactor(b, &failed));
  b->age = AgeSetMemory(memory + 1);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* X = A^-1 K to response, and Mob -= h^2 K^T X of K h^2, on root. */
static PetscErrorCode EliminateObstacles(ObstacleBlock b, PetscInt m, PetscReal K[], PetscReal Mob[]) {
  const PetscInt w = 2 * b->obstacles->layout->M;
  const PetscReal over = 1 / PetscSqr(b->coupling->fluid->grid->h);
  PetscReal *X, *part;
  PetscFunctionBeginUser;
  if (!b->response) PetscCall(PetscMalloc1(w * m, &b->response));
  PetscCall(PetscMalloc2(w * m, &X, m * m, &part));
  for (PetscInt j = 0; j < m; j++) {
    for (PetscInt k = 0; k < w; k++) b->from[k] = (float)(over * K[j * w + k]);
    PetscCall(InvertObstacles(b, b->from, b->response + j * w));
  }
  for (PetscInt k = 0; k < w * m; k++) X[k] = b->response[k];
  PetscCall(DenseProduct(PETSC_TRUE, m, m, w, K, X, part));
  for (PetscInt k = 0; k < m * m; k++) Mob[k] -= part[k];
  PetscCall(PetscFree2(X, part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstacleBlockCouple(ObstacleBlock b, MeanMobility mobility, PetscReal Mob[], PetscBool *failed) {
  const MarkerRange vesicles = {0, b->coupling->membrane->layout->M}, solid = {vesicles.n, b->obstacles->layout->M};
  const PetscInt m = 2 * vesicles.n;
  PetscReal *K;
  PetscFunctionBeginUser;
  if (b->obstacles->moving) PetscFunctionReturn(PETSC_SUCCESS);
  if (!b->age.made) PetscCall(MakeObstacleFactor(b, failed)); /* a restart comes here first */
  if (*failed) PetscFunctionReturn(PETSC_SUCCESS);
  b->coupled = b->age.made;
  PetscCall(PetscMalloc1(2 * b->obstacles->layout->M * m, &K));
  PetscCall(
      MeanMobilityOnRoot(mobility, &solid, &vesicles, b->root, K)); /* velocity of obstacles by forces on vesicles */
  if (b->obstacles->layout->rank == b->root) PetscCall(EliminateObstacles(b, m, K, Mob));
  PetscCall(PetscFree(K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ObstacleBlockCoupled(ObstacleBlock b) {
  return b->coupled > 0 && b->coupled == b->age.made ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool ObstacleBlockRenewed(ObstacleBlock b) {
  return b->coupled > 0 && b->coupled != b->age.made ? PETSC_TRUE : PETSC_FALSE;
}

/* On root: the numbers of free bodies by their units, or (out) q by unit over m. */
static void ScaleFreeBodies(ObstacleBlock b, PetscBool out) {
  const Obstacles o = b->obstacles;
  for (PetscInt v = 0; v < o->layout->bodies; v++)
    for (PetscInt j = 0; j < 3 && o->motion[v].free; j++)
      b->all[2 * o->layout->M + 3 * (o->motion[v].free - 1) + j] *= FreeBodyUnit(o, v, j) / (out ? o->ratio[v] : 1);
}

PetscErrorCode ObstacleBlockBegin(ObstacleBlock b, const PetscScalar r[], PetscScalar U[]) {
  const Layout l = b->obstacles->layout, vesicles = b->coupling->membrane->layout;
  const PetscInt w = 2 * l->M, m = 2 * vesicles->M;
  const PetscBool root = l->rank == b->root ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(b->own, r, 2 * l->n + 3 * b->obstacles->free->n));
  ObstaclesTurn(b->obstacles, b->obstacles->at, b->made_at, b->own);
  PetscCall(LayoutToRank(l, b->root, 2, b->own, b->all));
  PetscCall(LayoutToRank(b->obstacles->free, b->root, 3, b->own + 2 * l->n, b->all + w));
  if (root) ScaleFreeBodies(b, PETSC_FALSE);
  if (root) DenseSingle(b->n, b->all, b->from);
  if (ObstacleBlockCoupled(b)) {
    PetscCall(LayoutToRank(vesicles, b->root, 2, U, b->force));
    if (root) {
      PetscCall(PetscArrayzero(b->single, m));
      PetscCall(DenseSingleMultAdd(PETSC_TRUE, w, m, -1, b->response, b->from, b->single));
      for (PetscInt k = 0; k < m; k++) b->force[k] += b->single[k];
    }
    PetscCall(LayoutFromRank(vesicles, b->root, 2, b->force, U));
  }
  if (root) PetscCall(InvertObstacles(b, b->from, b->to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In single precision the rows of free bodies would not hold to rounding; solid has their right-hand sides. */
PetscErrorCode ObstacleBlockEnd(ObstacleBlock b, const PetscScalar F[], PetscScalar solid[]) {
  const InnerFluid inner = b->coupling->mobility->inner;
  const PetscInt free = 3 * b->obstacles->free->n, first = 3 * b->obstacles->free->first;
  const Layout l = b->obstacles->layout, vesicles = b->coupling->membrane->layout;
  const PetscInt w = 2 * l->M, m = 2 * vesicles->M;
  const PetscBool root = l->rank == b->root ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (ObstacleBlockCoupled(b)) {
    PetscCall(LayoutToRank(vesicles, b->root, 2, F, b->force));
    if (root) DenseSingle(m, b->force, b->single);
    if (root) PetscCall(DenseSingleMultAdd(PETSC_FALSE, w, m, -1, b->response, b->single, b->to));
  }
  for (PetscInt k = 0; k < b->n && root; k++) b->all[k] = b->to[k];
  if (root) ScaleFreeBodies(b, PETSC_TRUE);
  PetscCall(LayoutFromRank(l, b->root, 2, b->all, b->own));
  PetscCall(LayoutFromRank(b->obstacles->free, b->root, 3, b->all + w, b->own + 2 * l->n));
  ObstaclesTurn(b->obstacles, b->made_at, b->obstacles->at, b->own);
  for (PetscInt k = 0; k < free; k++)
    solid[2 * l->n + k] = -solid[2 * l->n + k] -
                          (inner ? b->age.made_for * inner->mass[first + k] * b->own[2 * l->n + k] : 0);
  FreeBodiesBalance(b->obstacles, solid + 2 * l->n, b->own);
  PetscCall(PetscArraycpy(solid, b->own, 2 * l->n + free));
  PetscFunctionReturn(PETSC_SUCCESS);
}
