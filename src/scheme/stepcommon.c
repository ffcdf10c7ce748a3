#include "scheme/stepcommon.h"
#include "base/agree.h"

void SchemeImplement(Scheme s, const SchemeOps *ops, void *data) {
  s->ops = *ops;
  s->data = data;
}

PetscErrorCode SchemeAddSolver(Scheme s, KSP ksp, PC inner) {
  PetscFunctionBeginUser;
  PetscCheck(s->solvers < SCHEME_SOLVERS, s->scene->comm, PETSC_ERR_PLIB, "a scheme has %d Krylov solvers at most",
             SCHEME_SOLVERS);
  s->solver[s->solvers++] = (SchemeSolver){ksp, inner};
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SchemeIterations(Scheme s, PetscInt tension, PetscInt bending) {
  s->report.tension_its = tension;
  s->report.bending_its = bending;
}

void SchemeSetTimes(Scheme s, const SchemeTimes *times) {
  s->state.step = times->step;
  s->state.t = times->t;
  s->state.dt = times->dt;
  s->state.dt_last = times->dt_last;
  s->state.solved = times->step > 0 ? PETSC_TRUE : PETSC_FALSE;
  s->past = s->old[0].X ? times->past : 0;
  for (PetscInt j = 0; j < s->past; j++) s->old[j].dt_last = times->dt_earlier[j];
  s->plan.order = times->plan.order;
  s->plan.guess = times->plan.guess;
  if (s->policy.adaptive) s->plan.level = times->plan.level;
}

PetscErrorCode SchemeKeep(Scheme s) {
  Snapshot *b = &s->before;
  PetscFunctionBeginUser;
  b->fields = s->ops.undo && s->past ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(StateCopy(&s->state, &b->state, b->fields));
  for (PetscInt j = 0; j < s->past; j++) PetscCall(StateCopy(&s->old[j], &b->old[j], b->fields));
  b->past = s->past;
  b->plan = s->plan;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeReturn(Scheme s, PetscBool advanced) {
  const Snapshot *b = &s->before;
  PetscFunctionBeginUser;
  if (!b->fields && advanced) PetscCall(s->ops.undo(s));
  PetscCall(StateCopy(&b->state, &s->state, b->fields));
  for (PetscInt j = 0; j < b->past; j++) PetscCall(StateCopy(&b->old[j], &s->old[j], b->fields));
  s->past = b->past;
  s->plan = b->plan;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCurves(Scheme s, Instant at, Vec X) {
  PetscFunctionBeginUser;
  PetscCall(LayoutGatherVec(s->membrane->layout, X, s->work_all));
  PetscCall(BodiesSee(s->coupling->bodies, at, s->work_all, s->work_all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeNamePair(Scheme s, PetscInt v, PetscInt w, const char same[], size_t length, char text[]) {
  const PetscInt vesicles = s->coupling->bodies->vesicles;
  PetscFunctionBeginUser;
  if (v == w)
    PetscCall(PetscSNPrintf(text, length, same, v + 1));
  else if (w < vesicles)
    PetscCall(PetscSNPrintf(text, length, "vesicles %" PetscInt_FMT " and %" PetscInt_FMT, v + 1, w + 1));
  else
    PetscCall(
        PetscSNPrintf(text, length, "vesicle %" PetscInt_FMT " and obstacle %" PetscInt_FMT, v + 1, w - vesicles + 1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool SchemeIsSmooth(Scheme s) {
  return s->membrane->derivative == DERIVATIVE_SPECTRAL ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SchemeBackground(Scheme s, Vec X, PetscReal t) {
  PetscScalar *x, *u;
  PetscFunctionBeginUser;
  PetscCall(VecSet(s->background, 0));
  if (s->fluid->total) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayPair(X, s->background, &x, &u));
  PetscCall(FlowVelocities(&s->scene->flow, t, s->membrane->layout->n, x, u, s->report.failure));
  PetscCall(VecRestoreArrayPair(X, s->background, &x, &u));
  if (FlowIsCustom(&s->scene->flow)) PetscCall(AgreeMessage(s->scene->comm, s->report.failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCheckBodies(Scheme s, Instant at) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const char *advice = s->state.place ? "a smaller -time_step, -contact_repulsion, or a -time_end before that"
                                      : "a -time_end before that, or other velocities";
  PetscFunctionBeginUser;
  if (!o || !o->moving) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ObstaclesCheck(o, s->scene, at, s->report.failure));
  if (!*s->report.failure) {
    advice = "a smaller -time_step";
    PetscCall(ObstaclesCheckStride(o, (Instant){at.t - s->state.dt, s->state.place}, at, s->report.failure));
  }
  if (*s->report.failure) PetscCall(SchemeAdvise(s, advice));
  PetscCall(AgreeMessage(s->scene->comm, s->report.failure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemePlace(Scheme s, PetscReal a0, Vec X, const PetscReal treading[], Instant at) {
  const char *failure = s->report.failure;
  PetscFunctionBeginUser;
  PetscCall(SchemeCheckBodies(s, at));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingPlace(s->coupling, a0, at, X, treading, s->report.failure));
  if (*failure)
    PetscCall(SchemeAdvise(s, "a larger -domain_box, or a smaller -time_step if it should not have come there"));
  if (*failure || !CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeBackground(s, X, at.t));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingSeep(s->coupling, 1, X, NULL, s->background));
  PetscCall(CouplingStretching(s->coupling, s->background, s->g));
  PetscCall(VecScale(s->g, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeMarkerVelocity(Scheme s, Vec V, Vec sigma, Vec U) {
  PetscFunctionBeginUser;
  PetscCall(LawLargest(s->coupling->law, V, sigma, s->g, &s->report.surface_div_max));
  if (U == V)
    PetscCall(VecAXPY(U, 1, s->background));
  else
    PetscCall(VecWAXPY(U, 1, s->background, V));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeMeasureDivergence(Scheme s, Vec w, Vec expected) {
  PetscFunctionBeginUser;
  if (s->fluid->grid->free) PetscFunctionReturn(PETSC_SUCCESS); /* no velocity on the grid */
  PetscCall(GridLargestDivergence(s->fluid->grid, w, expected, &s->report.div_max));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSolverFailed(Scheme s, const char prefix[], KSPConvergedReason why, PetscInt its,
                                  PetscReal residual) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                          "the solve with prefix %s failed in step %" PetscInt_FMT
                          " at time %g: %s after %" PetscInt_FMT " iterations, residual %g; try a smaller -time_step, "
                          "more iterations (-%sksp_max_it) or finer -domain_cells",
                          prefix, s->before.state.step + 1, (double)(s->before.state.t + s->state.dt),
                          KSPConvergedReasons[why], its, (double)residual, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeAdvise(Scheme s, const char advice[]) {
  char *text = s->report.failure;
  const size_t used = strlen(text), room = sizeof(s->report.failure) - used;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(text + used, room, " after step %" PetscInt_FMT ", time %g; try %s", s->state.step,
                          (double)s->state.t, advice));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeWarn(Scheme s, const char format[], ...) {
  char text[PETVES_MAX_MESSAGE];
  va_list arguments;
  PetscFunctionBeginUser;
  va_start(arguments, format);
  PetscCall(PetscVSNPrintf(text, sizeof(text), format, NULL, arguments));
  va_end(arguments);
  PetscCall(PetvesSay(s->scene->comm, "petves: warning: %s\n", text));
  if (s->warnings.n < SCHEME_WARNINGS) PetscCall(PetscStrallocpy(text, &s->warnings.text[s->warnings.n++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
