#include "precondition/interactions.h"
#include "base/lanes.h"

#define ITERATIONS 2 /* of GMRES */

/* P^T F: a vesicle's forces, its labels those of the shape, to the coarse points. work[2n]. */
static void RestrictForces(const CurvePoints *q, PetscInt shift, const PetscScalar F[], PetscReal work[],
                           PetscScalar to[]) {
  const PetscInt n = q->n;
  PetscReal *x = work, *y = work + n;
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = k + shift < n ? k + shift : k + shift - n;
    x[k] = F[2 * at];
    y[k] = F[2 * at + 1];
  }
  for (PetscInt i = 0; i < q->points; i++) {
    to[2 * i] = LanesDot(n, q->to_markers + i * n, x);
    to[2 * i + 1] = LanesDot(n, q->to_markers + i * n, y);
  }
}

/* P W: velocities at the coarse points to the markers. work[2n]. */
static void ProlongVelocity(const CurvePoints *q, PetscInt shift, const PetscReal W[], PetscReal work[],
                            PetscScalar to[]) {
  const PetscInt n = q->n;
  PetscReal *x = work, *y = work + n;
  (void)PetscArrayzero(work, 2 * n);
  for (PetscInt i = 0; i < q->points; i++)
    for (PetscInt k = 0; k < n; k++) {
      x[k] += q->to_markers[i * n + k] * W[2 * i];
      y[k] += q->to_markers[i * n + k] * W[2 * i + 1];
    }
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = k + shift < n ? k + shift : k + shift - n;
    to[2 * at] = x[k];
    to[2 * at + 1] = y[k];
  }
}

/* W += what a vesicle's forces F do to itself on the coarse grid, taken off. work[4 points]. */
static void AddSelfVelocity(const SharedShape *q, const RigidFit *fit, PetscInt points, const PetscReal F[],
                            PetscReal work[], PetscReal W[]) {
  PetscReal *f = work, *w = work + 2 * points;
  RigidFitTurn(fit, PETSC_TRUE, points, F, f);
  (void)PetscArrayzero(w, 2 * points);
  for (PetscInt j = 0; j < 2 * points; j++)
    for (PetscInt i = 0; i < 2 * points; i++) w[i] += q->self[j * 2 * points + i] * f[j];
  RigidFitTurn(fit, PETSC_FALSE, points, w, f);
  for (PetscInt i = 0; i < 2 * points; i++) W[i] += f[i];
}

/* W = -K F + D J: what forces F and jumps J of the own vesicles, and the walls, do to the others; own parts of marker
   vectors. */
static PetscErrorCode OthersVelocity(Interactions c, const ShapeSources *sources, PetscScalar W[]) {
  const PetscScalar *F = sources->force;
  const SharedShapes s = c->shapes;
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++)
    RestrictForces(&s->weights[s->shape[s->of[v]].weights], s->fit[v - l->own].shift, F + 2 * LayoutOffset(l, v),
                   c->work, c->F + 2 * LayoutOffset(coarse, v));
  PetscCall(PetscArraycpy(c->W, c->F, 2 * coarse->n));
  PetscCall(CoarseGridApply(s->coarse, c->W));
  for (PetscInt v = l->own; v < l->end; v++) {
    const SharedShape *q = &s->shape[s->of[v]];
    const RigidFit *fit = &s->fit[v - l->own];
    const PetscInt points = LayoutCount(coarse, v), at = 2 * LayoutOffset(coarse, v);
    AddSelfVelocity(q, fit, points, c->F + at, c->work, c->W + at);
    ProlongVelocity(&s->weights[q->weights], fit->shift, c->W + at, c->work, W + 2 * LayoutOffset(l, v));
  }
  PetscCall(CoarseCorrectionApply(c->near, F, W));
  if (c->dipoles) PetscCall(DoubleCrossApply(c->dipoles, sources->jump, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = W + (K F - D J)(B^-1 (W, 0)). */
static PetscErrorCode InteractionsMult(Mat A, Vec W, Vec y) {
  Interactions c;
  const PetscScalar *from;
  PetscScalar *to;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &c));
  const SharedShapes s = c->shapes;
  PetscCall(VecGetArrayRead(W, &from));
  PetscCall(VecGetArray(y, &to));
  for (PetscInt k = 0; k < s->count; k++) SharedShapeSources(s, &s->shape[k], from, &c->answer);
  PetscCall(OthersVelocity(c, &c->answer, to));
  PetscCall(VecRestoreArray(y, &to));
  PetscCall(VecRestoreArrayRead(W, &from));
  PetscCall(VecAYPX(y, -1, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateInteractionKSP(Interactions c, Layout l) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(LayoutCreateVec(l, 2, &c->known));
  PetscCall(VecDuplicate(c->known, &c->velocity));
  PetscCall(MatCreateShell(l->comm, 2 * l->n, 2 * l->n, 2 * l->M, 2 * l->M, c, &c->A));
  PetscCall(MatShellSetOperation(c->A, MATOP_MULT, (void (*)(void))InteractionsMult));
  PetscCall(KSPCreate(l->comm, &c->ksp));
  PetscCall(KSPSetType(c->ksp, KSPGMRES));
  PetscCall(KSPGetPC(c->ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetOperators(c->ksp, c->A, c->A));
  PetscCall(KSPSetTolerances(c->ksp, PETSC_SMALL, 0, PETSC_DEFAULT, ITERATIONS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InteractionsCreate(SharedShapes s, Interactions *out) {
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout;
  PetscInt most = 0;
  Interactions c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->shapes = s;
  for (PetscInt v = l->own; v < l->end; v++)
    most = PetscMax(most, PetscMax(2 * LayoutCount(l, v), 4 * LayoutCount(coarse, v)));
  PetscCall(PetscMalloc4(2 * coarse->n, &c->F, 2 * coarse->n, &c->W, 2 * l->n, &c->answer.force, most, &c->work));
  if (s->coupling->mobility->contrast) {
    PetscCall(PetscMalloc1(2 * l->n, &c->answer.jump));
    PetscCall(DoubleCrossCreate(s->coupling->mobility->contrast, &c->dipoles));
  }
  PetscCall(CoarseCorrectionCreate(s->coupling->mobility->near, s->coarse, &c->near));
  PetscCall(CreateInteractionKSP(c, l));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InteractionsDestroy(Interactions *cross) {
  Interactions c = *cross;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&c->ksp));
  PetscCall(MatDestroy(&c->A));
  PetscCall(VecDestroy(&c->known));
  PetscCall(VecDestroy(&c->velocity));
  PetscCall(CoarseCorrectionDestroy(&c->near));
  PetscCall(PetscFree4(c->F, c->W, c->answer.force, c->work));
  PetscCall(PetscFree(c->answer.jump));
  PetscCall(DoubleCrossDestroy(&c->dipoles));
  PetscCall(PetscFree(*cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each vesicle's coarse points lie where its shape's lie in its frame. */
PetscErrorCode InteractionsPlace(Interactions c) {
  const SharedShapes s = c->shapes;
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt n = LayoutCount(l, v), points = LayoutCount(coarse, v);
    const PetscReal *X = s->coupling->markers->X + 2 * l->start[v];
    PetscReal mean[2] = {0, 0}, *to = c->W + 2 * LayoutOffset(coarse, v);
    for (PetscInt k = 0; k < 2 * n; k++) mean[k % 2] += X[k] / (PetscReal)n;
    RigidFitTurn(&s->fit[v - l->own], PETSC_FALSE, points, s->shape[s->of[v]].points, to);
    for (PetscInt i = 0; i < 2 * points; i++) to[i] += mean[i % 2];
  }
  PetscCall(CoarseGridPlace(s->coarse, c->W));
  PetscCall(CoarseCorrectionPlace(c->near));
  if (c->dipoles) PetscCall(DoubleCrossPlace(c->dipoles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InteractionsSolve(Interactions c, const ShapeSources *alone, Vec *W) {
  PetscScalar *known;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(c->known, &known));
  PetscCall(OthersVelocity(c, alone, known));
  PetscCall(VecRestoreArray(c->known, &known));
  PetscCall(KSPSolve(c->ksp, c->known, c->velocity));
  *W = c->velocity;
  PetscFunctionReturn(PETSC_SUCCESS);
}
