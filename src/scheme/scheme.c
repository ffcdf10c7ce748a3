#include "scheme/scheme.h"

static PetscFunctionList schemes;

PetscErrorCode SchemeRegister(const char type[], PetscErrorCode (*create)(Scheme)) {
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListAdd(&schemes, type, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ForgetSchemes(void) {
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListDestroy(&schemes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateState(Scheme s, const PetscReal X[]) {
  State *q = &s->state;
  const PetscBool any = s->membrane->vesicles > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscBool placed;
  PetscScalar *x;
  PetscFunctionBeginUser;
  q->dt = s->scene->time.dt;
  PetscCall(DMCreateGlobalVector(s->fluid->grid->velocity, &q->w));
  PetscCall(DMCreateGlobalVector(s->fluid->grid->da[FIELD_P], &q->p));
  if (s->fluid->total) PetscCall(VecCopy(s->fluid->background, q->w));
  PetscCall(MembraneCreateMarkerVec(s->membrane, &q->X));
  PetscCall(VecDuplicate(q->X, &q->U));
  PetscCall(VecDuplicate(q->X, &s->background));
  PetscCall(VecDuplicate(q->X, &s->work_markers));
  PetscCall(MembraneCreateTensionVec(s->membrane, &q->sigma));
  PetscCall(VecDuplicate(q->sigma, &s->g));
  PetscCall(VecDuplicate(q->sigma, &s->work_tension));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(q->X, &x));
  PetscCall(PetscArraycpy(x, X, 2 * s->membrane->M));
  PetscCall(VecRestoreArray(q->X, &x));
  PetscCall(SchemePlaceMarkers(s, q->X, q->t, &placed));
  PetscCheck(placed, s->scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_center %g,%g: %s; allowed: a vesicle inside -domain_box, 3 cells from its walls",
             (double)s->scene->vesicles.center.v[0], (double)s->scene->vesicles.center.v[1], s->report.failure);
  PetscCall(SchemeMarkerVelocity(s, q->w, q->sigma, q->U));
  s->report.surface_div_max = 0; /* nothing has been solved yet */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate(Scene scene, Fluid fluid, Membrane membrane, Coupling coupling, const PetscReal X[],
                            Scheme *out) {
  Scheme s;
  PetscErrorCode (*create)(Scheme);
  PetscFunctionBeginUser;
  if (!schemes) {
    PetscCall(SchemeRegister("split", SchemeCreate_Split));
    PetscCall(SchemeRegister("penalty", SchemeCreate_Penalty));
    PetscCall(SchemeRegister("coupled", SchemeCreate_Coupled));
    PetscCall(SchemeRegister("direct", SchemeCreate_Coupled));
    PetscCall(PetscRegisterFinalize(ForgetSchemes));
  }
  PetscCall(PetscFunctionListFind(schemes, scene->scheme.type, &create));
  PetscCheck(create, scene->comm, PETSC_ERR_USER_INPUT, "-scheme_type %s: not registered", scene->scheme.type);
  PetscCall(PetscNew(&s));
  *out = s;
  PetscCall(PetscStrncpy(s->type, scene->scheme.type, sizeof(s->type)));
  s->scene = scene;
  s->fluid = fluid;
  s->membrane = membrane;
  s->coupling = coupling;
  PetscCall(CreateState(s, X));
  if (coupling && scene->coupling.self_mobility != SELF_NONE)
    PetscCall(SelfMobilityCreate(coupling, fluid->nu, (SelfMobilityType)scene->coupling.self_mobility, &s->self));
  PetscCall(create(s));
  PetscCall(s->setup(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeDestroy(Scheme *scheme) {
  Scheme s = *scheme;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->destroy) PetscCall(s->destroy(s));
  PetscCall(SchemeFreeSnapshot(s));
  PetscCall(SelfMobilityDestroy(&s->self));
  PetscCall(VecDestroy(&s->state.w));
  PetscCall(VecDestroy(&s->state.p));
  PetscCall(VecDestroy(&s->state.sigma));
  PetscCall(VecDestroy(&s->state.X));
  PetscCall(VecDestroy(&s->state.U));
  PetscCall(VecDestroy(&s->state.walls));
  PetscCall(VecDestroy(&s->background));
  PetscCall(VecDestroy(&s->g));
  PetscCall(VecDestroy(&s->work_tension));
  PetscCall(VecDestroy(&s->work_markers));
  PetscCall(PetscFree(*scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeStep(Scheme s, PetscReal dt) {
  const PetscInt solves = FluidCountSolves(s->fluid);
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_STEP));
  PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  PetscCall(SchemeKeep(s));
  s->state.dt = dt;
  PetscCall(s->step(s));
  s->report.solves = FluidCountSolves(s->fluid) - solves;
  if (!*s->report.failure) {
    s->state.t += s->state.dt; /* step-size control may have taken less than dt */
    s->state.dt_last = s->state.dt_last > 0 ? s->state.dt_last : s->state.dt;
    s->state.step++;
    PetscCall(SchemeCheck(s));
  }
  if (*s->report.failure) PetscCall(SchemeReturn(s));
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  s->report.seconds = end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeRemember(Scheme s, PetscReal memory[]) {
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(memory, SchemeMemorySize(s)));
  if (s->remember) PetscCall(s->remember(s, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeRecall(Scheme s, const PetscReal memory[]) {
  PetscFunctionBeginUser;
  if (s->recall) PetscCall(s->recall(s, memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeView(Scheme s, PetscViewer viewer) {
  PetscFunctionBeginUser;
  if (s->view) PetscCall(s->view(s, viewer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemePlaceMarkers(Scheme s, Vec X, PetscReal t, PetscBool *placed) {
  const PetscScalar *x;
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(CouplingCheckMarkers(s->coupling, x, s->report.failure, sizeof(s->report.failure)));
  *placed = *s->report.failure ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(VecRestoreArrayRead(X, &x));
  if (!*placed && s->step) { /* not the initial markers, which have a message of their own */
    const size_t used = strlen(s->report.failure);
    PetscCall(PetscSNPrintf(s->report.failure + used, sizeof(s->report.failure) - used,
                            " after step %" PetscInt_FMT
                            ", time %g; try a larger -domain_box, or a smaller -time_step if it "
                            "should not have come there",
                            s->state.step, (double)s->state.t));
  }
  if (!*placed) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingSetMarkers(s->coupling, X));
  PetscCall(VecSet(s->background, 0)); /* in the total form u_inf is in w */
  if (!s->fluid->total) {
    PetscCall(VecGetArrayRead(X, &x));
    PetscCall(VecGetArray(s->background, &u));
    PetscCall(FlowVelocities(&s->scene->flow, t, s->membrane->M, x, u));
    PetscCall(VecRestoreArray(s->background, &u));
    PetscCall(VecRestoreArrayRead(X, &x));
  }
  PetscCall(SchemeBackgroundConstraint(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeBackgroundConstraint(Scheme s) {
  const PetscScalar *u;
  PetscScalar *g;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->background, &u));
  PetscCall(VecGetArray(s->g, &g));
  MembraneStretching(s->membrane, s->coupling->tau, u, g);
  PetscCall(VecRestoreArray(s->g, &g));
  PetscCall(VecRestoreArrayRead(s->background, &u));
  PetscCall(VecScale(s->g, -1 / PetscSqr(s->fluid->grid->h)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSetSelfMobility(Scheme s, PetscReal a0, Vec X, Vec sigma, Vec Xhat) {
  const PetscScalar *x, *xh, *sa = NULL;
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayRead(Xhat, &xh));
  if (sigma) PetscCall(VecGetArrayRead(sigma, &sa));
  PetscCall(VecGetArray(s->background, &u));
  PetscCall(SelfMobilitySetMarkers(s->self, a0, x));
  PetscCall(SelfMobilityApply(s->self, sa, xh, u));
  PetscCall(VecRestoreArray(s->background, &u));
  if (sigma) PetscCall(VecRestoreArrayRead(sigma, &sa));
  PetscCall(VecRestoreArrayRead(Xhat, &xh));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscCall(SchemeBackgroundConstraint(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSolvedVelocity(Scheme s, Vec w, Vec sigma, Vec U) {
  const PetscScalar *sa = NULL;
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(CouplingInterpolate(s->coupling, s->coupling->E, w, U));
  if (!s->self) PetscFunctionReturn(PETSC_SUCCESS);
  if (sigma) PetscCall(VecGetArrayRead(sigma, &sa));
  PetscCall(VecGetArray(U, &u));
  PetscCall(SelfMobilityApply(s->self, sa, NULL, u));
  PetscCall(VecRestoreArray(U, &u));
  if (sigma) PetscCall(VecRestoreArrayRead(sigma, &sa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSurfaceDivergence(Scheme s, Vec w, Vec d) {
  const PetscScalar *u;
  PetscScalar *da;
  PetscFunctionBeginUser;
  PetscCall(SchemeSolvedVelocity(s, w, NULL, s->work_markers));
  PetscCall(VecGetArrayRead(s->work_markers, &u));
  PetscCall(VecGetArray(d, &da));
  MembraneStretching(s->membrane, s->coupling->tau, u, da);
  PetscCall(VecRestoreArray(d, &da));
  PetscCall(VecRestoreArrayRead(s->work_markers, &u));
  PetscCall(VecScale(d, 1 / PetscSqr(s->fluid->grid->h)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeMarkerVelocity(Scheme s, Vec w, Vec sigma, Vec U) {
  const PetscReal h2 = PetscSqr(s->fluid->grid->h);
  const PetscScalar *g, *u;
  PetscScalar *d;
  PetscFunctionBeginUser;
  PetscCall(SchemeSolvedVelocity(s, w, sigma, U));
  PetscCall(VecGetArrayRead(s->g, &g));
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArray(s->work_tension, &d));
  MembraneStretching(s->membrane, s->coupling->tau, u, d);
  s->report.surface_div_max = 0;
  for (PetscInt k = 0; k < s->membrane->M; k++)
    s->report.surface_div_max = PetscMax(s->report.surface_div_max,
                                         PetscAbsReal(d[k] - h2 * g[k]) / s->membrane->spacing[k]);
  PetscCall(VecRestoreArray(s->work_tension, &d));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(VecRestoreArrayRead(s->g, &g));
  PetscCall(VecAXPY(U, 1, s->background));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeMeasureDivergence(Scheme s, Vec w) {
  PetscFunctionBeginUser;
  PetscCall(GridLargestDivergence(s->fluid->grid, w, s->fluid->bc2, &s->report.div_max));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeSolverFailed(Scheme s, const char prefix[], KSPConvergedReason why, PetscInt its,
                                  PetscReal residual) {
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(s->report.failure, sizeof(s->report.failure),
                          "the solve with prefix %s failed in step %" PetscInt_FMT
                          " at time %g: %s after %" PetscInt_FMT " iterations, residual %g; try a smaller -time_step, "
                          "more iterations (-%sksp_max_it) or finer -domain_cells",
                          prefix, s->state.step + 1, (double)(s->state.t + s->state.dt), KSPConvergedReasons[why], its,
                          (double)residual, prefix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeKineticEnergy(Scheme s, PetscReal *energy) {
  PetscReal norm;
  PetscFunctionBeginUser;
  if (s->fluid->total) {
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
