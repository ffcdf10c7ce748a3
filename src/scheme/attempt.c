/* One unsplit step, backward Euler or BDF2 (docs/method.md, One step). */
#include "scheme/coupled.h"

/* S^T u = g: the new edges get the length ds, linearised at the extrapolated edge e*:
   e*.(dU)_k = a0 [(ds^2 - |e*|^2)/2 - e*.(ehat - e*)], the background's own stretching taken off (already in g). */
static PetscErrorCode LengthTarget(Scheme s, Coupled *d, PetscReal a0) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscReal h2 = PetscSqr(s->fluid->grid->h), *tau = s->coupling->tau;
  const PetscScalar *xh;
  PetscScalar *g, *hat = d->edges;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(d->Xhat, &xh));
  PetscCall(VecGetArray(s->g, &g));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    const PetscReal ds = m->ds[v];
    MembraneEdges(m, v, xh + 2 * at, hat);
    for (PetscInt k = 0; k < LayoutCount(l, v); k++) {
      PetscReal star2 = 0, gap = 0;
      for (int c = 0; c < 2; c++) {
        const PetscReal e = ds * tau[2 * (at + k) + c]; /* the extrapolated edge */
        star2 += e * e;
        gap += e * (hat[2 * k + c] - e);
      }
      g[at + k] += a0 * (0.5 * (ds * ds - star2) - gap) / (ds * h2);
    }
  }
  PetscCall(VecRestoreArray(s->g, &g));
  PetscCall(VecRestoreArrayRead(d->Xhat, &xh));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = (1 + r) x - r x_old, the extrapolation; x itself in a first step. */
static PetscErrorCode Extrapolate(PetscReal r, Vec x, Vec x_old, Vec y) {
  PetscFunctionBeginUser;
  if (r > 0)
    PetscCall(VecAXPBYPCZ(y, 1 + r, -r, 0, x, x_old));
  else
    PetscCall(VecCopy(x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = scale (current x + old x_old) */
static PetscErrorCode History(const BDF *b, PetscReal scale, Vec x, Vec x_old, Vec y) {
  PetscFunctionBeginUser;
  if (b->old != 0)
    PetscCall(VecAXPBYPCZ(y, scale * b->current, scale * b->old, 0, x, x_old));
  else
    PetscCall(VecAXPBY(y, scale * b->current, 0, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f = uhat - B Y + bc1 - N(w*) and k = -C c_b ds D4 Y, Y = Xhat + u_inf/a0; no uhat in quasi-steady flow. next.w is
   used for w*. */
static PetscErrorCode RightHandSides(Scheme s, Coupled *d, const BDF *b, PetscReal r) {
  PetscFunctionBeginUser;
  PetscCall(VecSet(d->known, 0));
  if (s->fluid->steady)
    PetscCall(VecSet(d->f, 0));
  else
    PetscCall(History(b, 1, s->state.w, d->old.w, d->f));
  if (s->fluid->bc1) PetscCall(VecAXPY(d->f, 1, s->fluid->bc1));
  if (CouplingBending(s->coupling) > 0) {
    PetscCall(VecWAXPY(d->Y, 1 / b->a0, s->background, d->Xhat));
    PetscCall(CouplingSpreadBending(s->coupling, -1, d->Y, d->f));
    PetscCall(CouplingNearBending(s->coupling, -1, d->Y, d->known));
  }
  if (d->convection) {
    PetscCall(Extrapolate(r, s->state.w, d->old.w, d->next.w));
    PetscCall(ConvectionAdd(d->convection, -1, d->next.w, d->f));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solution extrapolated, the present one in a first step: tension, wall forces, and V = U - u_inf. */
static PetscErrorCode InitialGuess(Scheme s, Coupled *d, PetscReal r) {
  const State *q = &s->state;
  State *n = &d->next;
  PetscFunctionBeginUser;
  if (!d->solver) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Extrapolate(r, q->walls, d->old.walls, n->walls));
  PetscCall(Extrapolate(r, q->sigma, d->old.sigma, n->sigma));
  PetscCall(Extrapolate(r, q->U, d->old.U, d->V));
  PetscCall(VecAXPY(d->V, -1, s->background));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u, p, sigma of the new time (and V); report.failure when the solver fails. */
static PetscErrorCode Solve(Scheme s, Coupled *d) {
  State *n = &d->next;
  const CoupledProblem problem = {
      .f = d->f, .g = s->g, .k = d->known, .w = n->w, .p = n->p, .sigma = n->sigma, .d = n->walls, .V = d->V};
  SolveReport report;
  PetscFunctionBeginUser;
  if (d->direct) {
    PetscCall(DirectSolverSolve(d->direct, &problem));
    if (d->direct->why < 0) PetscCall(SchemeSolverFailed(s, "direct_", d->direct->why, 0, NAN));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CoupledSolverSolve(d->solver, &problem, &report));
  s->report.coupled_its += report.its;
  if (PreconditionerIsNew(d->solver->preconditioner)) PetscCall(VecCopy(d->Xstar, d->made_at));
  if (report.why < 0) PetscCall(SchemeSolverFailed(s, "coupled_", report.why, report.its, report.residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U = u_inf(X*) + V,  X = Xhat + U/a0. */
static PetscErrorCode MoveMarkers(Scheme s, Coupled *d, PetscReal a0) {
  State *n = &d->next;
  PetscFunctionBeginUser;
  PetscCall(SchemeMeasureDivergence(s, n->w));
  if (!CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeMarkerVelocity(s, d->V, n->U));
  PetscCall(VecWAXPY(n->X, 1 / a0, n->U, d->Xhat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledAttempt(Scheme s, PetscReal dt, PetscBool *solved) {
  Coupled *d = (Coupled *)s->data;
  State *q = &s->state;
  const PetscReal r = s->has_old ? dt / q->dt_last : 0;
  const BDF b = BDFCoefficients(s->has_old ? s->scene->scheme.order : 1, dt, s->has_old ? q->dt_last : dt);
  PetscFunctionBeginUser;
  q->dt = dt;
  PetscCall(Extrapolate(b.ratio, q->X, d->old.X, d->Xstar));
  PetscCall(History(&b, 1 / b.a0, q->X, d->old.X, d->Xhat));
  PetscCall(SchemePlace(s, b.a0, d->Xstar, q->t + d->done + dt, solved));
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->scene->scheme.length_target) PetscCall(LengthTarget(s, d, b.a0));
  PetscCall(RightHandSides(s, d, &b, r));
  PetscCall(InitialGuess(s, d, r));
  PetscCall(Solve(s, d));
  *solved = *s->report.failure ? PETSC_FALSE : PETSC_TRUE;
  if (*solved) PetscCall(MoveMarkers(s, d, b.a0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
