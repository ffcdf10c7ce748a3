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
static PetscErrorCode SolveRows(Fluid fluid, Stokes stokes, StreamRows rows, Vec r, Vec u, StreamMeasures *measures) {
  Arrays a = {.grid = fluid->grid};
  PetscFunctionBeginUser;
  rows.ctx = &a;
  rows.force = StreamForce;
  rows.velocity = Velocity;
  PetscCall(VecGetArrayRead(r, &a.force));
  PetscCall(VecGetArray(u, &a.velocity));
  PetscCall(GridRows(fluid->grid, FIELD_U, a.force, &a.u));
  PetscCall(StreamSolve(StokesStream(stokes), &rows, measures));
  PetscCall(VecRestoreArray(u, &a.velocity));
  PetscCall(VecRestoreArrayRead(r, &a.force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A box and vectors on its grid: a force, the Stokes solve's velocity and pressure, and the velocity by rows. */
typedef struct {
  const char *options;
  TestBox box;
  Fluid fluid;
  Stokes stokes;
  Vec r, p, exact, u;
} Box;

static PetscErrorCode BoxCreate(const char options[], Box *b) {
  PetscFunctionBeginUser;
  PetscCall(TestBoxCreate(options, &b->box));
  b->options = options;
  b->fluid = b->box.fluid;
  b->stokes = b->box.stokes;
  PetscCall(TestFieldVecs(b->fluid->grid->velocity, &b->r, &b->exact, &b->u, NULL));
  PetscCall(TestFieldVecs(b->fluid->grid->da[FIELD_P], &b->p, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The local rows of the rows first .. end - 1 of all. */
static void OwnRows(Grid g, PetscInt first, PetscInt end, PetscInt window[2]) {
  window[0] = PetscMin(PetscMax(first - g->first, 0), g->rows[FIELD_U]);
  window[1] = PetscMax(window[0], PetscMin(end - g->first, g->rows[FIELD_U]));
}

/* Velocities of both fields outside local rows window[0] .. window[1] - 1 become zero. */
static PetscErrorCode Keep(Grid g, const PetscInt window[2], Vec w) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a));
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      if (j < window[0] || j >= window[1]) PetscCall(PetscArrayzero(a + GridRowStart(g, (Field)f, j), g->columns[f]));
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SUM over columns of the first (sign = 1) and of the last row of all, times `sign`. */
static PetscErrorCode Ends(Grid g, Field f, Vec x, PetscReal sign, PetscReal *sum) {
  const PetscScalar *a;
  PetscFunctionBeginUser;
  *sum = 0;
  PetscCall(VecGetArrayRead(x, &a));
  for (PetscInt i = 0; i < g->columns[f]; i++) {
    if (!g->first) *sum += a[i];
    if (g->rank == g->size - 1) *sum += sign * a[(g->rows[f] - 1) * g->columns[f] + i];
  }
  PetscCall(VecRestoreArrayRead(x, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 1, MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What was measured is what the Stokes solve's velocity and pressure have. */
static PetscErrorCode CheckMeasures(Box *b, PetscBool squares, const StreamMeasures *m) {
  const Grid g = b->fluid->grid;
  PetscReal norm, slip, pressure, largest;
  PetscScalar all;
  PetscFunctionBeginUser;
  PetscCall(VecNorm(b->exact, NORM_2, &norm));
  if (squares)
    CHECK(PetscAbsReal(m->square - norm * norm) < TOLERANCE * norm * norm, "%s: squares %.15g for %.15g", b->options,
          (double)m->square, (double)(norm * norm));
  CHECK(m->divergence < TOLERANCE * norm / g->h, "%s: divergence %.1e", b->options, (double)m->divergence);
  PetscCall(Ends(g, FIELD_U, b->exact, -1, &slip));
  if (g->wall[0]) slip = 0; /* not measured */
  CHECK(PetscAbsReal(m->slip * g->n[0] - slip) < 10 * TOLERANCE * norm, "%s: slip %g for %g", b->options,
        (double)m->slip, (double)(slip / g->n[0]));
  if (!g->wall[1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Ends(g, FIELD_P, b->p, 1, &pressure));
  PetscCall(VecSum(b->p, &all));
  PetscCall(VecNorm(b->p, NORM_INFINITY, &largest));
  pressure = 0.5 * pressure / g->n[0] - all / ((PetscReal)g->n[0] * g->n[1]);
  CHECK(PetscAbsReal(m->pressure - pressure) < TOLERANCE * largest, "%s: pressure %g for %g", b->options,
        (double)m->pressure, (double)pressure);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A channel without flux has a uniform pressure gradient, which is not in p. */
static PetscErrorCode RemoveMeanU(Grid g, Vec w) {
  const PetscInt n = GridLocalU(g);
  PetscScalar *a, sum = 0;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a));
  for (PetscInt k = 0; k < n; k++) sum += a[k];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, g->comm));
  for (PetscInt k = 0; k < n; k++) a[k] -= sum / ((PetscReal)g->n[0] * g->n[1]);
  PetscCall(VecRestoreArray(w, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The velocity and the pressure of the force b->r, by the equations that they obey: H u + G p = r but for a uniform
   force where that moves nothing, G^T u = 0. */
static PetscErrorCode SolveExactly(Box *b) {
  const Fluid f = b->fluid;
  const Grid g = f->grid;
  const PetscBool still = !g->wall[0] && !g->wall[1] && (f->alpha == 0 || f->held) ? PETSC_TRUE : PETSC_FALSE;
  PetscReal norm, error, divergence;
  Vec left;
  PetscFunctionBeginUser;
  PetscCall(TestVecs(b->r, &left, NULL));
  PetscCall(StokesSolve(b->stokes, b->r, NULL, b->exact, b->p));
  PetscCall(MatMult(f->H, b->exact, left));
  PetscCall(GridGradient(g, 1, b->p, PETSC_TRUE, left));
  PetscCall(VecAXPY(left, -1, b->r));
  if (still) PetscCall(FluidRemoveMean(f, left));
  if (f->zero_flux) PetscCall(RemoveMeanU(g, left));
  PetscCall(VecNorm(left, NORM_2, &error));
  PetscCall(VecNorm(b->r, NORM_2, &norm));
  CHECK(error < TOLERANCE * norm, "%s: H u + G p = r, %.1e", b->options, (double)(error / norm));
  PetscCall(VecNorm(b->exact, NORM_2, &norm));
  PetscCall(GridLargestDivergence(g, b->exact, NULL, &divergence));
  CHECK(divergence < TOLERANCE * norm / g->h, "%s: G^T u = 0, %.1e", b->options, (double)divergence);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |x - y| is less than the tolerance times |y|; x is overwritten. */
static PetscErrorCode CheckSame(const Box *b, const char what[], PetscReal tolerance, Vec x, Vec y) {
  PetscReal error;
  PetscFunctionBeginUser;
  PetscCall(TestApart(NORM_2, x, y, &error));
  CHECK(error < tolerance, "%s, alpha = %g: %s, %.1e", b->options, (double)b->fluid->alpha, what, (double)error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forces and wanted velocities between two rows of all, first and end. */
static PetscErrorCode CheckRows(Box *b, PetscInt first, PetscInt end) {
  const Grid g = b->fluid->grid;
  const PetscInt before = FluidCountSolves(b->fluid);
  StreamRows rows = {0};
  PetscReal norm, error;
  StreamMeasures measures;
  PetscFunctionBeginUser;
  OwnRows(g, first, end, rows.forced);
  OwnRows(g, first, end, rows.wanted);
  PetscCall(TestRandomVec(3, b->r));
  PetscCall(Keep(g, rows.forced, b->r));
  PetscCall(SolveExactly(b));
  PetscCall(VecSet(b->u, 0));
  PetscCall(SolveRows(b->fluid, b->stokes, rows, b->r, b->u, NULL));
  CHECK(FluidCountSolves(b->fluid) == before + 3, "%s: counted as one scalar solve", b->options);
  PetscCall(SolveRows(b->fluid, b->stokes, rows, b->r, b->u, &measures));
  PetscCall(CheckMeasures(b, PETSC_TRUE, &measures));
  PetscCall(VecNorm(b->exact, NORM_2, &norm));
  PetscCall(Keep(g, rows.wanted, b->exact));
  PetscCall(VecAXPY(b->u, -1, b->exact));
  PetscCall(VecNorm(b->u, NORM_2, &error));
  CHECK(error < TOLERANCE * norm, "%s, rows %d to %d, alpha = %g: the Stokes solve's velocity, %.1e", b->options,
        (int)first, (int)end, (double)b->fluid->alpha, (double)(error / norm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The flow that a solve makes has its velocity and its squares, and the pressure follows from it; b->u is the velocity
   of a random force. */
static PetscErrorCode CheckFlow(Box *b, PetscInt seed, Vec flow) {
  const Grid g = b->fluid->grid;
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  const StreamRows rows = {.forced = {0, g->rows[FIELD_U]}, .wanted = {0, g->rows[FIELD_U]}, .flow = flow};
  PetscReal norm, square;
  StreamMeasures measures;
  Vec p;
  PetscFunctionBeginUser;
  PetscCall(TestVecs(b->p, &p, NULL));
  PetscCall(TestRandomVec(seed, b->r));
  PetscCall(SolveExactly(b));
  PetscCall(SolveRows(b->fluid, b->stokes, rows, b->r, b->u, &measures));
  PetscCall(CheckMeasures(b, PETSC_FALSE, &measures));
  PetscCall(StreamFlowsVelocity(flows, flow, b->u));
  PetscCall(CheckSame(b, "a flow's velocity", TOLERANCE, b->u, b->exact));
  PetscCall(StreamFlowsVelocity(flows, flow, b->u));
  PetscCall(VecNorm(b->u, NORM_2, &norm));
  PetscCall(StreamFlowsSquare(flows, flow, &square));
  CHECK(PetscAbsReal(square - norm * norm) < TOLERANCE * norm * norm, "%s: squares of a flow", b->options);
  PetscCall(StokesPressure(b->stokes, b->r, b->u, p));
  PetscCall(CheckSame(b, "the pressure of a flow", 10 * TOLERANCE, p, b->p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Three random flows, and uhat = SUM weight_j u_j. */
static PetscErrorCode MakePast(Box *b, StreamPast *past, Vec uhat) {
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  PetscFunctionBeginUser;
  *past = (StreamPast){.count = 3, .weight = {2, -.7, .3}, .part = .4, .lag = .15};
  for (PetscInt k = 0; k < past->count; k++) {
    PetscCall(StreamFlowsCreateVec(flows, &past->flow[k]));
    PetscCall(CheckFlow(b, 7 + k, past->flow[k]));
    PetscCall(StreamFlowsVelocity(flows, past->flow[k], b->u));
    PetscCall(VecAXPY(uhat, past->weight[k], b->u));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A random force in the wanted rows is added to r, and its velocity to the flow. */
static PetscErrorCode CheckAdded(Box *b, StreamRows rows) {
  Vec more;
  PetscFunctionBeginUser;
  PetscCall(TestVecs(b->r, &more, NULL));
  PetscCall(TestRandomVec(5, more));
  PetscCall(Keep(b->fluid->grid, rows.wanted, more));
  PetscCall(VecAXPY(b->r, 1, more));
  rows.past = NULL;
  rows.add = PETSC_TRUE;
  PetscCall(SolveRows(b->fluid, b->stokes, rows, more, b->u, NULL));
  PetscCall(SolveExactly(b));
  PetscCall(StreamFlowsVelocity(StokesStream(b->stokes)->flows, rows.flow, b->u));
  PetscCall(CheckSame(b, "velocity with what is added", TOLERANCE, b->u, b->exact));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Flows are a force beside another one, which is in some rows only, and some of them is shown with the velocity; what
   is added to such a flow is added to the velocity. */
static PetscErrorCode CheckPast(Box *b, PetscInt first, PetscInt end) {
  const Grid g = b->fluid->grid;
  const StreamFlows flows = StokesStream(b->stokes)->flows;
  StreamPast past;
  StreamRows these = {.past = &past};
  StreamMeasures measures;
  PetscReal norm;
  Vec uhat, shown;
  PetscFunctionBeginUser;
  OwnRows(g, first, end, these.forced);
  OwnRows(g, first, end, these.wanted);
  PetscCall(TestVecs(b->r, &uhat, &shown, NULL));
  PetscCall(StreamFlowsCreateVec(flows, &these.flow));
  PetscCall(MakePast(b, &past, uhat));
  PetscCall(TestRandomVec(3, b->r));
  PetscCall(Keep(g, these.wanted, b->r));
  PetscCall(VecSet(b->u, 0));
  PetscCall(SolveRows(b->fluid, b->stokes, these, b->r, b->u, &measures));
  PetscCall(VecNorm(uhat, NORM_2, &norm));
  CHECK(PetscAbsReal(measures.past - norm * norm) < TOLERANCE * norm * norm, "%s: squares of the past", b->options);
  PetscCall(VecAXPY(b->r, 1, uhat));
  PetscCall(SolveExactly(b));
  PetscCall(VecCopy(b->exact, shown));
  PetscCall(VecAXPBY(shown, past.lag, past.part, uhat));
  PetscCall(Keep(g, these.wanted, shown));
  PetscCall(CheckSame(b, "velocity with some of the past", TOLERANCE, b->u, shown));
  PetscCall(StreamFlowsVelocity(flows, these.flow, b->u));
  PetscCall(CheckSame(b, "velocity of the past's force and another", TOLERANCE, b->u, b->exact));
  PetscCall(CheckAdded(b, these));
  for (PetscInt k = 0; k < past.count; k++) PetscCall(VecDestroy(&past.flow[k]));
  PetscCall(VecDestroy(&these.flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBox(const char options[]) {
  static const PetscReal coefficients[] = {128, 0.75, 128};
  Box b;
  PetscFunctionBeginUser;
  PetscCall(BoxCreate(options, &b));
  const PetscInt n = b.fluid->grid->n[1];
  for (int k = 0; k < 3; k++) { /* there and back: nothing of an earlier a0 may stay */
    PetscCall(FluidSetTimeCoefficient(b.fluid, coefficients[k]));
    PetscCall(CheckRows(&b, 0, n));
    PetscCall(CheckRows(&b, n / 3, n / 2));
    PetscCall(CheckPast(&b, n / 3, n / 2));
    PetscCall(CheckPast(&b, 0, n));
  }
  PetscCall(TestBoxDestroy(&b.box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  static const char *const grids[] = {"-domain_box -1,1,-1,1 -domain_cells 48,48",
                                      "-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47",
                                      "-domain_box 0,3,0,1.0540540540540540 -domain_cells 74,26",
                                      "-domain_box 0,1,0,2.24 -domain_cells 25,56",
                                      "-domain_box 0,1,0,1.875 -domain_cells 8,15",
                                      "-domain_box 0,1,0,4 -domain_cells 32,128",
                                      "-domain_box 0,1,0,1 -domain_cells 128,128"};
  static const char *const kinds[] = {"-domain_bc_x periodic -domain_bc_y periodic -fluid_inertia unsteady",
                                      "-domain_bc_x periodic -domain_bc_y periodic -fluid_inertia none",
                                      "-domain_bc_x periodic -fluid_inertia unsteady",
                                      "-domain_bc_x periodic -fluid_inertia none",
                                      "-domain_bc_x periodic -fluid_inertia none -flow_drive flux",
                                      "-fluid_inertia unsteady",
                                      "-fluid_inertia none"};
  char options[512];
  PetscFunctionBeginUser;
  for (int g = 0; g < 7; g++)
    for (int k = 0; k < 7; k++) {
      PetscCall(PetscSNPrintf(options, sizeof(options), "%s %s -vesicle_shape none -fluid_viscosity 0.7", grids[g],
                              kinds[k]));
      PetscCall(CheckBox(options));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
