#include "scheme/state.h"
#include "bodies/freebodies.h"

#define VECTORS 8
#define ON_GRID 3 /* the first ones */

static void List(State *q, Vec *all[VECTORS]) {
  all[0] = &q->w;
  all[1] = &q->p;
  all[2] = &q->flow;
  all[3] = &q->sigma;
  all[4] = &q->X;
  all[5] = &q->U;
  all[6] = &q->solid;
  all[7] = &q->place;
}

PetscErrorCode StateCreate(Coupling c, State *q) {
  const Grid g = c->fluid->grid;
  const Layout l = c->membrane->layout;
  PetscFunctionBeginUser;
  PetscCall(DMCreateGlobalVector(g->velocity, &q->w));
  PetscCall(DMCreateGlobalVector(g->da[FIELD_P], &q->p));
  PetscCall(LayoutCreateVec(l, 2, &q->X));
  PetscCall(VecDuplicate(q->X, &q->U));
  PetscCall(LayoutCreateVec(l, 1, &q->sigma));
  if (c->bodies->obstacles) PetscCall(FreeBodiesCreateVecs(c->bodies->obstacles, &q->solid, &q->place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateDuplicate(const State *q, State *copy) {
  State source = *q;
  Vec *from[VECTORS], *to[VECTORS];
  PetscFunctionBeginUser;
  List(&source, from);
  List(copy, to);
  for (int k = 0; k < VECTORS; k++)
    if (*from[k]) PetscCall(VecDuplicate(*from[k], to[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateDestroy(State *q) {
  Vec *all[VECTORS];
  PetscFunctionBeginUser;
  List(q, all);
  for (int k = 0; k < VECTORS; k++) PetscCall(VecDestroy(all[k]));
  PetscCall(ForcingDestroy(&q->forcing));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StateCopy(const State *q, State *copy, PetscBool fields) {
  State source = *q;
  Vec *from[VECTORS], *to[VECTORS];
  PetscFunctionBeginUser;
  List(&source, from);
  List(copy, to);
  for (int k = fields ? 0 : ON_GRID; k < VECTORS; k++) {
    if (!*from[k]) continue;
    if (!*to[k]) PetscCall(VecDuplicate(*from[k], to[k]));
    PetscCall(VecCopy(*from[k], *to[k]));
  }
  if (fields) PetscCall(ForcingCopy(&q->forcing, &copy->forcing));
  if (fields) copy->a0 = q->a0;
  copy->fields = q->fields;
  copy->step = q->step;
  copy->t = q->t;
  copy->dt = q->dt;
  copy->dt_last = q->dt_last;
  copy->solved = q->solved;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void StateSwap(State *a, State *b) {
  const State kept = *a;
  Vec *one[VECTORS], *other[VECTORS];
  if (a->forcing.values && b->forcing.values) {
    a->forcing = b->forcing;
    a->a0 = b->a0;
    b->forcing = kept.forcing;
    b->a0 = kept.a0;
  }
  List(a, one);
  List(b, other);
  for (int k = 0; k < VECTORS; k++) {
    const Vec v = *one[k];
    if (!v || !*other[k]) continue;
    *one[k] = *other[k];
    *other[k] = v;
  }
}
