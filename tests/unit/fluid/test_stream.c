/* The velocity by the stream function is the one that obeys the equations, in channels, periodic boxes and boxes with
   four walls, steady or not, with a flux or without; on every number of ranks. So are flows, and the force that flows
   are. */
#include "facts.h"
#include "fluid/stokes/stokes.h"

#define TOLERANCE 1e-11

typedef struct {
  Grid grid;
  const PetscScalar *force;
  Rows u;
  PetscScalar *velocity;
} Arrays;

static const PetscScalar *StreamForce(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const Arrays *a = (const Arrays *)ctx;
  return f == FIELD_U ? RowAt(&a->u, j) : a->force + GridRowStart(a->grid, f, j);
}

static void Velocity(void *ctx, Field f, PetscInt j, PetscScalar row[]) {
  Arrays *a = (Arrays *)ctx;
  (void)PetscArraycpy(a->velocity + GridRowStart(a->grid, f, j), row, a->grid->columns[f]);
}

/* u of the force r by rows, of states before and into a flow as `rows` says. */
static void SolveRows(Fluid fluid, Stokes stokes, StreamRows rows, Vec r, Vec u, StreamMeasures *measures) {
  Arrays a = {.grid = fluid->grid};
  rows.ctx = &a;
  rows.force = StreamForce;
  rows.velocity = Velocity;
  a.force = TestArray(r);
  a.velocity = TestArray(u);
  TestCall(GridRows(fluid->grid, FIELD_U, a.force, &a.u));
  TestCall(StreamSolve(StokesStream(stokes), &rows, measures));
}

/* A box and vectors on its grid: a force, the Stokes solve's velocity and pressure, the velocity by rows, the weighted
   sum of those before it, and what is shown of both. */
typedef struct {
  TestWorld box;
  Fluid fluid;
  Stokes stokes;
  Vec r, p, exact, u, uhat, shown;
} Box;

static void BoxCreate(const char options[], Box *b) {
  TestWorldCreate(&b->box, "%s -vesicle_shape none -fluid_viscosity 0.7", options);
  b->fluid = b->box.fluid;
  b->stokes = TestWorldStokes(&b->box);
  TestFieldVecs(b->fluid->grid->velocity, &b->r, &b->exact, &b->u, &b->uhat, &b->shown, NULL);
  TestFieldVecs(b->fluid->grid->da[FIELD_P], &b->p, NULL);
}

/* The local rows of the rows first .. end - 1 of all. */
static void OwnRows(Grid g, PetscInt first, PetscInt end, PetscInt window[2]) {
  window[0] = PetscMin(PetscMax(first - g->first, 0), g->rows[FIELD_U]);
  window[1] = PetscMax(window[0], PetscMin(end - g->first, g->rows[FIELD_U]));
}

/* Velocities of both fields outside local rows window[0] .. window[1] - 1 become zero. */
static void Keep(Grid g, const PetscInt window[2], Vec w) {
  PetscScalar *a = TestArray(w);
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      if (j < window[0] || j >= window[1]) TestCall(PetscArrayzero(a + GridRowStart(g, (Field)f, j), g->columns[f]));
}

/* SUM over columns of the first (sign = 1) and of the last row of all, times `sign`. */
static PetscReal Ends(Grid g, Field f, Vec x, PetscReal sign) {
  PetscReal sum = 0;
  const PetscScalar *a = TestArray(x);
  for (PetscInt i = 0; i < g->columns[f]; i++) {
    if (!g->first) sum += a[i];
    if (g->rank == g->size - 1) sum += sign * a[(g->rows[f] - 1) * g->columns[f] + i];
  }
  TestSum(1, &sum);
  return sum;
}

/* What was measured is what the Stokes solve's velocity and pressure have. */
static void CheckMeasures(Box *b, PetscBool squares, const StreamMeasures *m) {
  const Grid g = b->fluid->grid;
  const PetscReal norm = TestNorm(NORM_2, b->exact), cells = (PetscReal)g->n[0] * g->n[1];
  const PetscReal slip = g->wall[0] ? 0 : Ends(g, FIELD_U, b->exact, -1); /* not measured between four walls */
  if (squares) CheckBelow(m->square / (norm * norm) - 1, TOLERANCE, "squares");
  CheckBelow(m->divergence * g->h / norm, TOLERANCE, "divergence");
  CheckBelow((m->slip * g->n[0] - slip) / norm, 10 * TOLERANCE, "slip %g", m->slip);
  if (!g->wall[1]) return;
  const PetscReal pressure = 0.5 * Ends(g, FIELD_P, b->p, 1) / g->n[0] - TestTotal(b->p) / cells;
  CheckBelow((m->pressure - pressure) / TestNorm(NORM_INFINITY, b->p), TOLERANCE, "pressure %g", pressure);
}

/* The velocity and the pressure of the force b->r, by the equations that they obey (test_stokes_solve.c). */
static void SolveExactly(Box *b) {
  TestCall(StokesSolve(b->stokes, b->r, NULL, b->exact, b->p));
}

/* Forces and wanted velocities between two rows of all, first and end. */
static void CheckRows(Box *b, PetscInt first, PetscInt end) {
  const Grid g = b->fluid->grid;
  const PetscInt before = FluidCountSolves(b->fluid);
  StreamRows rows = {0};
  StreamMeasures measures;
  OwnRows(g, first, end, rows.forced);
  OwnRows(g, first, end, rows.wanted);
  TestRandomVec(3, b->r);
  Keep(g, rows.forced, b->r);
  SolveExactly(b);
  TestCall(VecSet(b->u, 0));
  SolveRows(b->fluid, b->stokes, rows, b->r, b->u, NULL);
  CHECK(FluidCountSolves(b->fluid) == before + 3, "counted as one scalar solve");
  SolveRows(b->fluid, b->stokes, rows, b->r, b->u, &measures);
  CheckMeasures(b, PETSC_TRUE, &measures);
  const PetscReal norm = TestNorm(NORM_2, b->exact);
  Keep(g, rows.wanted, b->exact);
  TestCall(VecAXPY(b->u, -1, b->exact));
  CheckBelow(TestNorm(NORM_2, b->u) / norm, TOLERANCE, "rows %d to %d: the Stokes solve's velocity", (int)first,
             (int)end);
}

/* The flow that a solve makes has its velocity and its squares, and the pressure follows from it; b->u is the velocity
   of a random force. */
static void CheckFlow(Box *b, PetscInt seed, Vec flow) {
  const Grid g = b->fluid->grid;
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  const StreamRows rows = {.forced = {0, g->rows[FIELD_U]}, .wanted = {0, g->rows[FIELD_U]}, .flow = flow};
  PetscReal square;
  StreamMeasures measures;
  Vec p;
  TestVecs(b->p, &p, NULL);
  TestRandomVec(seed, b->r);
  SolveExactly(b);
  SolveRows(b->fluid, b->stokes, rows, b->r, b->u, &measures);
  CheckMeasures(b, PETSC_FALSE, &measures);
  TestCall(StreamFlowsVelocity(flows, flow, b->u));
  CheckBelow(TestApart(NORM_2, b->u, b->exact), TOLERANCE, "a flow's velocity");
  TestCall(StreamFlowsVelocity(flows, flow, b->u));
  TestCall(StreamFlowsSquare(flows, flow, &square));
  CheckBelow(square / PetscSqr(TestNorm(NORM_2, b->u)) - 1, TOLERANCE, "squares of a flow");
  TestCall(StokesPressure(b->stokes, b->r, b->u, p));
  CheckBelow(TestApart(NORM_2, p, b->p), 10 * TOLERANCE, "the pressure of a flow");
}

/* Three random flows, and uhat = SUM weight_j u_j. */
static void MakePast(Box *b, StreamPast *past) {
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  *past = (StreamPast){.count = 3, .weight = {2, -.7, .3}, .part = .4, .lag = .15};
  TestCall(VecSet(b->uhat, 0));
  for (PetscInt k = 0; k < past->count; k++) {
    TestCall(StreamFlowsCreateVec(flows, &past->flow[k]));
    CheckFlow(b, 7 + k, past->flow[k]);
    TestCall(StreamFlowsVelocity(flows, past->flow[k], b->u));
    TestCall(VecAXPY(b->uhat, past->weight[k], b->u));
  }
}

/* A random force in the wanted rows is added to r, and its velocity to the flow. */
static void CheckAdded(Box *b, StreamRows rows) {
  Vec more;
  TestVecs(b->r, &more, NULL);
  TestRandomVec(5, more);
  Keep(b->fluid->grid, rows.wanted, more);
  TestCall(VecAXPY(b->r, 1, more));
  rows.past = NULL;
  rows.add = PETSC_TRUE;
  SolveRows(b->fluid, b->stokes, rows, more, b->u, NULL);
  SolveExactly(b);
  TestCall(StreamFlowsVelocity(StokesStream(b->stokes)->flows, rows.flow, b->u));
  CheckBelow(TestApart(NORM_2, b->u, b->exact), TOLERANCE, "velocity with what is added");
}

/* Flows are a force beside another one, which is in some rows only, and some of them is shown with the velocity; what
   is added to such a flow is added to the velocity. */
static void CheckPast(Box *b, const StreamPast *past, PetscInt first, PetscInt end) {
  const Grid g = b->fluid->grid;
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  StreamRows these = {.past = past};
  StreamMeasures measures;
  OwnRows(g, first, end, these.forced);
  OwnRows(g, first, end, these.wanted);
  TestCall(StreamFlowsCreateVec(flows, &these.flow));
  TestRandomVec(3, b->r);
  Keep(g, these.wanted, b->r);
  TestCall(VecSet(b->u, 0));
  SolveRows(b->fluid, b->stokes, these, b->r, b->u, &measures);
  CheckBelow(measures.past / PetscSqr(TestNorm(NORM_2, b->uhat)) - 1, TOLERANCE, "squares of the past");
  TestCall(VecAXPY(b->r, 1, b->uhat));
  SolveExactly(b);
  TestCall(VecCopy(b->exact, b->shown));
  TestCall(VecAXPBY(b->shown, past->lag, past->part, b->uhat));
  Keep(g, these.wanted, b->shown);
  CheckBelow(TestApart(NORM_2, b->u, b->shown), TOLERANCE, "velocity with some of the past");
  TestCall(StreamFlowsVelocity(flows, these.flow, b->u));
  CheckBelow(TestApart(NORM_2, b->u, b->exact), TOLERANCE, "velocity of the past's force and another");
  CheckAdded(b, these);
  TestCall(VecDestroy(&these.flow));
}

static void CheckBox(const char options[]) {
  static const PetscReal coefficients[] = {128, 0.75, 128};
  StreamPast past;
  Box b;
  BoxCreate(options, &b);
  const PetscInt n = b.fluid->grid->n[1];
  /* There and back: nothing of an earlier a0 may stay. Quasi-steady flow has none. */
  for (int k = 0; k < (b.fluid->alpha > 0 ? 3 : 1); k++) {
    TestCall(FluidSetTimeCoefficient(b.fluid, coefficients[k]));
    TestAbout("%s, alpha = %g", options, b.fluid->alpha);
    CheckRows(&b, 0, n);
    CheckRows(&b, n / 3, n / 2);
    MakePast(&b, &past);
    CheckPast(&b, &past, n / 3, n / 2);
    CheckPast(&b, &past, 0, n);
    for (PetscInt j = 0; j < past.count; j++) TestCall(VecDestroy(&past.flow[j]));
  }
  TestWorldDestroy(&b.box);
}

void Facts(void) {
  static const char *const grids[] = {SQUARE,
                                      OBLONG,
                                      "-domain_box 0,3,0,1.0540540540540540 -domain_cells 74,26",
                                      "-domain_box 0,1,0,2.24 -domain_cells 25,56",
                                      "-domain_box 0,1,0,1.875 -domain_cells 8,15",
                                      "-domain_box 0,1,0,4 -domain_cells 32,128",
                                      "-domain_box 0,1,0,1 -domain_cells 128,128"};
  static const char *const kinds[] = {PERIODIC "-fluid_inertia unsteady",
                                      PERIODIC "-fluid_inertia none",
                                      CHANNEL "-fluid_inertia unsteady",
                                      CHANNEL "-fluid_inertia none",
                                      CHANNEL "-fluid_inertia none -flow_drive flux",
                                      "-fluid_inertia unsteady",
                                      "-fluid_inertia none"};
  for (int k = 0; k < 49; k++) CheckBox(TestText("%s %s", grids[k / 7], kinds[k % 7]));
}
