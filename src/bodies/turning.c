#include "bodies/turning.h"

#define EXPLICIT 0.3 /* of TurningReturn, what may pull along the old edges: order 3 bears 0.52, order 2 0.89 */

/* How far a membrane under this tension comes back in a step, over what bending lets it: the largest of all waves k of
       (sigma k/(4 nu a0)) w/(1 + c_b k^3 w/(4 nu a0)),      w = 1 + 4 nu P k with a permeability P. */
static PetscReal TurningReturn(Membrane m, PetscInt v, PetscReal nu, PetscReal a0, PetscReal sigma) {
  const PetscReal bending = m->bending * m->part[v];
  PetscReal largest = 0;
  for (PetscInt mode = 1; 2 * mode <= LayoutCount(m->layout, v); mode++) {
    const PetscReal k = 2 * PETSC_PI * mode / m->L0[v];
    const PetscReal passing = k * (1 + 4 * nu * m->permeability * k);
    largest = PetscMax(largest, sigma * passing / (4 * nu * a0 + bending * k * k * passing));
  }
  return largest;
}

/* The expected tension, where it is positive, pulls along the new edges as far as waves of the membrane would otherwise
   be unstable in the step. */
static void TurningExpect(void *context, PetscReal nu, PetscReal a0, const PetscScalar sigma[]) {
  const Turning *t = (const Turning *)context;
  const Layout l = t->membrane->layout;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v), n = LayoutCount(l, v);
    PetscReal most = 0;
    for (PetscInt k = at; k < at + n; k++) most = PetscMax(most, sigma[k]);
    const PetscReal part = 1 - EXPLICIT / PetscMax(EXPLICIT, TurningReturn(t->membrane, v, nu, a0, most));
    for (PetscInt k = at; k < at + n; k++) t->tension[k] = part * PetscMax(0, sigma[k]);
  }
}

static PetscErrorCode TurningPlace(void *context, Instant at, const PetscReal X[]) {
  const Turning *t = (const Turning *)context;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(t->tension, t->membrane->layout->n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Most vesicles have no tension that turns. */
static PetscErrorCode TurningRate(void *context, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  const Turning *t = (const Turning *)context;
  const Layout l = t->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    PetscInt k = 0;
    while (k < LayoutCount(l, v) && t->tension[at + k] == 0) k++;
    if (k < LayoutCount(l, v)) MembraneVesiclePull(t->membrane, v, alpha, t->tension + at, V + 2 * at, F + 2 * at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TurningKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  PetscFunctionBeginUser;
  PetscCall(TurningRate(context, -alpha, X, F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tension is a step's; without a step it is the solved one, which is none of the list. */
static PetscErrorCode TurningLaw(void *context, Instant at, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
  return PETSC_SUCCESS;
}

static PetscErrorCode TurningDestroy(void *context) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(((Turning *)context)->tension));
  PetscCall(PetscFree(context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Turning(Bodies bodies, Grid grid, Scene scene, Force *force) {
  Turning *t;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  t->membrane = bodies->membrane;
  PetscCall(PetscCalloc1(t->membrane->layout->n, &t->tension));
  *force = (Force){.name = "turning",
                   .reach = FORCE_WITHIN,
                   .context = t,
                   .place = TurningPlace,
                   .expect = TurningExpect,
                   .rate = TurningRate,
                   .known = TurningKnown,
                   .law = TurningLaw,
                   .destroy = TurningDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
