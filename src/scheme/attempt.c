/* One unsplit step, backward Euler or BDF2 (docs/steps.md, One step). */
#include "bodies/freebodies.h"
#include "scheme/coupled.h"
#include "scheme/stress.h"

#define STILL 1e-5 /* of R0: less than this is not looked at, steady shapes miss by rounding */
#define FAR 1.1    /* times as far from its extrapolation as from where it began: its motion has stopped */
#define SMOOTH 0.7 /* least gain of a predictor through three states over that through two for order 3 */
#define KEPT                                                                                                           \
  0.8 /* after a fixed step of order 3, so that orders and a0 do not alternate where the gain is about SMOOTH */

/* Vectors of the states that the step goes on from. */
#define STATES(s, which)                                                                                               \
  (const Vec[]) {                                                                                                      \
    (s)->state.which, (s)->old[0].which, (s)->old[1].which, (s)->old[2].which, (s)->old[3].which, (s)->old[4].which    \
  }

/* The unknowns of the membranes' law, extrapolated from the last two states, turn with the new edges (docs/steps.md,
   The tension turns with the membrane). next.sigma is used for them. */
static PetscErrorCode TurnEdges(Scheme s, Coupled *d) {
  History *h = &d->history;
  const PetscInt count = PetscMin(2, h->solved);
  PetscReal weight[BDF_STATES];
  PetscFunctionBeginUser;
  if (!count) PetscFunctionReturn(PETSC_SUCCESS);
  BDFExtrapolation(count, h->step, weight);
  PetscCall(HistoryEdges(h, s->membrane, count, weight, STATES(s, sigma), d->next.sigma));
  PetscCall(ForcesExpect(s->coupling->forces, s->fluid->nu, s->fluid->a0, d->next.sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The history uhat: as flows beside f, or in f where there is no body; none in quasi-steady flow. next.w is used for
   uhat. */
static PetscErrorCode Past(Scheme s, Coupled *d, const BDF *b) {
  const Vec *flow = STATES(s, flow);
  PetscFunctionBeginUser;
  d->past.count = d->next.flow && !s->fluid->steady ? b->order : 0;
  d->past.part = MobilityGridPart(s->coupling->mobility, s->fluid->alpha);
  d->past.lag = MobilityLag(s->coupling->mobility, s->fluid->alpha);
  d->past.made = d->next.flow;
  for (PetscInt j = 0; j < d->past.count; j++) {
    d->past.weight[j] = b->history[j];
    d->past.flow[j] = flow[j];
  }
  if (s->fluid->steady || d->next.flow) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HistorySum(b->order, b->history, 1, STATES(s, w), d->next.w));
  PetscCall(ForcingAdd(&d->next.forcing, d->next.w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* place = that of the state + SUM_j weight_j q_j, q_j the velocities of free bodies in the states. next.solid is used
   for the sum. */
static PetscErrorCode CarryBodies(Scheme s, Coupled *d, const PetscReal weight[], Vec place) {
  PetscFunctionBeginUser;
  PetscCall(HistorySum(d->adams.known, weight, 1, STATES(s, solid), d->next.solid));
  PetscCall(VecCopy(s->state.place, place));
  PetscCall(FreeBodiesMove(s->coupling->bodies->obstacles, d->next.solid, 1, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The loads of free bodies, less the push that has been found; in fluid with inertia, which starts without loads, with
   the history of their momentum. next.solid is used for it. */
static PetscErrorCode KnownForces(Scheme s, Coupled *d, const BDF *b) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const InnerFluid inner = s->coupling->mobility->inner;
  const PetscInt own = 3 * o->free->n, first = 3 * o->free->first;
  const PetscScalar *q;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < own; k++) d->load[k] = (inner && d->start ? 0 : o->load[first + k]) - d->load[k];
  if (!inner || d->start) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HistorySum(b->order, b->history, 1, STATES(s, solid), d->next.solid));
  PetscCall(VecGetArrayRead(d->next.solid, &q));
  for (PetscInt k = 0; k < own; k++) d->load[k] += inner->mass[first + k] * q[2 * o->layout->n + k];
  PetscCall(VecRestoreArrayRead(d->next.solid, &q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* f = uhat - N(w*), minus the known forces F at Y = Xhat + u_inf/a0, the known motion u_inf + v dY/dt of the fluid at
   membranes with the labels' speed v, less what seeps by F, and k, u_inf less the obstacles' velocity. next.w is used
   for w*. The background of markers, but not of the fluid, has the osmotic velocity. */
static PetscErrorCode RightHandSides(Scheme s, Coupled *d, const BDF *b) {
  const Obstacles obstacles = s->coupling->bodies->obstacles;
  Forcing *f = &d->next.forcing;
  PetscFunctionBeginUser;
  PetscCall(VecSet(d->known, 0));
  PetscCall(ForcingClear(f));
  PetscCall(Past(s, d, b));
  PetscCall(VecWAXPY(d->Y, 1 / b->a0, s->background, d->Xhat));
  if (d->place) { /* next.place: without the new q */
    PetscCall(CarryBodies(s, d, d->adams.history, d->next.place));
    PetscCall(PetscArrayzero(d->load, 3 * obstacles->free->n));
  }
  PetscCall(CouplingMarkers(s->coupling, d->Y, d->next.place, d->all));
  PetscCall(CouplingStepForce(s->coupling, d->all, d->Xstar, NULL, d->force, d->load));
  if (d->place) PetscCall(KnownForces(s, d, b));
  PetscCall(CouplingCopyVesicles(s->coupling, s->background, d->known));
  PetscCall(CouplingSeep(s->coupling, -1, d->Xstar, NULL, d->known));
  PetscCall(VecCopy(s->background, d->moved));
  PetscCall(CouplingSeep(s->coupling, -1, d->Xstar, d->force, d->moved));
  PetscCall(CouplingTread(s->coupling, 1, d->Y, d->moved));
  if (obstacles) PetscCall(ObstaclesTarget(obstacles, &s->scene->flow, d->known, s->report.failure));
  if (d->convection) {
    PetscCall(HistorySum(b->order, b->star, 1, STATES(s, w), d->next.w));
    PetscCall(ConvectionAdd(d->convection, -1, d->next.w, f));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solution extrapolated: sigma and V = U - (labels' speed) dX/dt - u_inf; forces on free bodies are in balance. */
static PetscErrorCode InitialGuess(Scheme s, Coupled *d) {
  State *n = &d->next;
  History *h = &d->history;
  const PetscInt count = PetscMax(1, PetscMin(h->solved, s->plan.guess));
  PetscReal weight[BDF_STATES];
  PetscScalar *F;
  PetscFunctionBeginUser;
  BDFGuess(count, h->step, weight);
  if (n->solid) PetscCall(HistorySum(count, weight, 1, STATES(s, solid), n->solid));
  if (n->place && s->fluid->steady) {
    PetscCall(VecGetArray(n->solid, &F));
    FreeBodiesBalance(s->coupling->bodies->obstacles, d->load, F);
    PetscCall(VecRestoreArray(n->solid, &F));
  }
  PetscCall(HistoryEdges(h, s->membrane, count, weight, STATES(s, sigma), n->sigma));
  PetscCall(HistorySum(count, weight, 1, h->U, d->V));
  PetscCall(VecAXPY(d->V, -1, s->background));
  PetscCall(CouplingTread(s->coupling, -1, d->Xstar, d->V));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sigma and V of the new time, and the velocity where the states have it; report.failure when the solver fails. */
static PetscErrorCode Solve(Scheme s, Coupled *d) {
  State *n = &d->next;
  const CoupledProblem problem = {.known = {.f = &n->forcing,
                                            .F = d->force,
                                            .outside = ForcesReach(s->coupling->forces) == FORCE_OUTSIDE,
                                            .G = d->moved,
                                            .past = n->flow ? &d->past : NULL},
                                  .g = s->g,
                                  .k = d->known,
                                  .sigma = n->sigma,
                                  .V = d->V,
                                  .solid = n->solid,
                                  .load = d->load,
                                  .graded = d->graded};
  SolveReport report;
  PetscFunctionBeginUser;
  n->a0 = s->fluid->a0;
  if (!CouplingHasBodies(s->coupling)) {
    PetscCall(MobilityFields(s->coupling->mobility, &n->forcing, n->w, n->p));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CoupledSolverSolve(d->solver, &problem, &report));
  s->report.coupled_its += report.its;
  s->report.measures = report.measures;
  if (PreconditionerIsNew(d->solver->preconditioner)) {
    PetscCall(VecCopy(d->Xstar, d->made_at));
    PetscCall(PetscArraycpy(d->made_with, d->history.treading, s->membrane->layout->bodies));
  }
  if (report.why < 0) PetscCall(SchemeSolverFailed(s, "coupled_", report.why, report.its, report.residual));
  if (n->flow && n->w) PetscCall(StreamFlowsVelocity(CoupledFlows(d), n->flow, n->w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* P = u_inf(X*) + V,  X = Xhat + P/a0,  U = P + (labels' speed) dX/dt; free bodies by their Adams formula. */
static PetscErrorCode MoveMarkers(Scheme s, Coupled *d, PetscReal a0) {
  State *n = &d->next;
  PetscFunctionBeginUser;
  if (n->place) PetscCall(FreeBodiesMove(s->coupling->bodies->obstacles, n->solid, d->adams.end, n->place));
  if (n->p)
    PetscCall(SchemeMeasureDivergence(s, n->w, NULL));
  else
    s->report.div_max = s->report.measures.divergence;
  if (!CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SchemeMarkerVelocity(s, d->V, n->sigma, d->P));
  PetscCall(VecWAXPY(n->X, 1 / a0, d->P, d->Xhat));
  PetscCall(VecCopy(d->P, n->U));
  PetscCall(CouplingTread(s->coupling, 1, n->X, n->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the forces of the step, which are spread at X*, and the jump do to a sheared channel. d->known is used for the
   forces. */
static PetscErrorCode MeasureStress(Scheme s, Coupled *d) {
  const Bodies bodies = s->coupling->bodies;
  const State *n = &d->next;
  const PetscScalar *solid;
  PetscScalar *F;
  PetscFunctionBeginUser;
  if (!StressApplies(s)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingMarkers(s->coupling, n->X, n->place, d->all));
  PetscCall(CouplingStepForce(s->coupling, d->all, d->Xstar, n->sigma, d->known, NULL));
  if (n->solid) {
    PetscCall(VecGetArray(d->known, &F));
    PetscCall(VecGetArrayRead(n->solid, &solid));
    PetscCall(PetscArraycpy(F + BodiesFirstObstacle(bodies), solid, BodiesObstacleNumbers(bodies)));
    PetscCall(VecRestoreArrayRead(n->solid, &solid));
    PetscCall(VecRestoreArray(d->known, &F));
  }
  PetscCall(StressMeasure(s, n->w, n->p, d->known, d->all));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The plan's order, as far as states are known; order 3 with steps that grow by no more than sqrt(2), as its limit of
   stability for steps that go on growing is 1.53. Adaptive steps do not go on growing by more; one may be twice as long
   as a step that was shortened. */
static PetscInt Order(Scheme s, const History *h) {
  const PetscReal most = s->policy.adaptive ? 2.01 : 1.42;
  const PetscBool even = h->n > 2 && h->step[0] <= most * h->step[1] ? PETSC_TRUE : PETSC_FALSE;
  return PetscMin(PetscMin(s->plan.order, h->n), even ? 3 : 2);
}

/* Largest |x - y| on this rank, of marker vectors; y is overwritten. Not a number where an entry is. */
static PetscErrorCode LargestDifference(Scheme s, Vec x, Vec y, PetscReal *largest) {
  const PetscScalar *d;
  PetscFunctionBeginUser;
  *largest = 0;
  PetscCall(VecAXPY(y, -1, x));
  PetscCall(VecGetArrayRead(y, &d));
  for (PetscInt k = 0; k < s->membrane->layout->n; k++) {
    const PetscReal off = PetscSqrtReal(PetscSqr(d[2 * k]) + PetscSqr(d[2 * k + 1]));
    *largest = off > *largest || off != off ? off : *largest;
  }
  PetscCall(VecRestoreArrayRead(y, &d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* R0 of the smallest vesicle or free body. */
static PetscReal SmallestRadius(Scheme s) {
  const Membrane m = s->membrane;
  const Obstacles o = s->coupling->bodies->obstacles;
  PetscReal R0 = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < m->layout->bodies; v++) R0 = PetscMin(R0, m->L0[v] / (2 * PETSC_PI));
  for (PetscInt b = 0; o && b < o->layout->bodies; b++)
    if (o->motion[b].free) R0 = PetscMin(R0, ObstacleRadius(o, b));
  return R0;
}

PetscErrorCode CoupledEstimate(Scheme s, PetscReal *error) {
  Coupled *d = (Coupled *)s->data;
  PetscReal found[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(VecCopy(d->Xstar, d->Y));
  PetscCall(LargestDifference(s, d->next.X, d->Y, &found[0]));
  if (d->place) FreeBodiesFarthest(s->coupling->bodies->obstacles, d->place, d->next.place, &found[0]);
  if (PetscIsNanReal(found[0])) found[1] = 1; /* a maximum may lose it */
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, found, 2, MPIU_REAL, MPI_MAX, s->membrane->layout->comm));
  *error = found[1] > 0 ? NAN : found[0] / SmallestRadius(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the extrapolation by `count` states misses on this rank, the largest: of markers and of free bodies' places, or
   (rates) of their velocities. */
static PetscErrorCode Miss(Scheme s, Coupled *d, PetscInt count, PetscBool rates, PetscReal *largest) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const History *h = &d->history;
  PetscReal star[BDF_STATES];
  PetscFunctionBeginUser;
  BDFGuess(count, h->step, star);
  PetscCall(HistorySum(count, star, 1, rates ? h->U : h->X, d->Y));
  PetscCall(LargestDifference(s, rates ? d->next.U : d->next.X, d->Y, largest));
  if (!d->place) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(HistorySum(count, star, 1, rates ? STATES(s, solid) : STATES(s, place), h->guess[rates]));
  if (rates) { /* in a time of 1 */
    PetscCall(VecAXPY(h->guess[1], -1, d->next.solid));
    PetscCall(VecCopy(d->next.place, h->guess[0]));
    PetscCall(FreeBodiesMove(o, h->guess[1], 1, h->guess[0]));
  }
  FreeBodiesFarthest(o, d->next.place, h->guess[0], largest);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Order 3 where the motion is so smooth that three states tell the next one better than two; and a guess by as
   many states as would have told this one's velocity best, of those whose velocity is known. */
static PetscErrorCode ChooseNext(Scheme s, Coupled *d) {
  const PetscInt solved = SchemeIsSmooth(s) ? d->history.solved : 0;
  StepPlan *next = &d->next_plan;
  PetscReal miss[BDF_MOST - 1 + BDF_STATES] = {0}, *of_U = miss + BDF_MOST - 1;
  PetscFunctionBeginUser;
  for (PetscInt k = 2; k <= BDF_MOST && d->history.n == BDF_MOST && s->scene->scheme.order > 2; k++)
    PetscCall(Miss(s, d, k, PETSC_FALSE, &miss[k - 2]));
  for (PetscInt k = 1; k <= solved; k++) PetscCall(Miss(s, d, k, PETSC_TRUE, &of_U[k - 1]));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, miss, BDF_MOST - 1 + BDF_STATES, MPIU_REAL, MPI_MAX, s->membrane->layout->comm));
  const PetscReal gain = d->order == 3 && !s->policy.adaptive ? KEPT : SMOOTH;
  next->order = miss[1] < gain * miss[0] ? 3 : PetscMin(s->scene->scheme.order, 2);
  next->guess = solved ? 1 : 2;
  for (PetscInt k = 2; k <= solved; k++)
    if (of_U[k - 1] < of_U[next->guess - 1]) next->guess = k;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledAttempt(Scheme s, PetscReal dt) {
  Coupled *d = (Coupled *)s->data;
  const char *failure = s->report.failure;
  History *h = &d->history;
  PetscFunctionBeginUser;
  s->state.dt = dt;
  PetscCall(HistoryCarry(h, s, dt));
  const BDF b = BDFCoefficients(d->order = Order(s, h), h->step);
  PetscCall(HistorySum(b.order, b.star, 1, h->X, d->Xstar));
  PetscCall(HistorySum(b.order, b.history, 1 / b.a0, h->X, d->Xhat));
  d->adams = AdamsCoefficients(s->plan.order > 1 ? b.order : 0, h->step);
  if (d->place) PetscCall(CarryBodies(s, d, d->adams.star, d->place));
  const Instant end = {s->state.t + d->done + dt, d->place, d->adams.end};
  PetscCall(SchemePlace(s, b.a0, d->Xstar, h->treading, end));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscReal aim = d->start ? 0 : b.a0; /* at edges and areas: the first ones have them */
  if (s->membrane->viscous) {
    PetscCall(VecSet(d->P, 0));
    PetscCall(CouplingTread(s->coupling, 1, d->Xstar, d->P));
  }
  if (s->scene->scheme.length_target)
    PetscCall(LawTarget(s->coupling->law, aim, d->Xhat, s->membrane->viscous ? d->P : NULL, s->g));
  if (LawAimsAreas(s->coupling->law))
    PetscCall(LawTargetAreas(s->coupling->law, aim, d->Xstar, d->Xhat, s->background));
  PetscCall(TurnEdges(s, d));
  PetscCall(RightHandSides(s, d, &b));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(InitialGuess(s, d));
  PetscCall(Solve(s, d));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MoveMarkers(s, d, b.a0));
  if (d->place) PetscCall(SchemeCheckBodies(s, (Instant){.t = end.t, .place = d->next.place}));
  if (*failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MeasureStress(s, d));
  if (d->place) PetscCall(FreeBodiesTurn(s->coupling->bodies->obstacles, d->next.place, d->next.solid));
  PetscCall(ChooseNext(s, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the attempt has ended FAR times as far from its extrapolation X* as from the state it began with: a motion
   that stops within the step, which an extrapolation only carries on. */
static PetscErrorCode Overshot(Scheme s, Coupled *d, PetscBool *overshot) {
  PetscReal began, error;
  PetscFunctionBeginUser;
  *overshot = PETSC_FALSE;
  if (d->order == 1) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Miss(s, d, 1, PETSC_FALSE, &began));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &began, 1, MPIU_REAL, MPI_MAX, s->membrane->layout->comm));
  PetscCall(CoupledEstimate(s, &error));
  *overshot = error > FAR * began / SmallestRadius(s) && error > STILL ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledFixedAttempt(Scheme s, PetscReal dt) {
  Coupled *d = (Coupled *)s->data;
  PetscBool overshot;
  PetscFunctionBeginUser;
  PetscCall(CoupledAttempt(s, dt));
  if (*s->report.failure || !CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Overshot(s, d, &overshot));
  if (!overshot) PetscFunctionReturn(PETSC_SUCCESS);
  s->plan.order = 1; /* of this step: CoupledAdvance says the next one's */
  PetscCall(CoupledAttempt(s, dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}
