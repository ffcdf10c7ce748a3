#include "space/space.h"
#include "base/agree.h"

#define SMALLEST 1e-6 /* of the first step: smaller ones, which follow a lost shape, end the run */
#define LOST 0.1      /* error of the area or the volume, over it, from which on a shape is lost */
#define STILL 1e-6    /* of a step: in which shapes stay, for the first velocities and tensions */
#define SMOOTH 0.7    /* least gain of a prediction by three states over that by two for order 3 */
#define PARTS 7       /* of the first step: dt/64, dt/64, dt/32, .., dt/2 */

/* Numbers of a state. */
static PetscInt SpaceStateSize(Space s) {
  return s->share.own * (2 * s->size + s->count);
}

static PetscErrorCode SpaceStateCreate(Space s, SpaceState *q) {
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(SpaceStateSize(s), &q->X));
  q->U = q->X + s->share.own * s->size;
  q->sigma = q->U + s->share.own * s->size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceCreate(MPI_Comm comm, const SpaceSetting *setting, PetscInt vesicles,
                           const Vesicle3Setting material[], const PetscReal X[], Space *out) {
  Space s;
  PetscMPIInt rank, ranks;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &ranks));
  const PetscInt first = vesicles * rank / ranks;
  s->share = (VesicleShare){
      .comm = comm, .vesicles = vesicles, .first = first, .own = vesicles * (rank + 1) / ranks - first};
  s->setting = *setting;
  PetscCall(SphereCreate(setting->p, setting->symmetry, &s->sphere));
  s->count = s->sphere->count;
  s->size = s->sphere->size;
  for (PetscInt v = 0; v < vesicles; v++) s->contrast = (PetscBool)(s->contrast || material[v].ratio != 1);
  s->unknowns = s->size + s->count + (vesicles > 1 && s->contrast ? s->size : 0);
  PetscCall(PetscCalloc1(s->share.own, &s->vesicle));
  PetscCall(SpaceStateCreate(s, &s->state));
  for (PetscInt v = 0; v < s->share.own; v++) {
    SphereFold(s->sphere, X + (first + v) * 3 * HarmonicsCount(setting->p), s->state.X + v * s->size);
    PetscCall(Vesicle3Create(s->sphere, &material[first + v], s->state.X + v * s->size, &s->vesicle[v]));
  }
  PetscCall(SpaceStateCreate(s, &s->start));
  PetscCall(SpaceStateCreate(s, &s->work.star));
  for (int j = 0; j < BDF_MOST - 1; j++) PetscCall(SpaceStateCreate(s, &s->old[j]));
  const PetscInt n = s->share.own * s->size;
  PetscCall(PetscMalloc6(n, &s->work.Xhat, n, &s->work.Y, n, &s->work.background, n, &s->work.F, n, &s->work.V, n,
                         &s->work.U));
  s->order = PetscMin(setting->order, 2);
  s->plan.level = StepFirstLevel();
  if (vesicles > 1)
    PetscCall(CrossLayerCreate(s->sphere, s->share, material[0].nu, setting->repulsion, s->contrast ? NEAR_KERNELS : 1,
                               &s->cross));
  s->tube.left = 1;
  if (setting->tube.radius > 0) PetscCall(TubeCreate(&setting->tube, material[0].nu, &s->tube.tube));
  if (setting->throat.radius > 0) PetscCall(ThroatCreate(&setting->throat, s->tube.tube, &s->tube.throat));
  if (setting->throat.radius > 0) PetscCall(PetscCalloc1(n, &s->tube.flow));
  PetscCall(SpaceSolverCreate(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceDestroy(Space *space) {
  Space s = *space;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpaceSolverDestroy(s));
  PetscCall(CrossLayerDestroy(&s->cross));
  PetscCall(TubeDestroy(&s->tube.tube));
  PetscCall(ThroatDestroy(&s->tube.throat));
  PetscCall(PetscFree2(s->tube.wall, s->tube.traction));
  PetscCall(PetscFree(s->tube.flow));
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(Vesicle3Destroy(&s->vesicle[v]));
  PetscCall(PetscFree(s->vesicle));
  PetscCall(PetscFree(s->state.X));
  PetscCall(PetscFree(s->start.X));
  PetscCall(PetscFree(s->work.star.X));
  for (int j = 0; j < BDF_MOST - 1; j++) PetscCall(PetscFree(s->old[j].X));
  PetscCall(PetscFree6(s->work.Xhat, s->work.Y, s->work.background, s->work.F, s->work.V, s->work.U));
  PetscCall(SphereDestroy(&s->sphere));
  PetscCall(PetscFree(*space));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The steps that led to the states, the one to be made first. */
static void SpaceStepsBefore(Space s, PetscReal dt, PetscReal step[BDF_STATES]) {
  (void)PetscArrayzero(step, BDF_STATES);
  step[0] = dt;
  step[1] = s->state.dt_last;
  for (int j = 1; j < BDF_MOST; j++) step[j + 1] = s->old[j - 1].dt_last;
}

/* The formula of the next step, of the plan's order as far as states are known. */
static BDF SpaceFormula(Space s, PetscReal dt) {
  PetscReal step[BDF_STATES];
  SpaceStepsBefore(s, dt, step);
  return BDFCoefficients(PetscMin(s->order, s->past + 1), step);
}

/* Order 3 after a step of size dt that has led to Y, where three states would have told Y better than two. */
static PetscErrorCode SpaceChooseOrder(Space s, PetscReal dt) {
  const PetscReal *X[BDF_MOST] = {s->state.X, s->old[0].X, s->old[1].X};
  PetscReal step[BDF_STATES], star[BDF_STATES], miss[2] = {0, 0};
  PetscFunctionBeginUser;
  s->order = PetscMin(s->setting.order, 2);
  if (s->setting.order < 3 || s->past < BDF_MOST - 1) PetscFunctionReturn(PETSC_SUCCESS);
  SpaceStepsBefore(s, dt, step);
  for (int q = 0; q < 2; q++) {
    BDFExtrapolation(2 + q, step, star);
    for (PetscInt k = 0; k < s->share.own * s->size; k++) {
      PetscReal off = s->work.Y[k];
      for (int j = 0; j < 2 + q; j++) off -= star[j] * X[j][k];
      miss[q] += off * off;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, miss, 2, MPIU_REAL, MPI_SUM, s->share.comm));
  if (miss[1] < PetscSqr(SMOOTH) * miss[0]) s->order = 3;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The extrapolated state, and Xhat. */
static void SpaceExtrapolate(Space s, const BDF *b) {
  const PetscReal *X[BDF_MOST] = {s->state.X};
  for (int j = 1; j < BDF_MOST; j++) X[j] = s->old[j - 1].X;
  (void)PetscArrayzero(s->work.star.X, SpaceStateSize(s));
  (void)PetscArrayzero(s->work.Xhat, s->share.own * s->size);
  for (PetscInt j = 0; j < b->order; j++) {
    for (PetscInt k = 0; k < SpaceStateSize(s); k++) s->work.star.X[k] += b->star[j] * X[j][k];
    for (PetscInt k = 0; k < s->share.own * s->size; k++) s->work.Xhat[k] += b->history[j] / b->a0 * X[j][k];
  }
}

PetscErrorCode SpaceFailWhere(Space s, PetscBool bad, const char why[]) {
  PetscBool any;
  PetscFunctionBeginUser;
  PetscCall(AgreeFlag(s->share.comm, bad, &any));
  if (any) PetscCall(PetscStrncpy(s->report.failure, why, PETVES_MAX_MESSAGE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpacePlace(Space s, const PetscReal X[], const PetscReal sigma[]) {
  PetscBool singular = PETSC_FALSE;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(Vesicle3Place(s->vesicle[v], X + v * s->size, sigma + v * s->count));
  if (s->tube.tube) PetscCall(SpacePlaceTube(s, X));
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscBool done;
    PetscCall(Vesicle3Factor(s->vesicle[v], &done));
    if (!done) singular = PETSC_TRUE;
  }
  PetscCall(SpaceFailWhere(s, singular, "the double layer of a vesicle is singular"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* K^-1 u_inf at time t of the vesicles where they have been placed. */
static PetscErrorCode SpaceFindBackground(Space s, PetscReal t) {
  PetscBool lost = PETSC_FALSE;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) {
    const Surface at = s->vesicle[v]->at;
    PetscReal *u, *background = s->work.background + v * s->size;
    PetscCall(PetscMalloc1(3 * at->n, &u));
    PetscCall(s->setting.flow(s->setting.context, t, at->n, at->D[HARMONIC], u));
    PetscCall(SphereFieldProject(&s->sphere->fine, u, background));
    PetscCall(PetscFree(u));
    for (PetscInt k = 0; k < s->size; k++) {
      if (PetscIsInfOrNanReal(background[k])) lost = PETSC_TRUE;
      if (s->tube.throat) background[k] += s->setting.tube.mean * s->tube.flow[v * s->size + k];
    }
    PetscCall(Vesicle3Velocity(s->vesicle[v], 1, background));
  }
  PetscCall(SpaceFailWhere(s, lost, "the background flow is not finite"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything at X* for a step that ends at time t. */
static PetscErrorCode SpacePrepare(Space s, const BDF *b, PetscReal t) {
  PetscFunctionBeginUser;
  SpaceExtrapolate(s, b);
  if (s->cross) PetscCall(CrossLayerPlace(s->cross, s->work.star.X));
  if (s->cross && s->cross->gap <= 0)
    PetscCall(PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE,
                            "vesicles %" PetscInt_FMT " and %" PetscInt_FMT " overlap by %g", s->cross->nearest[0] + 1,
                            s->cross->nearest[1] + 1, (double)-s->cross->gap));
  if (!*s->report.failure) PetscCall(SpacePlace(s, s->work.star.X, s->state.sigma));
  if (!*s->report.failure) PetscCall(SpaceFindBackground(s, t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Known forces of repulsion: those at X*, and those of the way from there to Xhat. */
static PetscErrorCode SpaceAddContact(Space s) {
  PetscReal *change = s->work.V, *G = s->work.F;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->share.own * s->size; k++) {
    change[k] = s->work.Xhat[k] - s->work.star.X[k];
    G[k] = 0;
  }
  PetscCall(CrossLayerAddContact(s->cross, PETSC_TRUE, change, G));
  for (PetscInt k = 0; k < s->share.own * s->size; k++) s->vesicle[k / s->size]->known[k % s->size] += G[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* That the shapes Y have about the areas and volumes that they keep, which a lost shape has not. */
static PetscErrorCode SpaceCheckShapes(Space s) {
  PetscReal off = 0;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) {
    const Vesicle3 vesicle = s->vesicle[v];
    PetscCall(SurfacePlace(vesicle->at, s->work.Y + v * s->size, PETSC_FALSE));
    off = PetscMax(off, PetscAbsReal(vesicle->at->area / vesicle->area - 1));
    off = PetscMax(off, PetscAbsReal(vesicle->at->volume / vesicle->volume - 1));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &off, 1, MPIU_REAL, MPI_MAX, s->share.comm));
  if (off > LOST)
    PetscCall(
        PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE, "a vesicle's area or volume is off by %.2g", (double)off));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A step of size dt as far as Y, V and x; the state is as it was. */
static PetscErrorCode SpaceAttempt(Space s, PetscReal dt) {
  const BDF b = SpaceFormula(s, dt);
  PetscReal moved;
  PetscFunctionBeginUser;
  PetscCall(SpacePrepare(s, &b, s->state.t + dt));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpaceGuess(s, b.a0));
  PetscCall(PetscArraycpy(s->work.Y, s->work.star.X, s->share.own * s->size));
  for (PetscInt pass = 0; pass < s->setting.newton && !*s->report.failure; pass++) {
    for (PetscInt v = 0; v < s->share.own; v++) {
      const PetscInt at = v * s->size;
      PetscCall(Vesicle3Linearise(s->vesicle[v], b.a0, s->work.Xhat + at, s->work.star.X + at, s->work.Y + at));
    }
    if (s->cross) PetscCall(SpaceAddContact(s));
    PetscCall(SpaceSolve(s, b.a0, pass));
    if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
    PetscCall(SpaceIterate(s, b.a0, &moved));
    s->report.estimate = pass ? s->report.estimate : moved;
  }
  if (PetscIsInfOrNanReal(moved))
    PetscCall(PetscStrncpy(s->report.failure, "the shape is not finite", PETVES_MAX_MESSAGE));
  else
    PetscCall(SpaceCheckShapes(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U and sigma of the attempt become the state's. */
static PetscErrorCode SpaceTakeSolution(Space s) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(s->state.U, s->work.V, s->share.own * s->size));
  PetscCall(VecGetArrayRead(s->x, &x));
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(PetscArraycpy(s->state.sigma + v * s->count, x + v * s->unknowns + s->size, s->count));
  PetscCall(VecRestoreArrayRead(s->x, &x));
  s->state.solved = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The attempt becomes the state. */
static PetscErrorCode SpaceAccept(Space s, PetscReal dt, PetscReal t) {
  const SpaceState last = s->old[BDF_MOST - 2];
  PetscFunctionBeginUser;
  PetscCall(SpaceChooseOrder(s, dt));
  for (int j = BDF_MOST - 2; j > 0; j--) s->old[j] = s->old[j - 1];
  s->old[0] = s->state;
  s->state = last; /* its arrays */
  s->state.t = t;
  s->state.dt_last = dt;
  s->state.step = s->old[0].step;
  s->past = PetscMin(s->past + 1, BDF_MOST - 1);
  PetscCall(PetscArraycpy(s->state.X, s->work.Y, s->share.own * s->size));
  PetscCall(SpaceTakeSolution(s));
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(Vesicle3KeepVolume(s->vesicle[v], s->state.X + v * s->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceStart(Space s) {
  PetscFunctionBeginUser;
  if (s->state.step || s->state.solved) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PhaseBegin(PHASE_STEP));
  PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  PetscCall(SpaceAttempt(s, STILL * s->setting.policy.base));
  if (!*s->report.failure) PetscCall(SpaceTakeSolution(s));
  s->age = AgeNone(); /* factors of so small a step serve no other */
  s->made.a0 = 0;
  PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SpaceStateCopy(Space s, const SpaceState *from, SpaceState *to) {
  const SpaceState room = *to;
  PetscFunctionBeginUser;
  *to = *from;
  to->X = room.X;
  to->U = room.U;
  to->sigma = room.sigma;
  PetscCall(PetscArraycpy(to->X, from->X, SpaceStateSize(s)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A fixed step, in parts where it is the first. */
static PetscErrorCode SpaceStepInParts(Space s, PetscReal until) {
  const PetscInt parts = s->state.step ? 1 : PARTS;
  const PetscReal t = s->state.t, dt = StepFixed(&s->setting.policy, t, until),
                  end = StepTime(&s->setting.policy, t, dt, until);
  PetscReal done = 0;
  PetscFunctionBeginUser;
  s->report.dt = dt;
  if (parts > 1) PetscCall(SpaceStateCopy(s, &s->state, &s->start));
  for (PetscInt part = 0; part < parts; part++) {
    const PetscReal share = parts == 1 ? dt : dt / (PetscReal)(1 << (part ? parts - part : parts - 1));
    PetscCall(SpaceAttempt(s, share));
    if (*s->report.failure && part) {
      PetscCall(SpaceStateCopy(s, &s->start, &s->state));
      s->past = 0;
    }
    if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
    done += share;
    PetscCall(SpaceAccept(s, share, part == parts - 1 ? end : t + done));
  }
  s->state.step++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Attempts of smaller and smaller steps, until one is accepted or none is left. */
static PetscErrorCode SpaceStepJudged(Space s, PetscReal until) {
  const StepPolicy *policy = &s->setting.policy;
  const PetscReal t = s->state.t;
  const PetscInt order = PetscMin(s->order, s->past + 1);
  StepVerdict verdict = STEP_REPEAT;
  PetscFunctionBeginUser;
  s->plan.before = PETSC_MAX_REAL;
  while (verdict == STEP_REPEAT) {
    const PetscReal dt = StepSize(policy, &s->plan, s->state.dt_last, PETSC_MAX_REAL, until - t);
    s->report.dt = dt;
    *s->report.failure = 0;
    if (dt < SMALLEST * policy->base && dt < 0.5 * (until - t)) {
      PetscCall(PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE, "steps have come down to %.1g", (double)dt));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(SpaceAttempt(s, dt));
    const StepTrial trial = {.solved = (PetscBool) !*s->report.failure,
                             .first = (PetscBool)!s->past,
                             .order = order,
                             .dt = dt,
                             .error = s->report.estimate,
                             .ratio = 1};
    verdict = StepJudge(policy, &trial, &s->plan);
    if (verdict != STEP_ACCEPT) continue;
    PetscCall(SpaceAccept(s, dt, StepTime(policy, t, dt, until)));
    s->state.step++;
  }
  if (verdict == STEP_GIVE_UP && !*s->report.failure)
    PetscCall(PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE, "the error estimate stays at %g",
                            (double)s->report.estimate));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceStep(Space s, PetscReal until) {
  const PetscReal t = s->state.t;
  PetscLogDouble start, end;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&start));
  PetscCall(PhaseBegin(PHASE_STEP));
  PetscCall(PetscMemzero(&s->report, sizeof(s->report)));
  if (s->setting.policy.adaptive)
    PetscCall(SpaceStepJudged(s, until));
  else
    PetscCall(SpaceStepInParts(s, until));
  if (*s->report.failure) {
    const size_t used = strlen(s->report.failure);
    PetscCall(PetscSNPrintf(s->report.failure + used, PETVES_MAX_MESSAGE - used,
                            " in step %" PetscInt_FMT " at time %g; try %s%s", s->state.step + 1, (double)t,
                            s->setting.policy.adaptive ? "" : "a smaller -time_step, -time_adapt error or ",
                            s->setting.newton > 1 ? "a higher -sphere_degree" : "-bending_newton 2"));
  }
  PetscCall(PhaseEnd());
  PetscCall(PetscTime(&end));
  s->report.seconds = end - start;
  PetscFunctionReturn(PETSC_SUCCESS);
}
