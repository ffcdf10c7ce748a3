#include "bodies/force.h"

PetscErrorCode ForcesDestroy(Forces *forces) {
  Forces f = *forces;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; f && k < f->n; k++)
    if (f->force[k].destroy) PetscCall(f->force[k].destroy(f->force[k].context));
  PetscCall(PetscFree(*forces));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesAdd(Forces f, const Force *force) {
  PetscFunctionBeginUser;
  PetscCheck(f->n < FORCES_MOST, PETSC_COMM_SELF, PETSC_ERR_PLIB, "more than %d forces", FORCES_MOST);
  f->force[f->n++] = *force;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void *ForcesFind(Forces f, const char name[]) {
  for (PetscInt k = 0; k < f->n; k++)
    if (!strcmp(f->force[k].name, name)) return f->force[k].context;
  return NULL;
}

ForceReach ForcesReach(Forces f) {
  ForceReach farthest = FORCE_WITHIN;
  for (PetscInt k = 0; k < f->n; k++) farthest = PetscMax(farthest, f->force[k].reach);
  return farthest;
}

/* An operation of every force that has it. */
#define FORCES_EACH(f, operation, ...)                                                                                 \
  for (PetscInt k = 0; k < (f)->n; k++)                                                                                \
    if ((f)->force[k].operation) PetscCall((f)->force[k].operation((f)->force[k].context, __VA_ARGS__))

PetscErrorCode ForcesPlace(Forces f, Instant at, const PetscReal X[]) {
  PetscFunctionBeginUser;
  FORCES_EACH(f, place, at, X);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesExpect(Forces f, PetscReal nu, PetscReal a0, Vec tension) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(tension, &a));
  for (PetscInt k = 0; k < f->n; k++)
    if (f->force[k].expect) f->force[k].expect(f->force[k].context, nu, a0, a);
  PetscCall(VecRestoreArrayRead(tension, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesRate(Forces f, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  PetscFunctionBeginUser;
  FORCES_EACH(f, rate, alpha, V, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesKnown(Forces f, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  PetscFunctionBeginUser;
  FORCES_EACH(f, known, alpha, X, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesDense(Forces f, PetscInt vesicle, PetscReal alpha, PetscReal K[]) {
  PetscFunctionBeginUser;
  FORCES_EACH(f, dense, vesicle, alpha, K);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesLaw(Forces f, ForceReach first, ForceReach last, Instant at, const PetscScalar X[],
                         PetscScalar F[]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < f->n; k++) {
    const Force *force = &f->force[k];
    if (force->reach < first || force->reach > last) continue;
    if (force->law) PetscCall(force->law(force->context, at, X, F, NULL));
    if (!force->law && force->rate) PetscCall(force->rate(force->context, -1, X, F));
    if (!force->law && force->known) PetscCall(force->known(force->context, -1, X, F));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForcesSeams(Forces f, const PetscReal Xstar[], const PetscScalar x[], PetscReal *sum) {
  PetscFunctionBeginUser;
  *sum = 0;
  FORCES_EACH(f, seams, Xstar, x, sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}
