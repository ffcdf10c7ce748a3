/* The scheme "coupled": the unsplit step, unconditionally stable, solved by preconditioned FGMRES on its forces. Here:
   which steps are taken. */
#include "scheme/coupled.h"
#include "bodies/freebodies.h"
#include "scheme/films.h"

#define MOMENT 1e-12 /* of the first step */

/* Solve the first state, with its markers where they are: one step without inertia, so short that nothing moves.
   Without inertia that is the flow; with inertia the fluid starts from this flow past obstacles, not from a jump at
   their surfaces, free ones without their loads, and from rest where there are none, which is left alone. */
static PetscErrorCode Start_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  State *now = &s->state, *next = &d->next;
  const PetscReal dt = now->dt;
  const PetscBool steady = s->fluid->steady;
  PetscFunctionBeginUser;
  if (now->solved || now->dt_last > 0 || !CouplingHasBodies(s->coupling) || (!steady && !now->solid))
    PetscFunctionReturn(PETSC_SUCCESS);
  FluidSetSteady(s->fluid, PETSC_TRUE);
  d->start = PETSC_TRUE;
  PetscCall(CoupledAttempt(s, MOMENT * dt));
  d->start = PETSC_FALSE;
  FluidSetSteady(s->fluid, steady);
  if (!*s->report.failure) {
    PetscCall(VecCopy(now->X, next->X));
    if (now->place) PetscCall(VecCopy(now->place, next->place));
    PetscCall(StateCopy(next, now, PETSC_TRUE));
    now->fields = CoupledMakes(d);
    now->solved = PETSC_TRUE;
  }
  now->dt = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Start-up: backward Euler on a sixteenth of the step, then BDF2 with doubling steps up to the whole of it. */
static PetscErrorCode GradedStart(Scheme s, Coupled *d, PetscReal dt) {
  const PetscReal parts[] = {1. / 16, 1. / 16, 1. / 8, 1. / 4, 1. / 2};
  PetscFunctionBeginUser;
  d->done = 0;
  d->graded = PETSC_TRUE;
  for (int k = 0; k < 5 && !*s->report.failure; k++) {
    PetscCall(CoupledFixedAttempt(s, parts[k] * dt));
    if (!*s->report.failure) PetscCall(CoupledAdvance(s, parts[k] * dt));
    d->done += parts[k] * dt;
  }
  d->graded = PETSC_FALSE;
  d->done = 0;
  s->state.dt = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step of the given size, whatever it shows. */
static PetscErrorCode FixedStep(Scheme s, Coupled *d, PetscReal dt) {
  PetscFunctionBeginUser;
  if (!s->past && s->scene->scheme.order > 1 && s->scene->scheme.startup == STARTUP_GRADED) {
    PetscCall(GradedStart(s, d, dt));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CoupledFixedAttempt(s, dt));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->state.dt_last > 0 && CouplingHasMembrane(s->coupling)) PetscCall(CoupledEstimate(s, &s->report.estimate));
  PetscCall(CoupledAdvance(s, dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest speed of a marker of one vesicle relative to the vesicle's mean, as its labels see it. */
static PetscReal RelativeSpeed(PetscInt n, const PetscScalar U[]) {
  PetscReal mean[2] = {0, 0}, largest = 0;
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) mean[c] += U[2 * k + c] / n;
  for (PetscInt k = 0; k < n; k++)
    largest = PetscMax(largest, PetscSqrtReal(PetscSqr(U[2 * k] - mean[0]) + PetscSqr(U[2 * k + 1] - mean[1])));
  return largest;
}

/* What the attempt in next shows: error, speed and edge ratio, the largest of all vesicles; of a membrane that
   stretches the edge ratio over that before the step. */
static PetscErrorCode Look(Scheme s, Coupled *d, StepTrial *trial) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *X, *P, *from;
  PetscReal found[2] = {0, 1};
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(d->next.X, &X));
  PetscCall(VecGetArrayRead(d->P, &P));
  PetscCall(VecGetArrayRead(s->state.X, &from));
  for (PetscInt v = l->own; v < l->end; v++) {
    Measures measures, before = {.edge_ratio = 1};
    if (MembraneStretches(m, v)) MembraneMeasure(m, v, from + 2 * LayoutOffset(l, v), &before);
    MembraneMeasure(m, v, X + 2 * LayoutOffset(l, v), &measures);
    found[0] = PetscMax(found[0], RelativeSpeed(LayoutCount(l, v), P + 2 * LayoutOffset(l, v)));
    found[1] = PetscMax(found[1], measures.edge_ratio / before.edge_ratio);
  }
  PetscCall(VecRestoreArrayRead(s->state.X, &from));
  PetscCall(VecRestoreArrayRead(d->P, &P));
  PetscCall(VecRestoreArrayRead(d->next.X, &X));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPI_MAX, l->comm));
  trial->speed = found[0];
  trial->ratio = found[1];
  PetscCall(CoupledEstimate(s, &trial->error));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Size of the next attempt; verdict on the last one. Rank 0 decides, for all. */
static PetscErrorCode DecideSize(Scheme s, PetscReal speed, PetscReal most, PetscReal *dt) {
  const PetscReal limit = s->scene->time.cfl_limit * s->fluid->grid->h;
  PetscFunctionBeginUser;
  *dt = StepSize(&s->policy, &s->plan, s->state.dt_last, speed > 0 ? limit / speed : PETSC_MAX_REAL, most);
  PetscCallMPI(MPI_Bcast(dt, 1, MPIU_REAL, 0, s->scene->comm));
  PetscCallMPI(MPI_Bcast(&s->plan.level, 1, MPIU_INT, 0, s->scene->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Decide(Scheme s, const StepTrial *trial, StepVerdict *verdict) {
  PetscInt decided[2];
  PetscFunctionBeginUser;
  decided[0] = StepJudge(&s->policy, trial, &s->plan);
  decided[1] = s->plan.level;
  PetscCallMPI(MPI_Bcast(decided, 2, MPIU_INT, 0, s->scene->comm));
  *verdict = (StepVerdict)decided[0];
  s->plan.level = decided[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The attempt becomes the state unless, with its area and edges restored, it takes too much of a film: then all is as
   before, and the verdict another one. */
static PetscErrorCode Advance(Scheme s, StepTrial *trial, const StepPlan *before, StepVerdict *verdict) {
  const PetscReal shift = s->report.area_shift;
  StepPlan plan;
  PetscFunctionBeginUser;
  PetscCall(CoupledAdvance(s, trial->dt));
  PetscCall(FilmsLoss(s, (Instant){s->state.t + trial->dt, s->state.place}, &trial->loss));
  if (trial->loss == 0) PetscFunctionReturn(PETSC_SUCCESS);
  s->plan.level = before->level;
  PetscCall(Decide(s, trial, verdict));
  if (*verdict == STEP_ACCEPT) PetscFunctionReturn(PETSC_SUCCESS);
  plan = s->plan;
  PetscCall(SchemeReturn(s, PETSC_TRUE));
  s->plan.level = plan.level;
  s->plan.before = plan.before;
  s->report.area_shift = shift;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Attempts until one is accepted. What makes the last one fail is the step's failure. */
static PetscErrorCode JudgedStep(Scheme s, Coupled *d, PetscReal speed, PetscReal most) {
  StepVerdict verdict;
  StepTrial trial;
  PetscFunctionBeginUser;
  s->plan.before = PETSC_MAX_REAL;
  do {
    trial = (StepTrial){.first = s->state.dt_last == 0 ? PETSC_TRUE : PETSC_FALSE};
    s->report.failure[0] = 0;
    FluidClearFailure(s->fluid);
    PetscCall(DecideSize(s, speed, most, &trial.dt));
    const StepPlan before = s->plan;
    PetscCall(CoupledAttempt(s, trial.dt));
    trial.solved = *s->report.failure ? PETSC_FALSE : PETSC_TRUE;
    trial.order = d->order;
    if (trial.solved) PetscCall(Look(s, d, &trial));
    PetscCall(Decide(s, &trial, &verdict));
    if (verdict == STEP_ACCEPT) PetscCall(Advance(s, &trial, &before, &verdict));
  } while (verdict == STEP_REPEAT);
  if (verdict == STEP_GIVE_UP && trial.solved)
    PetscCall(PetscSNPrintf(
        s->report.failure, sizeof(s->report.failure),
        "-time_adapt error: no step small enough in step %" PetscInt_FMT
        " at time %g (estimate %g, edge ratio %g, film lost over allowed %g); a larger -time_adapt_tol "
        "or more markers may help",
        s->state.step + 1, (double)s->state.t, (double)trial.error, (double)trial.ratio, (double)trial.loss));
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

static PetscErrorCode Step_Coupled(Scheme s, PetscReal most) {
  Coupled *d = (Coupled *)s->data;
  PetscReal speed = 0; /* max(|u| + |v|), which bounds steps with convection */
  PetscFunctionBeginUser;
  PetscCall(Start_Coupled(s));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  if (d->convection) PetscCall(ConvectionSpeed(d->convection, s->state.w, &speed));
  if (s->policy.adaptive)
    PetscCall(JudgedStep(s, d, speed, most));
  else {
    PetscCall(CheckCourant(s, s->state.dt, speed));
    if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(FixedStep(s, d, s->state.dt));
  }
  s->report.cfl = s->state.dt * speed / s->fluid->grid->h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* CoupledAdvance undone, as long as nothing has been solved since. */
static PetscErrorCode Undo_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  PetscFunctionBeginUser;
  StateSwap(&s->state, &d->next);
  StateSwap(&s->old[0], &s->state);
  for (int j = 1; j < SCHEME_PAST; j++) StateSwap(&s->old[j], &s->old[j - 1]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUpConvection(Scheme s, Coupled *d) {
  PetscReal speed;
  PetscFunctionBeginUser;
  if (s->scene->fluid.inertia != INERTIA_CONVECTIVE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ConvectionCreate(&s->scene->flow, s->fluid, &d->convection));
  PetscCall(ConvectionSpeed(d->convection, s->state.w, &speed));
  if (!s->policy.adaptive) PetscCall(CheckCourant(s, s->scene->time.dt, speed));
  PetscCheck(!*s->report.failure, s->scene->comm, PETSC_ERR_USER_INPUT, "%s", s->report.failure);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The states before the present one have the velocity where it is a history: in fluid with inertia, of the older one
   for order 3. It is a flow where one is made, which convection needs on the grid as well. Of the next one both fields
   are needed unless the state's own are made when they are asked for, from the forcing that each of the two has then,
   and from the flow. */
static PetscErrorCode CreateStates_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  const PetscBool later = s->coupling->mobility->stokes && CouplingHasBodies(s->coupling) ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool contrast = s->coupling->mobility->contrast ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool grid = !s->fluid->steady && (!later || d->convection) ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (later && !s->fluid->steady) PetscCall(StreamFlowsCreateVec(CoupledFlows(d), &s->state.flow));
  for (int j = 0; j < SCHEME_PAST; j++) {
    PetscCall(StateDuplicate(&s->state, &s->old[j]));
    PetscCall(VecDestroy(&s->old[j].p));
    if (!grid || j >= s->scene->scheme.order - 1) PetscCall(VecDestroy(&s->old[j].w));
    if (j >= s->scene->scheme.order - 1) PetscCall(VecDestroy(&s->old[j].flow));
  }
  PetscCall(StateDuplicate(&s->state, &d->next));
  PetscCall(ForcingCreate(s->fluid->grid, contrast, &d->next.forcing));
  if (!later) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ForcingCreate(s->fluid->grid, contrast, &s->state.forcing));
  PetscCall(VecDestroy(&d->next.p));
  if (!grid) PetscCall(VecDestroy(&d->next.w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  Vec *markers[] = {&d->Xstar, &d->Xhat, &d->V, &d->Y, &d->P, &d->made_at, &d->moved};
  PetscFunctionBeginUser;
  PetscCall(CoupledSolverCreate(s->scene, s->coupling, &d->solver));
  PetscCall(SchemeAddSolver(s, d->solver->ksp, NULL));
  PetscCall(SetUpConvection(s, d));
  PetscCall(CreateStates_Coupled(s));
  PetscCall(HistoryCreate(s, &d->history));
  for (int i = 0; i < 7; i++) PetscCall(VecDuplicate(s->state.X, markers[i]));
  if (s->state.place) {
    const PetscInt own = 3 * s->coupling->bodies->obstacles->free->n;
    PetscCall(VecDuplicate(s->state.place, &d->place));
    PetscCall(PetscMalloc1(own, &d->load));
  }
  PetscCall(LayoutCreateVec(s->coupling->bodies->layout, 2, &d->known));
  PetscCall(VecDuplicate(d->known, &d->force));
  PetscCall(VecDuplicate(d->known, &d->all));
  PetscCall(PetscCalloc1(s->membrane->layout->bodies, &d->made_with));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Coupled(Scheme s) {
  Coupled *d = (Coupled *)s->data;
  Vec *others[] = {&d->Xstar,   &d->Xhat,  &d->V,     &d->known, &d->Y,  &d->P,
                   &d->made_at, &d->moved, &d->force, &d->place, &d->all};
  PetscFunctionBeginUser;
  PetscCall(CoupledSolverDestroy(&d->solver));
  PetscCall(ConvectionDestroy(&d->convection));
  PetscCall(StateDestroy(&d->next));
  PetscCall(HistoryDestroy(&d->history));
  for (int i = 0; i < 11; i++) PetscCall(VecDestroy(others[i]));
  PetscCall(PetscFree(d->made_with));
  PetscCall(PetscFree(d->load));
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate_Coupled(Scheme s) {
  Coupled *d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  s->data = d;
  s->ops = (SchemeOps){.start = Start_Coupled, .step = Step_Coupled, .undo = Undo_Coupled, .destroy = Destroy_Coupled};
  PetscCall(SetUp_Coupled(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
