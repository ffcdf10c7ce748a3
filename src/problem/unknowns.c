#include "problem/unknowns.h"
#include "bodies/freebodies.h"

/* 2 R0 of the smallest vesicle, without vesicles half of the box's shorter side. */
static PetscReal Length(Coupling c) {
  const Membrane m = c->membrane;
  const Grid g = c->fluid->grid;
  PetscReal least = m->layout->bodies ? PETSC_MAX_REAL : 0.5 * PETSC_PI * g->h * PetscMin(g->n[0], g->n[1]);
  for (PetscInt v = 0; v < m->layout->bodies; v++) least = PetscMin(least, m->L0[v]);
  return least / PETSC_PI;
}

PetscErrorCode UnknownsCreate(Coupling coupling, Unknowns *out) {
  Unknowns u;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&u));
  *out = u;
  u->coupling = coupling;
  u->length = Length(coupling);
  u->velocity = 2 * coupling->membrane->layout->n;
  u->solid = BodiesObstacleNumbers(coupling->bodies);
  if (coupling->bodies->obstacles) u->solid += 3 * coupling->bodies->obstacles->free->n;
  u->edges = coupling->law->n;
  PetscCall(PetscCalloc1(2 * coupling->bodies->layout->n, &u->V));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UnknownsDestroy(Unknowns *unknowns) {
  PetscFunctionBeginUser;
  if (*unknowns) PetscCall(PetscFree((*unknowns)->V));
  PetscCall(PetscFree(*unknowns));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UnknownsCreateVec(Unknowns u, Vec *x) {
  PetscFunctionBeginUser;
  PetscCall(VecCreate(u->coupling->fluid->grid->comm, x));
  PetscCall(VecSetSizes(*x, UnknownsEdges(u) + u->edges, PETSC_DETERMINE));
  PetscCall(VecSetType(*x, VECSTANDARD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Copy the parts into x, or (out) those of x out of it; a part that is NULL is left out. */
static PetscErrorCode UnknownsCopy(Unknowns u, PetscBool out, Vec V, Vec solid, Vec sigma, Vec x) {
  const Vec part[] = {V, solid, sigma};
  const PetscInt n[] = {u->velocity, u->solid, u->edges};
  PetscScalar *all, *one;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(x, &all));
  for (PetscInt k = 0, at = 0; k < 3; at += n[k++]) {
    if (!part[k]) continue;
    PetscCall(VecGetArray(part[k], &one));
    PetscCall(PetscArraycpy(out ? one : all + at, out ? all + at : one, n[k]));
    PetscCall(VecRestoreArray(part[k], &one));
  }
  PetscCall(VecRestoreArray(x, &all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UnknownsPack(Unknowns u, Vec V, Vec solid, Vec sigma, Vec x) {
  PetscFunctionBeginUser;
  PetscCall(UnknownsCopy(u, PETSC_FALSE, V, solid, sigma, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UnknownsUnpack(Unknowns u, Vec x, Vec V, Vec solid, Vec sigma) {
  PetscFunctionBeginUser;
  PetscCall(UnknownsCopy(u, PETSC_TRUE, V, solid, sigma, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nu + h l alpha */
static PetscReal UnknownsWeight(Unknowns u) {
  const Fluid f = u->coupling->fluid;
  return f->nu + f->grid->h * u->length * f->alpha;
}

void UnknownsScale(Unknowns u, PetscBool inverse, PetscScalar y[]) {
  const Membrane m = u->coupling->membrane;
  const Layout l = m->layout;
  const Fluid f = u->coupling->fluid;
  const Obstacles o = u->coupling->bodies->obstacles;
  const PetscReal weight = UnknownsWeight(u);
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscReal stiffness = m->bending * m->part[v] / (f->a0 * f->nu * PetscPowRealInt(m->ds[v], 3));
    const PetscReal velocity = weight / m->ds[v] * PetscSqrtReal(1 + stiffness);
    for (PetscInt k = 2 * LayoutOffset(l, v); k < 2 * (LayoutOffset(l, v) + LayoutCount(l, v)); k++)
      y[k] = inverse ? y[k] / velocity : y[k] * velocity;
  }
  if (o) ObstaclesScale(o, weight, inverse, y + u->velocity);
  LawScale(u->coupling->law, weight, inverse, y + UnknownsEdges(u));
}

PetscErrorCode UnknownsForce(Unknowns u, const PetscScalar x[], PetscScalar F[]) {
  const Coupling c = u->coupling;
  const Obstacles o = c->bodies->obstacles;
  const PetscInt solid = BodiesObstacleNumbers(c->bodies);
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(F, u->velocity + solid));
  PetscCall(PetscArraycpy(u->V, x, u->velocity));
  PetscCall(PetscArrayzero(u->V + u->velocity, solid));
  if (o) FreeBodiesCarry(o, c->fluid->a0 * o->at.end, NULL, x + u->velocity + solid, u->V + u->velocity);
  PetscCall(ForcesRate(c->forces, 1 / c->fluid->a0, u->V, F));
  LawForce(c->law, 1, x + UnknownsEdges(u), F);
  PetscFunctionReturn(PETSC_SUCCESS);
}
