#include "scheme/scheme.h"
#include "scheme/coupled.h"
#include "scheme/fields.h"
#include "scheme/statechecks.h"

static PetscFunctionList schemes;

static PetscErrorCode ForgetSchemes(void) {
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListDestroy(&schemes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeRegister(const char type[], PetscErrorCode (*create)(Scheme)) {
  PetscFunctionBeginUser;
  if (!schemes) PetscCall(PetscRegisterFinalize(ForgetSchemes));
  PetscCall(PetscFunctionListAdd(&schemes, type, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The initial markers and their velocity, that of the fluid. */
static PetscErrorCode PlaceFirst(Scheme s, const PetscReal X[]) {
  const Layout l = s->membrane->layout;
  State *q = &s->state;
  char message[PETVES_MAX_MESSAGE];
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(q->X, &x));
  PetscCall(PetscArraycpy(x, X + 2 * l->first, 2 * l->n));
  PetscCall(VecRestoreArray(q->X, &x));
  PetscCall(MarkersCheck(s->coupling->markers, l, q->X, message));
  PetscCheck(!*message, s->scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_center %g,%g: %s; allowed: a vesicle inside -domain_box, %s cells from its walls",
             (double)s->scene->vesicles.center.v[0], (double)s->scene->vesicles.center.v[1], message,
             s->coupling->markers->needs);
  PetscCall(CouplingPlaceMarkers(s->coupling, q->X));
  PetscCall(CouplingInterpolate(s->coupling, q->w, q->U));
  PetscCall(SchemeBackground(s, q->X, q->t));
  PetscCheck(!*s->report.failure, s->scene->comm, PETSC_ERR_USER_INPUT, "%s", s->report.failure);
  PetscCall(VecAXPY(q->U, 1, s->background));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateState(Scheme s, const PetscReal X[]) {
  State *q = &s->state;
  PetscFunctionBeginUser;
  PetscCall(StateCreate(s->coupling, q));
  q->dt = s->scene->time.dt;
  if (s->fluid->total) PetscCall(VecCopy(s->fluid->background, q->w));
  PetscCall(VecDuplicate(q->X, &s->background));
  PetscCall(VecDuplicate(q->sigma, &s->g));
  PetscCall(PetscMalloc1(2 * s->coupling->bodies->layout->M, &s->work_all));
  if (CouplingHasMembrane(s->coupling)) PetscCall(PlaceFirst(s, X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate(Scene scene, Coupling coupling, const PetscReal X[], Scheme *out) {
  Scheme s;
  PetscErrorCode (*create)(Scheme);
  PetscFunctionBeginUser;
  PetscCall(SchemeRegister("coupled", SchemeCreate_Coupled));
  PetscCall(PetscFunctionListFind(schemes, scene->scheme.type, &create));
  PetscCheck(create, scene->comm, PETSC_ERR_USER_INPUT, "-scheme_type %s: not registered", scene->scheme.type);
  PetscCall(PetscNew(&s));
  *out = s;
  PetscCall(PetscStrncpy(s->type, scene->scheme.type, sizeof(s->type)));
  s->scene = scene;
  s->coupling = coupling;
  s->fluid = coupling->fluid;
  s->membrane = coupling->membrane;
  s->policy = StepPolicyCreate(scene, s->membrane->layout->bodies + scene->obstacles.free.count);
  s->plan = (StepPlan){.level = StepFirstLevel(), .order = PetscMin(scene->scheme.order, 2), .guess = 2};
  PetscCall(CreateState(s, X));
  PetscCall(create(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeDestroy(Scheme *scheme) {
  Scheme s = *scheme;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->ops.destroy) PetscCall(s->ops.destroy(s));
  PetscCall(StateDestroy(&s->before.state));
  PetscCall(StateDestroy(&s->state));
  for (int j = 0; j < SCHEME_PAST; j++) {
    PetscCall(StateDestroy(&s->before.old[j]));
    PetscCall(StateDestroy(&s->old[j]));
  }
  PetscCall(VecDestroy(&s->background));
  PetscCall(VecDestroy(&s->g));
  PetscCall(PetscFree(s->work_all));
  for (PetscInt k = 0; k < s->warnings.n; k++) PetscCall(PetscFree(s->warnings.text[k]));
  PetscCall(PetscFree(*scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeStart(Scheme s) {
  const PetscInt solves = FluidCountSolves(s->fluid);
  PetscFunctionBeginUser;
  if (!s->ops.start) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PhaseBegin(PHASE_STEP));
  PetscCall(s->ops.start(s));
  PetscCall(PhaseEnd());
  if (s->state.solved)
    s->report.solves = FluidCountSolves(s->fluid) - solves;
  else
    PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeStep(Scheme s, PetscReal until) {
  const PetscReal t = s->state.t;
  const PetscInt solves = FluidCountSolves(s->fluid);
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_STEP));
  PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  PetscCall(SchemeKeep(s));
  FluidClearFailure(s->fluid);
  s->state.dt = s->policy.adaptive ? s->policy.base : StepFixed(&s->policy, t, until);
  PetscCall(s->ops.step(s, until - t));
  s->report.solves = FluidCountSolves(s->fluid) - solves;
  if (!*s->report.failure) {
    s->state.t = StepTime(&s->policy, t, s->state.dt, until);
    s->state.dt_last = s->state.dt_last > 0 ? s->state.dt_last : s->state.dt;
    s->state.step++;
    s->state.solved = PETSC_TRUE;
    PetscCall(SchemeCheck(s));
  }
  if (*s->report.failure) {
    const SolveFailure *cause = FluidFailure(s->fluid); /* of whatever else went wrong */
    if (cause) PetscCall(SchemeSolverFailed(s, cause->prefix, cause->why, cause->its, cause->residual));
    PetscCall(SchemeReturn(s, s->state.step > s->before.state.step ? PETSC_TRUE : PETSC_FALSE));
  }
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  s->report.seconds = end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeView(Scheme s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  if (s->ops.view) PetscCall(s->ops.view(s, viewer));
  for (PetscInt k = 0; k < s->solvers; k++) PetscCall(KSPView(s->solver[k].ksp, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A solver's settings in force as options that bring them back, one a line. */
static PetscErrorCode WriteSolverOptions(const SchemeSolver *solver, FILE *file) {
  const KSP ksp = solver->ksp;
  PC pc = solver->inner;
  const char *prefix;
  KSPType type;
  PCType pc_type;
  PetscReal rtol, atol, dtol;
  PetscInt max_it;
  PetscBool ilu, shell;
  PetscFunctionBeginUser;
  PetscCall(KSPGetOptionsPrefix(ksp, &prefix));
  PetscCall(KSPGetType(ksp, &type));
  PetscCall(KSPGetTolerances(ksp, &rtol, &atol, &dtol, &max_it));
  if (!pc) PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetType(pc, &pc_type));
  fprintf(file, "-%sksp_type %s\n-%sksp_rtol %.17g\n-%sksp_atol %.17g\n-%sksp_max_it %" PetscInt_FMT "\n", prefix, type,
          prefix, (double)rtol, prefix, (double)atol, prefix, max_it);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &shell));
  if (!shell) fprintf(file, "-%spc_type %s\n", prefix, pc_type);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCILU, &ilu));
  if (ilu) {
    PetscInt levels;
    PetscCall(PCFactorGetLevels(pc, &levels));
    fprintf(file, "-%spc_factor_levels %" PetscInt_FMT "\n", prefix, levels);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeWriteOptions(Scheme s, FILE *file) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->solvers; k++) PetscCall(WriteSolverOptions(&s->solver[k], file));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeGetKSP(Scheme s, const char wanted[], KSP *ksp) {
  const char *prefix;
  PetscFunctionBeginUser;
  *ksp = NULL;
  for (PetscInt k = 0; k < s->solvers; k++) {
    PetscCall(KSPGetOptionsPrefix(s->solver[k].ksp, &prefix));
    if (!strcmp(wanted, prefix)) *ksp = s->solver[k].ksp;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeKineticEnergy(Scheme s, PetscReal *energy) {
  PetscReal norm;
  PetscFunctionBeginUser;
  if (s->state.fields == FIELDS_WITHOUT_BOTH || s->state.flow) {
    norm = s->report.measures.square;
    if (s->state.flow) PetscCall(StreamFlowsSquare(SchemeFlows(s), s->state.flow, &norm));
    norm = PetscSqrtReal(norm);
  } else if (s->fluid->total) {
    Vec difference;
    PetscCall(DMGetGlobalVector(s->fluid->grid->velocity, &difference));
    PetscCall(VecWAXPY(difference, -1, s->fluid->background, s->state.w));
    PetscCall(VecNorm(difference, NORM_2, &norm));
    PetscCall(DMRestoreGlobalVector(s->fluid->grid->velocity, &difference));
  } else
    PetscCall(VecNorm(s->state.w, NORM_2, &norm));
  *energy = 0.5 * PetscSqr(norm * s->fluid->grid->h);
  PetscFunctionReturn(PETSC_SUCCESS);
}
