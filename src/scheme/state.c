#include "scheme/state.h"

#define VECTORS 10
#define ON_GRID 5 /* the first ones */

static void List(State *q, Vec *all[VECTORS]) {
  all[0] = &q->w;
  all[1] = &q->p;
  all[2] = &q->force;
  all[3] = &q->source;
  all[4] = &q->flow;
  all[5] = &q->sigma;
  all[6] = &q->X;
  all[7] = &q->U;
  all[8] = &q->walls;
  all[9] = &q->solid;
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
  if (c->bodies->obstacles) PetscCall(LayoutCreateVec(c->bodies->obstacles->layout, 2, &q->solid));
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
  if (fields) copy->window = q->window;
  if (fields) PetscCall(PetscArraycpy(copy->mean, q->mean, 2));
  if (fields) copy->a0 = q->a0;
  copy->pending = q->pending;
  copy->hidden = q->hidden;
  copy->step = q->step;
  copy->t = q->t;
  copy->dt = q->dt;
  copy->dt_last = q->dt_last;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What goes with the forces of two states. */
static void SwapForced(State *a, State *b) {
  const PetscReal a0 = a->a0;
  const GridWindow window = a->window;
  a->a0 = b->a0;
  b->a0 = a0;
  a->window = b->window;
  b->window = window;
  for (int k = 0; k < 2; k++) {
    const PetscReal mean = a->mean[k];
    a->mean[k] = b->mean[k];
    b->mean[k] = mean;
  }
}

void StateSwap(State *a, State *b) {
  Vec *one[VECTORS], *other[VECTORS];
  if (a->force && b->force) SwapForced(a, b);
  List(a, one);
  List(b, other);
  for (int k = 0; k < VECTORS; k++) {
    const Vec v = *one[k];
    if (!v || !*other[k]) continue;
    *one[k] = *other[k];
    *other[k] = v;
  }
}
