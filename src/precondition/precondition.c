#include "precondition/precondition.h"
#include "precondition/denseblock.h"

#define ADAPTED_RATIO                                                                                                  \
  2.2 /* of two steps whose blocks are shared, where each differs: a factor of 2 costs half an iteration */
#define LABELS_MOVED 0.1 /* change of the labels' own motion in the highest mode of shared blocks */
#define DEAR 4           /* iterations that new blocks cost, from which on they serve more: the parts of a graded */
#define DEAR_MOVED 0.5   /* start, as steps that differ each time, and labels that have moved by this */

/* How far apart markers of one block are: half a contour, or anywhere. */
static PetscReal BlockReach(Coupling c) {
  const Membrane m = c->membrane;
  PetscReal reach = 0;
  for (PetscInt v = 0; v < m->layout->bodies; v++) reach = PetscMax(reach, m->L0[v] / 2);
  return c->bodies->layout->bodies > 1 && m->layout->M <= DENSE_TOGETHER ? PETSC_MAX_REAL : reach;
}

PetscErrorCode PreconditionerCreate(Scene scene, Unknowns u, PetscBool flexible, Preconditioner *out) {
  const Coupling c = u->coupling;
  Preconditioner p;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&p));
  *out = p;
  p->unknowns = u;
  p->flexible = flexible;
  p->step_ratio = scene->time.adapt == ADAPT_ERROR && !c->bodies->obstacles ? ADAPTED_RATIO : OBSTACLE_STEP_RATIO;
  PetscCall(PetscMalloc1(2 * c->bodies->layout->n, &p->force));
  if (c->bodies->obstacles) PetscCall(ObstacleBlockCreate(&scene->fluid, c, &p->solid));
  PetscCall(PetscCalloc1(c->membrane->layout->bodies, &p->treading));
  const PetscBool shares = c->membrane->layout->M > DENSE_TOGETHER && c->membrane->permeability == 0;
  if (c->mobility->near && c->fluid->steady && shares) {
    PetscCall(SharedShapesCreate(&scene->fluid, c, &p->shapes));
  } else if (CouplingHasMembrane(c)) {
    PetscCall(MeanMobilityCreate(&scene->fluid, c, BlockReach(c), &p->mobility));
    PetscCall(DenseBlocksCreate(c, &p->blocks));
  }
  p->age = AgeNone();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PreconditionerDestroy(Preconditioner *preconditioner) {
  Preconditioner p = *preconditioner;
  PetscFunctionBeginUser;
  if (!p) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SharedShapesDestroy(&p->shapes));
  PetscCall(ObstacleBlockDestroy(&p->solid));
  PetscCall(DenseBlocksDestroy(&p->blocks));
  PetscCall(MeanMobilityDestroy(&p->mobility));
  PetscCall(PetscFree(p->force));
  PetscCall(PetscFree(p->treading));
  PetscCall(PetscFree(*preconditioner));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New dense blocks, whose age begins. */
static PetscErrorCode MakeBlocks(Preconditioner p) {
  const Coupling c = p->unknowns->coupling;
  const Fluid f = c->fluid;
  PetscBool factored;
  PetscFunctionBeginUser;
  PetscCall(MeanMobilitySetUp(p->mobility, f->alpha));
  PetscCall(DenseBlocksFactor(p->blocks, p->mobility, p->solid, f->a0, &factored));
  p->failed = factored ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetscArraycpy(p->treading, c->treading, c->membrane->layout->bodies));
  AgeRenew(&p->age, f->a0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

void PreconditionerGetMemory(Preconditioner p, PetscReal memory[AGE_MEMORY]) {
  AgeGetMemory(&p->age, memory);
}

PetscErrorCode PreconditionerSetMemory(Preconditioner p, const PetscReal memory[AGE_MEMORY]) {
  PetscFunctionBeginUser;
  if (!p->blocks || memory[0] <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  DenseBlocksPlace(p->blocks);
  PetscCall(MakeBlocks(p));
  p->age = AgeSetMemory(memory);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cost of new dense blocks in iterations. */
static PetscReal BlocksRenewalCost(Preconditioner p) {
  const Coupling c = p->unknowns->coupling;
  const Layout l = c->membrane->layout;
  const PetscReal n = l->M <= DENSE_TOGETHER ? l->M : (PetscReal)l->M / l->bodies, blocks = l->M / n;
  const PetscReal cells = c->fluid->grid->free ? 0 : (PetscReal)c->fluid->grid->n[0] * c->fluid->grid->n[1];
  return AgeCost(blocks, n, blocks == 1 && p->solid ? (PetscReal)c->bodies->obstacles->layout->M : 0, cells);
}

/* Whether I + (v/a0) d/dt of a vesicle has moved by this part in its highest mode, n/2. */
static PetscBool LabelsMoved(Preconditioner p, PetscReal part) {
  const Coupling c = p->unknowns->coupling;
  for (PetscInt v = 0; v < c->membrane->layout->bodies; v++) {
    const PetscReal mode = 0.5 * (PetscReal)LayoutCount(c->membrane->layout, v) / c->fluid->a0;
    const PetscReal now = mode * c->treading[v], made = mode * p->treading[v];
    if (PetscAbsReal(now - made) > part * (1 + PetscAbsReal(made))) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static PetscBool AreBlocksOver(Preconditioner p) {
  const PetscReal cost = BlocksRenewalCost(p);
  const PetscBool dear = cost > DEAR && !p->solid ? PETSC_TRUE : PETSC_FALSE;
  const PetscReal ratio = dear && p->now.graded ? ADAPTED_RATIO : p->step_ratio;
  if (AgeIsOver(&p->age, p->unknowns->coupling->fluid->a0, ratio, cost)) return PETSC_TRUE;
  if (LabelsMoved(p, dear ? DEAR_MOVED : LABELS_MOVED)) return PETSC_TRUE;
  return p->solid ? ObstacleBlockRenewed(p->solid) : PETSC_FALSE;
}

PetscErrorCode PreconditionerSetUp(Preconditioner p, PetscBool graded) {
  PetscFunctionBeginUser;
  p->now = (Application){.graded = graded};
  p->failed = PETSC_FALSE;
  if (p->solid) PetscCall(ObstacleBlockSetUp(p->solid, &p->failed));
  if (p->shapes && !p->failed) PetscCall(SharedShapesFollow(p->shapes, &p->failed));
  if (!p->blocks || p->failed) PetscFunctionReturn(PETSC_SUCCESS);
  DenseBlocksPlace(p->blocks);
  if (AreBlocksOver(p)) PetscCall(MakeBlocks(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void PreconditionerSolved(Preconditioner p, PetscInt its) {
  if (p->solid) ObstacleBlockSolved(p->solid, its);
  AgeSolved(&p->age, its - p->now.renewed);
}

PetscBool PreconditionerIsNew(Preconditioner p) {
  return p->age.solves == 1 ? PETSC_TRUE : PETSC_FALSE;
}

/* Dense blocks far too old: new ones from here on, and the next time before this happens; the parts of a graded start
   say nothing of later steps. */
static PetscErrorCode RenewUnderWay(Preconditioner p) {
  PetscFunctionBeginUser;
  if (!p->flexible || !p->blocks || !AgeIsFar(&p->age, p->now.applied)) PetscFunctionReturn(PETSC_SUCCESS);
  if (!p->now.graded) AgeShorten(&p->age);
  PetscCall(MakeBlocks(p));
  p->now.renewed = p->now.applied;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PreconditionerApply(Preconditioner p, Vec r, Vec z) {
  const Unknowns u = p->unknowns;
  PetscScalar *V, *sigma;
  PetscFunctionBeginUser;
  PetscCall(RenewUnderWay(p));
  p->now.applied++;
  PetscCall(VecCopy(r, z));
  PetscCall(VecGetArray(z, &V));
  sigma = V + UnknownsEdges(u);
  UnknownsScale(u, PETSC_TRUE, V);
  if (p->shapes) PetscCall(SharedShapesSolve(p->shapes, V, sigma));
  if (p->solid) PetscCall(ObstacleBlockBegin(p->solid, V + u->velocity, V));
  if (p->blocks) PetscCall(DenseBlocksSolve(p->blocks, V, sigma));
  if (p->solid && ObstacleBlockCoupled(p->solid)) PetscCall(UnknownsForce(u, V, p->force));
  if (p->solid) PetscCall(ObstacleBlockEnd(p->solid, p->force, V + u->velocity));
  PetscCall(VecRestoreArray(z, &V));
  if (p->failed) PetscCall(VecSet(z, NAN)); /* the solve ends as diverged */
  PetscFunctionReturn(PETSC_SUCCESS);
}
