#include "precondition/interactions.h"
#include "numerics/blas.h"

#define ITERATIONS 2 /* of GMRES */

/* The velocities w of the coarse points of a curve, to its markers. */
static void SpreadPoints(const CurvePoints *p, const PetscReal w[], PetscReal marker[]) {
  (void)PetscArrayzero(marker, 2 * p->n);
  for (PetscInt i = 0; i < 2 * p->points; i++)
    for (PetscInt k = 0; k < p->n; k++) marker[2 * k + i % 2] += p->to_markers[i / 2 * p->n + k] * w[i];
}

/* W = -K F + D J, the sources of the answers B^-1 (U, sigma): what the own vesicles and the walls do to the other
   bodies; own parts of marker vectors, sigma NULL: 0. */
static PetscErrorCode OthersVelocity(Interactions c, const PetscScalar U[], const PetscScalar sigma[],
                                     PetscScalar W[]) {
  const SharedShapes s = c->shapes;
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout, all = s->coupling->bodies->layout;
  PetscReal *marker = c->work;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(c->W, 2 * coarse->n)); /* obstacles are given no forces */
  for (PetscInt k = 0; k < s->count; k++) PetscCall(SharedShapeSources(s, &s->shape[k], U, sigma, &c->answer));
  for (PetscInt v = l->own; v < l->end; v++) { /* forces to the coarse points, P^T F, in the frame of the shape */
    const CurvePoints *p = &s->shape[s->of[v]].curve;
    const PetscInt at = 2 * LayoutOffset(coarse, v);
    RigidFitInto(&s->fit[v - l->own], 2, p->n, c->answer.force + 2 * LayoutOffset(l, v), marker);
    PetscCall(DenseProduct(PETSC_FALSE, 2, p->points, p->n, marker, p->to_markers, c->F + at));
    RigidFitTurn(&s->fit[v - l->own], PETSC_FALSE, p->points, c->F + at, c->W + at);
  }
  PetscCall(CoarseGridApply(s->coarse, c->W));
  for (PetscInt v = l->own; v < l->end; v++) { /* less what a vesicle does to itself, to the markers */
    const SharedShape *q = &s->shape[s->of[v]];
    const CurvePoints *p = &q->curve;
    const PetscInt points = 2 * p->points, at = 2 * LayoutOffset(coarse, v);
    PetscReal *w = c->work + 2 * p->n;
    RigidFitTurn(&s->fit[v - l->own], PETSC_TRUE, p->points, c->W + at, w);
    PetscCall(DenseMultAdd(PETSC_FALSE, points, points, 1, q->self, c->F + at, w));
    SpreadPoints(p, w, marker);
    RigidFitBack(&s->fit[v - l->own], 2, p->n, marker, W + 2 * LayoutOffset(l, v));
  }
  for (PetscInt b = PetscMax(all->own, l->bodies); b < all->end; b++)
    SpreadPoints(&c->solid[b - l->bodies], c->W + 2 * LayoutOffset(coarse, b), W + 2 * LayoutOffset(all, b));
  PetscCall(CoarseCorrectionApply(c->near, c->answer.force, c->answer.jump, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = W + (K F - D J)(B^-1 (W, 0)). */
static PetscErrorCode InteractionsMult(Mat A, Vec W, Vec y) {
  Interactions c;
  const PetscScalar *from;
  PetscScalar *to;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &c));
  PetscCall(VecGetArrayRead(W, &from));
  PetscCall(VecGetArray(y, &to));
  PetscCall(OthersVelocity(c, from, NULL, to));
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
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout, all = s->coupling->bodies->layout;
  PetscInt most = 0;
  Interactions c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->shapes = s;
  PetscCall(PetscMalloc1(all->bodies - l->bodies, &c->solid));
  for (PetscInt b = l->bodies; b < all->bodies; b++)
    PetscCall(CurvePointsCreate(s->coupling->bodies->kind[b].type == CURVE_OPEN, LayoutCount(all, b),
                                LayoutCount(coarse, b), &c->solid[b - l->bodies]));
  for (PetscInt v = l->own; v < l->end; v++) most = PetscMax(most, 2 * LayoutCount(l, v) + 2 * LayoutCount(coarse, v));
  PetscCall(PetscMalloc4(2 * coarse->n, &c->F, 2 * coarse->n, &c->W, 2 * all->n, &c->answer.force, most, &c->work));
  PetscCall(PetscArrayzero(c->answer.force, 2 * all->n));
  if (s->coupling->mobility->contrast) PetscCall(PetscCalloc1(2 * all->n, &c->answer.jump));
  PetscCall(CoarseCorrectionCreate(s->coupling->mobility, s->coarse, &c->near));
  PetscCall(CreateInteractionKSP(c, all));
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
  for (PetscInt b = 0; b < c->shapes->coupling->bodies->layout->bodies - c->shapes->coupling->bodies->vesicles; b++)
    PetscCall(CurvePointsDestroy(&c->solid[b]));
  PetscCall(PetscFree(c->solid));
  PetscCall(PetscFree4(c->F, c->W, c->answer.force, c->work));
  PetscCall(PetscFree(c->answer.jump));
  PetscCall(PetscFree(*cross));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Each vesicle's coarse points lie where its shape's lie in its frame. */
PetscErrorCode InteractionsPlace(Interactions c) {
  const SharedShapes s = c->shapes;
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout, all = s->coupling->bodies->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt n = LayoutCount(l, v), points = LayoutCount(coarse, v);
    const PetscReal *X = s->coupling->markers->X + 2 * l->start[v];
    PetscReal mean[2] = {0, 0}, *to = c->W + 2 * LayoutOffset(coarse, v);
    for (PetscInt k = 0; k < 2 * n; k++) mean[k % 2] += X[k] / (PetscReal)n;
    RigidFitTurn(&s->fit[v - l->own], PETSC_FALSE, points, s->shape[s->of[v]].points, to);
    for (PetscInt i = 0; i < 2 * points; i++) to[i] += mean[i % 2];
  }
  for (PetscInt b = PetscMax(all->own, l->bodies); b < all->end; b++) {
    const CurvePoints *p = &c->solid[b - l->bodies];
    CurvePointsPlace(p, s->coupling->bodies->kind[b].span, s->coupling->markers->X + 2 * all->start[b],
                     c->W + 2 * LayoutOffset(coarse, b));
  }
  PetscCall(CoarseGridPlace(s->coarse, c->W));
  PetscCall(CoarseCorrectionPlace(c->near));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode InteractionsAdd(Interactions c, const PetscScalar sigma[], PetscScalar U[]) {
  const PetscInt n = 2 * c->shapes->coupling->bodies->layout->n;
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(c->known, &a));
  PetscCall(OthersVelocity(c, U, sigma, a));
  PetscCall(VecRestoreArray(c->known, &a));
  PetscCall(KSPSolve(c->ksp, c->known, c->velocity));
  PetscCall(VecGetArray(c->velocity, &a));
  for (PetscInt k = 0; k < n; k++) U[k] += a[k];
  PetscCall(VecRestoreArray(c->velocity, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
