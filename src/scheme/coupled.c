/* Schemes "coupled" and "direct": the unsplit step, first or second order, unconditionally stable (DESIGN section 7).
   `coupled` solves it by preconditioned FGMRES on its forces, `direct` by a sparse LU factorisation. */
#include "scheme/coupled.h"

/* Relative errors of an edge above which all are put right after a step, and above which that is worth a warning. */
#define EDGE_TOLERANCE 1e-3
#define EDGE_WARNING 0.01

/* S^T u = g: the new edges get the length ds, linearised at the extrapolated edge e*:
   e*.(dU)_k = a0 [(ds^2 - |e*|^2)/2 - e*.(ehat - e*)], the background's own stretching taken off (already in g). */
static PetscErrorCode LengthTarget(Scheme s, const Coupled *d, PetscReal a0) {
  const Membrane m = s->membrane;
  const PetscReal h2 = PetscSqr(s->fluid->grid->h), *tau = s->coupling->tau;
  const PetscScalar *xh;
  PetscScalar *g, *hat = s->coupling->work;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(d->Xhat, &xh));
  PetscCall(VecGetArray(s->g, &g));
  for (PetscInt v = 0; v < m->vesicles; v++) MembraneEdges(m, v, xh + 2 * m->start[v], hat + 2 * m->start[v]);
  for (PetscInt k = 0; k < m->M; k++) {
    const PetscReal ds = m->spacing[k];
    PetscReal star2 = 0, gap = 0;
    for (int c = 0; c < 2; c++) {
      const PetscReal e = ds * tau[2 * k + c]; /* the extrapolated edge */
      star2 += e * e;
      gap += e * (hat[2 * k + c] - e);
    }
    g[k] += a0 * (0.5 * (ds * ds - star2) - gap) / (ds * h2);
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

/* f = uhat - B (Xhat + u_inf/a0) + bc1; no uhat in quasi-steady flow */
static PetscErrorCode MomentumRightHandSide(Scheme s, Coupled *d, const BDF *b) {
  PetscFunctionBeginUser;
  if (s->fluid->steady)
    PetscCall(VecSet(d->f, 0));
  else
    PetscCall(History(b, 1, s->state.w, d->old.w, d->f));
  if (s->fluid->bc1) PetscCall(VecAXPY(d->f, 1, s->fluid->bc1));
  if (!s->coupling || s->membrane->bending == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecWAXPY(d->Y, 1 / b->a0, s->background, d->Xhat));
  PetscCall(CouplingSpreadAdd(s->coupling, -1, s->coupling->B, d->Y, d->f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solution extrapolated, the present one in a first step: tension, wall forces, and Y = E w of the velocity. */
static PetscErrorCode InitialGuess(Scheme s, Coupled *d, PetscReal r) {
  const State *q = &s->state;
  State *n = &d->next;
  PetscFunctionBeginUser;
  if (!d->saddle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Extrapolate(r, q->walls, d->old.walls, n->walls));
  if (!s->coupling) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Extrapolate(r, q->sigma, d->old.sigma, n->sigma));
  PetscCall(CouplingInterpolate(s->coupling, s->coupling->E, q->w, d->Y));
  if (r == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingInterpolate(s->coupling, s->coupling->E, d->old.w, s->work_markers));
  PetscCall(VecAXPBY(d->Y, -r, 1 + r, s->work_markers));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SolveStep(Scheme s, Coupled *d) {
  State *n = &d->next;
  PetscFunctionBeginUser;
  if (d->direct) {
    PetscCall(DirectSolverSolve(d->direct, d->f, s->g, n->w, n->p, n->sigma));
    if (d->direct->why < 0) PetscCall(SchemeSolverFailed(s, "direct_", d->direct->why, 0, NAN));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SaddleSetUp(d->saddle));
  PetscCall(SaddleSolve(d->saddle, d->f, s->g, n->w, n->p, n->sigma, n->walls, d->Y));
  s->report.coupled_its += d->saddle->its;
  if (d->saddle->age == 1) PetscCall(VecCopy(d->Xstar, d->made_at)); /* the blocks are this solve's */
  if (d->saddle->why < 0)
    PetscCall(SchemeSolverFailed(s, "coupled_", d->saddle->why, d->saddle->its, d->saddle->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledAttempt(Scheme s, PetscReal dt, PetscBool *solved) {
  Coupled *d = (Coupled *)s->data;
  State *q = &s->state, *n = &d->next;
  const BDF b = BDFCoefficients(s->has_old ? d->order : 1, dt, s->has_old ? q->dt_last : dt);
  PetscFunctionBeginUser;
  *solved = PETSC_TRUE;
  q->dt = dt;
  PetscCall(FluidSetTimeCoefficient(s->fluid, b.a0));
  if (s->coupling) { /* operators at X*, history Xhat of the markers, constraint g */
    PetscCall(Extrapolate(b.ratio, q->X, d->old.X, d->Xstar));
    PetscCall(History(&b, 1 / b.a0, q->X, d->old.X, d->Xhat));
    PetscCall(SchemePlaceMarkers(s, d->Xstar, q->t + d->done + dt, solved));
    if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
    if (s->self) PetscCall(SchemeSetSelfMobility(s, b.a0, d->Xstar, NULL, d->Xhat));
    if (d->length_target) PetscCall(LengthTarget(s, d, b.a0));
  }
  const PetscReal r = s->has_old ? dt / q->dt_last : 0;
  PetscCall(MomentumRightHandSide(s, d, &b));
  if (d->convection) { /* N(w*) */
    PetscCall(Extrapolate(r, q->w, d->old.w, n->w));
    PetscCall(ConvectionAdd(d->convection, -1, n->w, d->f));
  }
  PetscCall(InitialGuess(s, d, r));
  PetscCall(SolveStep(s, d));
  *solved = *s->report.failure ? PETSC_FALSE : PETSC_TRUE;
  if (!*solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeMeasureDivergence(s, n->w));
  if (!s->coupling) PetscFunctionReturn(PETSC_SUCCESS);
  /* U = u_inf(X*) + E u,  X = Xhat + U/a0 */
  PetscCall(SchemeMarkerVelocity(s, n->w, n->sigma, n->U));
  if (d->saddle) PetscCall(VecWAXPY(n->U, 1, s->background, d->Y)); /* the velocity whose bending force was used */
  PetscCall(VecWAXPY(n->X, 1 / b.a0, n->U, d->Xhat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Once a run: edges as wrong as this mean a step too large for what it follows. */
static PetscErrorCode WarnOfEdges(Scheme s, Coupled *d, PetscInt v, PetscReal error) {
  PetscFunctionBeginUser;
  if (d->warned || error < EDGE_WARNING) PetscFunctionReturn(PETSC_SUCCESS);
  d->warned = PETSC_TRUE;
  PetscCall(PetscPrintf(s->scene->comm,
                        "petves: warning: vesicle %" PetscInt_FMT ": an edge was off by %.2g of its length after step "
                        "%" PetscInt_FMT " and has been put right; try a smaller -time_step\n",
                        v + 1, (double)error, s->state.step + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The area target, a uniform normal shift of the markers, old ones alike; and what the length target leaves of large
   steps. There the old markers stay: X* and Xhat then go along the constraints and do not carry on what was put right.
   A shift by half an edge has lost the shape, and putting edges right would find another one. */
static PetscErrorCode RestoreMarkers(Scheme s, Coupled *d) {
  const Membrane m = s->membrane;
  PetscScalar *X, *X_old, *unmoved;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(d->old.X, s->work_markers));
  PetscCall(VecGetArray(s->state.X, &X));
  PetscCall(VecGetArray(d->old.X, &X_old));
  PetscCall(VecGetArray(s->work_markers, &unmoved));
  for (PetscInt v = 0; v < m->vesicles; v++) {
    const PetscInt first = 2 * m->start[v], last = 2 * m->start[v + 1];
    const PetscReal shift = d->area_target ? MembraneRestoreArea(m, v, X, X_old) : 0;
    PetscReal error;
    if (PetscAbsReal(shift) > PetscAbsReal(s->report.area_shift)) s->report.area_shift = shift;
    if (!d->length_target || PetscAbsReal(shift) > 0.5 * m->ds[v]) continue;
    PetscCall(MembraneRestoreEdges(m, v, EDGE_TOLERANCE, X, &error));
    if (error > 0) PetscCall(PetscArraycpy(X_old + first, unmoved + first, last - first));
    PetscCall(WarnOfEdges(s, d, v, error));
  }
  PetscCall(VecRestoreArray(s->work_markers, &unmoved));
  PetscCall(VecRestoreArray(d->old.X, &X_old));
  PetscCall(VecRestoreArray(s->state.X, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* state -> old, next -> state; the vectors change places. */
static PetscErrorCode Advance(Scheme s, Coupled *d, PetscReal dt) {
  State *q = &s->state, spare = d->old;
  const State next = d->next;
  PetscFunctionBeginUser;
  d->old = *q;
  d->next = spare;
  q->w = next.w;
  q->p = next.p;
  q->sigma = next.sigma;
  q->X = next.X;
  q->U = next.U;
  q->walls = next.walls;
  q->dt_last = dt;
  s->has_old = PETSC_TRUE;
  if (s->coupling) PetscCall(RestoreMarkers(s, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* state -> next, old -> state, next -> old: Advance undone, as long as nothing has been solved since. */
static PetscErrorCode Undo_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  const State now = s->state;
  PetscFunctionBeginUser;
  s->state = d->old;
  d->old = d->next;
  d->next = now;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Start-up: backward Euler on a sixteenth of the step, then BDF2 with doubling steps up to the whole of it. */
static PetscErrorCode GradedStart(Scheme s, Coupled *d, PetscReal dt, PetscBool *solved) {
  const PetscReal parts[] = {1. / 16, 1. / 16, 1. / 8, 1. / 4, 1. / 2};
  PetscFunctionBeginUser;
  d->done = 0;
  for (int k = 0; k < 5; k++) {
    PetscCall(CoupledAttempt(s, parts[k] * dt, solved));
    if (!*solved) break;
    PetscCall(Advance(s, d, parts[k] * dt));
    d->done += parts[k] * dt;
  }
  d->done = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledSpeed(Scheme s, PetscReal *speed) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  *speed = 0;
  if (d->convection) PetscCall(ConvectionSpeed(d->convection, s->state.w, speed));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A fixed step that convection does not allow: report.failure says so. */
static PetscErrorCode CheckCourant(Scheme s, PetscReal dt, PetscReal speed) {
  const PetscReal h = s->fluid->grid->h, limit = s->scene->time.cfl_limit;
  PetscFunctionBeginUser;
  if (dt * speed <= limit * h) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                          "-time_step %g: the convective term is explicit, and its CFL number %.3g at time %g is above "
                          "-time_cfl_limit %g; allowed: a step of at most %.3g, or -time_adapt error",
                          (double)dt, (double)(dt * speed / h), (double)s->state.t, (double)limit,
                          (double)(limit * h / speed)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  const PetscReal dt = s->state.dt;
  PetscReal speed;
  PetscBool solved;
  PetscFunctionBeginUser;
  PetscCall(CoupledSpeed(s, &speed));
  if (!d->control.on) PetscCall(CheckCourant(s, dt, speed));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  if (d->control.on) {
    PetscReal used = dt;
    PetscCall(StepControlStep(s, &d->control, d->Xstar, &d->next, &used, &solved));
    if (solved) PetscCall(Advance(s, d, used));
    s->state.dt = used;
  } else if (!s->has_old && d->order > 1 && s->scene->scheme.startup == STARTUP_GRADED) {
    PetscCall(GradedStart(s, d, dt, &solved));
    s->state.dt = dt;
  } else {
    PetscCall(CoupledAttempt(s, dt, &solved));
    if (solved) PetscCall(Advance(s, d, dt));
  }
  s->report.cfl = s->state.dt * speed / s->fluid->grid->h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DuplicateState(const State *q, State *copy) {
  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(q->w, &copy->w));
  PetscCall(VecDuplicate(q->p, &copy->p));
  PetscCall(VecDuplicate(q->sigma, &copy->sigma));
  PetscCall(VecDuplicate(q->X, &copy->X));
  PetscCall(VecDuplicate(q->U, &copy->U));
  if (q->walls) PetscCall(VecDuplicate(q->walls, &copy->walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  State *q = &s->state;
  PetscFunctionBeginUser;
  d->order = s->scene->scheme.order;
  d->length_target = s->scene->scheme.length_target;
  d->area_target = s->scene->scheme.area_target;
  if (!strcmp(s->type, "direct"))
    PetscCall(DirectSolverCreate(s->fluid, s->coupling, s->self, &d->direct));
  else {
    PetscCall(SaddleCreate(s->scene, s->fluid, s->coupling, s->self, &d->saddle));
    PetscCall(SaddleCreateWallVec(d->saddle, &q->walls));
  }
  PetscCall(DuplicateState(q, &d->old));
  PetscCall(DuplicateState(q, &d->next));
  PetscCall(VecDuplicate(q->w, &d->f));
  PetscCall(VecDuplicate(q->X, &d->Xstar));
  PetscCall(VecDuplicate(q->X, &d->Xhat));
  PetscCall(VecDuplicate(q->X, &d->Y));
  PetscCall(VecDuplicate(q->X, &d->made_at));
  s->old = &d->old;
  PetscCall(StepControlCreate(s->scene, s->membrane, &d->control));
  if (d->control.on) s->level = &d->control.level;
  if (s->scene->fluid.inertia == INERTIA_CONVECTIVE) {
    PetscReal speed;
    PetscCall(ConvectionCreate(&s->scene->flow, s->fluid, &d->convection));
    PetscCall(CoupledSpeed(s, &speed));
    if (!d->control.on) PetscCall(CheckCourant(s, s->scene->time.dt, speed));
    PetscCheck(!*s->report.failure, s->scene->comm, PETSC_ERR_USER_INPUT, "%s", s->report.failure);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Remember_Coupled(Scheme s, PetscReal memory[]) {
  Coupled *d = (Coupled *)s->data;
  const PetscScalar *X;
  PetscFunctionBeginUser;
  if (!d->saddle) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SaddleGetMemory(d->saddle, memory));
  PetscCall(VecGetArrayRead(d->made_at, &X));
  PetscCall(PetscArraycpy(memory + SADDLE_MEMORY, X, 2 * s->membrane->M));
  PetscCall(VecRestoreArrayRead(d->made_at, &X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Recall_Coupled(Scheme s, const PetscReal memory[]) {
  Coupled *d = (Coupled *)s->data;
  const PetscReal a0 = memory[0];
  PetscScalar *X;
  PetscBool placed;
  PetscFunctionBeginUser;
  if (!d->saddle || !s->coupling || a0 == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(d->made_at, &X));
  PetscCall(PetscArraycpy(X, memory + SADDLE_MEMORY, 2 * s->membrane->M));
  PetscCall(VecRestoreArray(d->made_at, &X));
  PetscCall(FluidSetTimeCoefficient(s->fluid, a0));
  PetscCall(SchemePlaceMarkers(s, d->made_at, s->state.t, &placed));
  if (s->self) PetscCall(SchemeSetSelfMobility(s, a0, d->made_at, NULL, d->made_at));
  PetscCall(SaddleSetMemory(d->saddle, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode View_Coupled(Scheme s, PetscViewer viewer) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  if (d->saddle && !s->fluid->grid->rank) PetscCall(KSPView(d->saddle->ksp, PETSC_VIEWER_STDOUT_SELF));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Options_Coupled(Scheme s, FILE *file) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  if (d->saddle) PetscCall(KSPWriteOptions(d->saddle->ksp, "coupled_", file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode KSP_Coupled(Scheme s, const char prefix[], KSP *ksp) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  *ksp = NULL;
  if (d->saddle && !strcmp(prefix, "coupled_")) *ksp = d->saddle->ksp;
  if (d->direct && !strcmp(prefix, "direct_")) *ksp = d->direct->ksp;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  State *states[2] = {&d->old, &d->next};
  Vec *others[] = {&d->f, &d->Xstar, &d->Xhat, &d->Y, &d->made_at};
  PetscFunctionBeginUser;
  PetscCall(SaddleDestroy(&d->saddle));
  PetscCall(DirectSolverDestroy(&d->direct));
  PetscCall(ConvectionDestroy(&d->convection));
  for (int k = 0; k < 2; k++) {
    Vec *all[] = {&states[k]->w, &states[k]->p, &states[k]->sigma, &states[k]->X, &states[k]->U, &states[k]->walls};
    for (int i = 0; i < 6; i++) PetscCall(VecDestroy(all[i]));
  }
  for (int i = 0; i < 5; i++) PetscCall(VecDestroy(others[i]));
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate_Coupled(Scheme s) {
  Coupled *d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  s->data = d;
  s->setup = SetUp_Coupled;
  s->step = Step_Coupled;
  s->undo = Undo_Coupled;
  s->remember = Remember_Coupled;
  s->recall = Recall_Coupled;
  s->view = View_Coupled;
  s->options = Options_Coupled;
  s->ksp = KSP_Coupled;
  s->destroy = Destroy_Coupled;
  PetscFunctionReturn(PETSC_SUCCESS);
}
