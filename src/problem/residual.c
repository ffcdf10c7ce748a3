#include "problem/residual.h"
#include "bodies/freebodies.h"
#include "bodies/seepage.h"

/* (2) F = Dm^T sigma + (1/a0) K V of all forces (bodies/force.h), and the unknown F of obstacles; s->push[0] is minus
   the force of contact on free bodies. */
static PetscErrorCode ReducedForce(Reduced s, const PetscScalar x[], Vec F) {
  const Unknowns u = s->unknowns;
  PetscScalar *f;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(F, &f));
  PetscCall(UnknownsForce(u, x, f));
  PetscCall(PetscArrayzero(s->push[0], s->free));
  if (s->free) FreeBodiesSum(u->coupling->bodies->obstacles, f + u->velocity, s->push[0]);
  PetscCall(PetscArraycpy(f + u->velocity, x + u->velocity, BodiesObstacleNumbers(u->coupling->bodies)));
  PetscCall(VecRestoreArray(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* s->G = V + (v/a0) dV/dt + (P/l) n n^T F of the vesicles' markers, and what is known of it (NULL: without); s->F has
   F of x. */
static PetscErrorCode ReducedMotion(Reduced s, const PetscScalar x[], Vec known) {
  const Coupling c = s->unknowns->coupling;
  const Membrane m = c->membrane;
  PetscScalar *F, *g;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayPair(s->F, s->G, &F, &g));
  PetscCall(PetscArraycpy(g, x, s->unknowns->velocity));
  MembraneTread(m, c->treading, 1 / c->fluid->a0, x, g);
  SeepageAdd(m, -1, PETSC_FALSE, c->markers->X + 2 * m->layout->first, F, g);
  PetscCall(VecRestoreArrayPair(s->F, s->G, &F, &g));
  if (known) PetscCall(VecAXPY(s->G, 1, known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y -= what is known: an own part of a right-hand side. */
static PetscErrorCode Subtract(Vec known, PetscInt n, PetscScalar y[]) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(known, &a));
  for (PetscInt k = 0; k < n; k++) y[k] -= a[k];
  PetscCall(VecRestoreArrayRead(known, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (5) m R q, (6) R^T F + load + the force of contact, with inertia - a0 M q + INT_inside R^T Du/Dt; y: the rows of
   obstacles. */
static void ReducedBodies(Reduced s, const CoupledProblem *q, const PetscScalar x[], PetscScalar y[]) {
  const Unknowns u = s->unknowns;
  const Coupling c = u->coupling;
  const Mobility m = c->mobility;
  const Obstacles o = c->bodies->obstacles;
  const PetscInt markers = BodiesObstacleNumbers(c->bodies), first = 3 * o->free->first;
  const PetscScalar *F = x + u->velocity, *rate = F + markers;
  PetscScalar *rows = y + markers;
  FreeBodiesCarry(o, 1, o->ratio, rate, y);
  for (PetscInt k = 0; k < s->free; k++) rows[k] = (q ? q->load[k] : 0) - s->push[q != NULL][k];
  FreeBodiesSum(o, F, rows);
  for (PetscInt k = 0; m->inner && c->fluid->alpha > 0 && k < s->free; k++)
    rows[k] += m->inner->rate[q != NULL][first + k] - c->fluid->alpha * m->inner->mass[first + k] * rate[k];
}

/* The residual y of x in the equations of residual.h, scaled, where s->G has G and s->U has U (1) of x. With q NULL:
   what is linear in x, for a product with the operator. Collective. */
static PetscErrorCode ReducedResidual(Reduced s, const CoupledProblem *q, const PetscScalar x[], PetscScalar y[]) {
  const Unknowns u = s->unknowns;
  const Coupling c = u->coupling;
  const Layout l = c->membrane->layout;
  const PetscInt n = u->velocity, edges = UnknownsEdges(u), markers = 2 * c->bodies->layout->n;
  const PetscScalar *G;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(y, edges));
  PetscCall(VecGetArrayRead(s->G, &G));
  for (PetscInt v = l->own; v < l->end; v++) /* (3) (1 + ratio)/2 G */
    for (PetscInt k = 2 * LayoutOffset(l, v); k < 2 * (LayoutOffset(l, v) + LayoutCount(l, v)); k++)
      y[k] = MobilityWeight(c->mobility, v) * G[k];
  PetscCall(VecRestoreArrayRead(s->G, &G));
  PetscCall(Subtract(s->U, markers, y)); /* (3), (5) - U - k */
  if (q) PetscCall(Subtract(q->k, markers, y));
  if (c->bodies->obstacles) { /* (5) beta N N^T F + m R q, (6) */
    ObstaclesRows(c->bodies->obstacles, x + n, y + n);
    ReducedBodies(s, q, x, y + n);
  }
  LawRows(c->law, x, x + edges, y + edges); /* (4) Dm V/h^2 - g */
  if (q) PetscCall(Subtract(q->g, u->edges, y + edges));
  LawReplaceAreas(c->law, q ? PETSC_TRUE : PETSC_FALSE, x, y); /* in (3) */
  UnknownsScale(u, PETSC_FALSE, y);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReducedMult(Mat A, Vec x, Vec y) {
  Reduced s;
  PetscScalar *xa, *ya;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayPair(x, y, &xa, &ya));
  PetscCall(ReducedForce(s, xa, s->F));
  PetscCall(ReducedMotion(s, xa, NULL));
  PetscCall(MobilityApply(s->unknowns->coupling->mobility, s->F, s->G, s->U));
  PetscCall(ReducedResidual(s, NULL, xa, ya));
  PetscCall(VecRestoreArrayPair(x, y, &xa, &ya));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedBegin(Reduced s, const CoupledProblem *problem) {
  PetscFunctionBeginUser;
  s->problem = problem;
  PetscCall(PetscArrayzero(s->push[1], s->free));
  PetscCall(MobilityBegin(s->unknowns->coupling->mobility, &problem->known));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedAdd(Reduced s, Vec added, Vec x, Vec residual) {
  const PetscScalar *a;
  PetscScalar *r;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(added, &a));
  PetscCall(ReducedForce(s, a, s->F));
  for (PetscInt k = 0; k < s->free; k++) s->push[1][k] += s->push[0][k];
  PetscCall(ReducedMotion(s, a, NULL));
  PetscCall(VecRestoreArrayRead(added, &a));
  PetscCall(MobilityAdd(s->unknowns->coupling->mobility, s->F, s->G, s->U));
  PetscCall(VecGetArrayRead(x, &a));
  if (s->unknowns->coupling->membrane->permeability > 0) PetscCall(ReducedForce(s, a, s->F));
  PetscCall(ReducedMotion(s, a, s->problem->known.G));
  PetscCall(VecGetArray(residual, &r));
  PetscCall(ReducedResidual(s, s->problem, a, r));
  PetscCall(VecRestoreArray(residual, &r));
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCall(VecScale(residual, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedCreate(Unknowns u, Reduced *out) {
  const Coupling c = u->coupling;
  const PetscInt n = UnknownsEdges(u) + u->edges;
  Reduced s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->unknowns = u;
  PetscCall(LayoutCreateVec(c->bodies->layout, 2, &s->F));
  PetscCall(VecDuplicate(s->F, &s->U));
  s->free = u->solid - BodiesObstacleNumbers(c->bodies);
  PetscCall(PetscMalloc2(s->free, &s->push[0], s->free, &s->push[1]));
  PetscCall(LayoutCreateVec(c->membrane->layout, 2, &s->G));
  PetscCall(MatCreateShell(c->fluid->grid->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))ReducedMult));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedDestroy(Reduced *reduced) {
  Reduced s = *reduced;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&s->F));
  PetscCall(VecDestroy(&s->U));
  PetscCall(VecDestroy(&s->G));
  PetscCall(MatDestroy(&s->A));
  PetscCall(PetscFree2(s->push[0], s->push[1]));
  PetscCall(PetscFree(*reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}
