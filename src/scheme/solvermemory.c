/* What the solver of unsplit steps has kept from earlier ones, for checkpoints. */
#include "precondition/precondition.h"
#include "scheme/coupled.h"
#include "scheme/scheme.h"

/* The obstacles' block where its factor may be of an earlier time or time step; else NULL. */
static ObstacleBlock OlderBlock(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  return ObstacleBlockIsOlder(s->coupling) ? d->solver->preconditioner->solid : NULL;
}

/* Where its numbers are, the last ones of the memory. */
static PetscInt AtBlock(Scheme s) {
  return AGE_MEMORY + SharedShapesMemorySize(s->membrane->layout);
}

PetscInt SchemeMemorySize(Scheme s) {
  const Obstacles o = s->coupling->bodies->obstacles;
  return AtBlock(s) + (ObstacleBlockIsOlder(s->coupling) ? OBSTACLE_BLOCK_MEMORY + 3 * o->free->M : 0);
}

/* Whether solvers have kept something: those of the scheme that goes on from several states, after a step. */
static PetscBool SolversRemember(Scheme s) {
  return s->old[0].X && s->state.dt_last > 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SchemeRemember(Scheme s, PetscReal memory[]) {
  Coupled *d = (Coupled *)s->data;
  const Layout l = s->membrane->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(memory, SchemeMemorySize(s)));
  if (!SolversRemember(s)) PetscFunctionReturn(PETSC_SUCCESS);
  if (OlderBlock(s)) PetscCall(ObstacleBlockGetMemory(OlderBlock(s), memory + AtBlock(s)));
  PreconditionerGetMemory(d->solver->preconditioner, memory);
  if (d->solver->preconditioner->shapes) {
    SharedShapesGetMemory(d->solver->preconditioner->shapes, memory + AGE_MEMORY);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LayoutGatherVec(l, d->made_at, memory + AGE_MEMORY));
  PetscCall(PetscArraycpy(memory + AGE_MEMORY + 2 * l->M, d->made_with, l->bodies));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode RecallSharedShapes(Scheme s, SharedShapes shapes, const PetscReal memory[]) {
  PetscBool valid;
  PetscFunctionBeginUser;
  PetscCall(SharedShapesSetMemory(shapes, memory, &valid));
  PetscCheck(valid, s->scene->comm, PETSC_ERR_USER_INPUT,
             "-restart %s: its solver's memory is of other vesicles; allowed: a checkpoint of this scene",
             s->scene->output.restart);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All is placed for a0 and bodies of an instant. */
static PetscErrorCode PlaceAgain(Scheme s, PetscReal a0, Instant at, Vec X, const PetscReal treading[]) {
  char message[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  PetscCall(CouplingPlace(s->coupling, a0, at, X, treading, message));
  PetscCheck(!*message, s->scene->comm, PETSC_ERR_USER_INPUT, "-restart %s: %s; allowed: a checkpoint of this scene",
             s->scene->output.restart, message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define LATEST 1e3 /* times the present one: of an attempt at a step, so not much later */

static PetscErrorCode RecallBlock(Scheme s, const PetscReal memory[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  char message[PETVES_MAX_MESSAGE];
  Instant at = {0};
  PetscFunctionBeginUser;
  if (!OlderBlock(s) || memory[1] < 0) PetscFunctionReturn(PETSC_SUCCESS);
  at.t = memory[0];
  if (s->state.place)
    PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, 3 * o->free->M, memory + OBSTACLE_BLOCK_MEMORY, &at.place));
  PetscCall(ObstaclesCheck(o, s->scene, at, message));
  PetscCheck(memory[0] >= 0 && memory[0] <= LATEST * (s->state.t + s->state.dt) && !*message, s->scene->comm,
             PETSC_ERR_USER_INPUT, "-restart %s: its solver's memory is of time %g; allowed: a checkpoint.h5 of petves",
             s->scene->output.restart, (double)memory[0]);
  PetscCall(PlaceAgain(s, memory[1] > 0 ? memory[1] : 1, at, s->state.X, NULL));
  PetscCall(VecDestroy(&at.place));
  PetscCall(ObstacleBlockSetMemory(OlderBlock(s), memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeRecall(Scheme s, const PetscReal memory[]) {
  Coupled *d = (Coupled *)s->data;
  const Layout l = s->membrane->layout;
  const PetscReal a0 = memory[0];
  PetscScalar *X;
  PetscFunctionBeginUser;
  if (!SolversRemember(s)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(RecallBlock(s, memory + AtBlock(s)));
  if (d->solver->preconditioner->shapes)
    PetscCall(RecallSharedShapes(s, d->solver->preconditioner->shapes, memory + AGE_MEMORY));
  if (!l->bodies || a0 <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(d->made_at, &X));
  PetscCall(PetscArraycpy(X, memory + AGE_MEMORY + 2 * l->first, 2 * l->n));
  PetscCall(VecRestoreArray(d->made_at, &X));
  PetscCall(PetscArraycpy(d->made_with, memory + AGE_MEMORY + 2 * l->M, l->bodies));
  PetscCall(PlaceAgain(s, a0, StateInstant(&s->state), d->made_at, d->made_with));
  PetscCall(PreconditionerSetMemory(d->solver->preconditioner, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}
