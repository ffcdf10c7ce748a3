/* Background flows: exact steady Stokes flows without a vesicle, or a function of the caller. */
#include "scene/flow.h"
#include "base/agree.h"

/* A flow of the table, with the place d from the flow's centre:

     u_a = c_a + SUM_b G_ab d_b,   and u_x has SUM_b q_b d_b^2 too. */
typedef struct {
  PetscReal c[3], G[3][3], q[3];
} FlowPolynomial;

static FlowPolynomial FlowPolynomialOf(const Flow *flow) {
  const PetscBool channel = flow->type == FLOW_POISEUILLE || flow->type == FLOW_TUBE;
  FlowPolynomial f = {0};
  if (flow->type == FLOW_SHEAR) f.G[0][1] = flow->rate;
  if (flow->type == FLOW_EXTENSION || flow->type == FLOW_AXIAL) f.G[0][0] = flow->rate;
  if (flow->type == FLOW_EXTENSION) f.G[1][1] = -flow->rate;
  if (flow->type == FLOW_AXIAL) f.G[1][1] = f.G[2][2] = -0.5 * flow->rate;
  if (channel) f.c[0] = flow->peak;
  if (channel) f.q[1] = -flow->peak / PetscSqr(flow->half_width);
  if (flow->type == FLOW_TUBE) f.q[2] = f.q[1];
  for (int k = 0; k < flow->velocity.n && flow->type == FLOW_UNIFORM; k++) f.c[k] = flow->velocity.v[k];
  return f;
}

/* Component k at the place d from the flow's centre. */
static PetscReal FlowPolynomialAt(const FlowPolynomial *f, int k, const PetscReal d[3]) {
  PetscReal u = f->c[k] + f->G[k][0] * d[0] + f->G[k][1] * d[1] + f->G[k][2] * d[2];
  for (int b = 1; b < 3 && k == 0; b++) u += f->q[b] * d[b] * d[b];
  return u;
}

void FlowVelocity(const Flow *flow, PetscReal t, PetscReal x, PetscReal y, PetscReal u[2]) {
  const PetscReal d[3] = {x - flow->center[0], y - flow->center[1], 0}, X[2] = {x, y};
  const FlowPolynomial f = FlowPolynomialOf(flow);
  for (int k = 0; k < 2; k++) u[k] = FlowPolynomialAt(&f, k, d);
  if (FlowIsCustom(flow) && flow->function(t, 1, X, u, flow->ctx)) u[0] = u[1] = NAN;
}

static const char *FlowName(const Flow *flow) {
  return flow->type == FLOW_CUSTOM ? "custom" : "formula";
}

PetscErrorCode FlowVelocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[],
                              char message[PETVES_MAX_MESSAGE]) {
  PetscFunctionBeginUser;
  message[0] = 0;
  if (!FlowIsCustom(flow)) {
    for (PetscInt k = 0; k < n; k++) FlowVelocity(flow, t, X[2 * k], X[2 * k + 1], &u[2 * k]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (n && flow->function(t, n, X, u, flow->ctx)) {
    PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                            "-flow_type custom: the function of the flow failed at time %g; allowed: one that gives "
                            "u_inf at any point of the domain",
                            (double)t));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < n && !*message; k++)
    if (PetscIsInfOrNanReal(u[2 * k]) || PetscIsInfOrNanReal(u[2 * k + 1]))
      PetscCall(PetscSNPrintf(
          message, PETVES_MAX_MESSAGE, "-flow_type %s: u_inf is (%g, %g) at (%g, %g), time %g; allowed: finite numbers",
          FlowName(flow), (double)u[2 * k], (double)u[2 * k + 1], (double)X[2 * k], (double)X[2 * k + 1], (double)t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FlowGradient(const Flow *flow, PetscReal y, PetscReal gradient[2][2]) {
  const FlowPolynomial f = FlowPolynomialOf(flow);
  for (int k = 0; k < 4; k++) gradient[k / 2][k % 2] = f.G[k / 2][k % 2];
  gradient[0][1] += 2 * f.q[1] * (y - flow->center[1]);
}

void FlowPressureGradient(const Flow *flow, PetscReal nu, PetscReal g[2]) {
  g[0] = 2 * nu * FlowPolynomialOf(flow).q[1];
  g[1] = 0;
}

PetscReal FlowShearRate(const Flow *flow) {
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION || flow->type == FLOW_AXIAL)
    return PetscAbsReal(flow->rate);
  if (flow->type == FLOW_POISEUILLE || flow->type == FLOW_TUBE) return 2 * PetscAbsReal(flow->peak) / flow->half_width;
  return 0;
}

#define POINTS 7       /* in x, and in y, in the box */
#define STEP 1e-3      /* of the differences, in cells, or in three dimensions over R */
#define TOLERATED 1e-3 /* divergence over the largest gradient: flows from tables of numbers have some */
#define ROUNDOFF 1e-11 /* of a velocity, which differences show too */
#define LATER 0.618    /* of the end time: where formulas are looked at too, for a flow that begins at rest */

/* Write the message of formulas that go through the walls of a channel, or differ by more than `least` a period on. */
static void FlowCheckSides(const Flow *flow, const PetscReal box[4], const PetscReal period[2], PetscReal t,
                           PetscReal least, char message[PETVES_MAX_MESSAGE]) {
  for (int k = 0; k < 8 * POINTS && !*message; k++) {
    const int d = k % 2, c = k / 2 % 2, side = k / 4 % 2; /* across the sides; the component */
    PetscReal at[2][2], u[2][2];
    for (int s = 0; s < 2; s++) {
      at[s][d] = box[2 * d + s];
      at[s][1 - d] = box[2 - 2 * d] + (box[3 - 2 * d] - box[2 - 2 * d]) * ((PetscReal)(k / 8) + 0.5) / POINTS;
      FlowVelocity(flow, t, at[s][0], at[s][1], u[s]);
    }
    const PetscBool repeats = period[d] > 0, channel = period[1 - d] > 0;
    const PetscReal right = repeats ? u[1 - side][c] : channel && c == d ? 0 : u[side][c];
    if (PetscAbsReal(u[side][c] - right) > least)
      (void)snprintf(message, PETVES_MAX_MESSAGE, "-flow_%c: %.3g at (%.3g, %.3g), time %.3g; allowed: %.3g, as %s",
                     "uv"[c], (double)u[side][c], (double)at[side][0], (double)at[side][1], (double)t, (double)right,
                     repeats ? "a period of the box on" : "nothing passes the walls of a channel");
  }
}

PetscErrorCode FlowCheck(MPI_Comm comm, const Flow *flow, const PetscReal box[4], const PetscReal period[2],
                         PetscReal h, PetscReal end) {
  const PetscReal step = STEP * h;
  char message[PETVES_MAX_MESSAGE] = "";
  PetscReal divergence = 0, where[3] = {0, 0, 0}, gradient = 0, speed = 0; /* the largest values */
  const PetscInt points = POINTS * POINTS, times = flow->type == FLOW_FORMULA ? 2 : 1;
  PetscFunctionBeginUser;
  if (!FlowIsCustom(flow)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < times * points && !*message; k++) {
    const PetscReal x = box[0] + (box[1] - box[0]) * ((PetscReal)(k % POINTS) + 0.5) / POINTS;
    const PetscReal y = box[2] + (box[3] - box[2]) * ((PetscReal)(k % points / POINTS) + 0.5) / POINTS;
    const PetscReal t = k < points ? 0 : LATER * end;
    const PetscReal at[8] = {x + step, y, x - step, y, x, y + step, x, y - step};
    PetscReal u[8] = {0}, slope[4];
    PetscCall(FlowVelocities(flow, t, 4, at, u, message));
    for (int j = 0; j < 4; j++) { /* u_x and u_y by x, then by y */
      const PetscReal *ahead = u + 4 * (j / 2) + j % 2;
      slope[j] = (ahead[0] - ahead[2]) / (2 * step);
      gradient = PetscMax(gradient, PetscAbsReal(slope[j]));
      speed = PetscMax(speed, PetscMax(PetscAbsReal(ahead[0]), PetscAbsReal(ahead[2])));
    }
    if (PetscAbsReal(slope[0] + slope[3]) <= PetscAbsReal(divergence)) continue;
    divergence = slope[0] + slope[3];
    where[0] = x;
    where[1] = y;
    where[2] = t;
  }
  if (!*message && PetscAbsReal(divergence) > TOLERATED * gradient + ROUNDOFF * speed / step)
    PetscCall(PetscSNPrintf(message, sizeof(message),
                            "-flow_type %s: u_inf has the divergence %.3g at (%.3g, %.3g), time %.3g; allowed: none, "
                            "here up to %.1g, a thousandth of its largest gradient",
                            FlowName(flow), (double)divergence, (double)where[0], (double)where[1], (double)where[2],
                            (double)(TOLERATED * gradient)));
  for (PetscInt k = 0; k < times && flow->type == FLOW_FORMULA; k++)
    FlowCheckSides(flow, box, period, (PetscReal)k * LATER * end, TOLERATED * speed, message);
  PetscCall(AgreeMessage(comm, message));
  PetvesCheck(!*message, comm, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A caller's flow, whose points and velocities have their coordinates side by side. */
static PetscErrorCode Flow3Custom(const Flow *f, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  PetscReal *at, *found;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(3 * n, &at, 3 * n, &found));
  for (PetscInt k = 0; k < 3 * n; k++) at[k] = X[k % 3 * n + k / 3];
  const PetscBool failed = (PetscBool)(f->function(t, n, at, found, f->ctx) != 0);
  for (PetscInt k = 0; k < 3 * n; k++) u[k % 3 * n + k / 3] = failed ? NAN : found[k];
  PetscCall(PetscFree2(at, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flow3Velocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  const FlowPolynomial f = FlowPolynomialOf(flow);
  if (FlowIsCustom(flow)) return Flow3Custom(flow, t, n, X, u);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal d[3] = {X[i] - flow->center[0], X[n + i] - flow->center[1], X[2 * n + i]};
    for (int k = 0; k < 3; k++) u[k * n + i] = FlowPolynomialAt(&f, k, d);
  }
  return PETSC_SUCCESS;
}

/* The divergence and the largest gradient at x, by differences over 2h. */
static PetscErrorCode Flow3Slopes(const Flow *f, PetscReal t, const PetscReal x[3], PetscReal h, PetscReal *divergence,
                                  PetscReal *largest) {
  PetscReal X[18], u[18];
  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) /* ahead along x, y, z, then behind */
    for (int d = 0; d < 3; d++) X[6 * d + k] = x[d] + (d != k % 3 ? 0 : k < 3 ? h : -h);
  PetscCall(Flow3Velocities(f, t, 6, X, u));
  *divergence = 0;
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < 3; d++) {
      const PetscReal slope = (u[6 * d + k] - u[6 * d + k + 3]) / (2 * h);
      *largest = slope == slope ? PetscMax(*largest, PetscAbsReal(slope)) : slope;
      if (d == k) *divergence += slope;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Flow3Check(MPI_Comm comm, const Flow *flow, PetscInt count, const RealList *center, PetscReal R,
                          PetscReal end, PetscReal *rate) {
  const PetscInt times = flow->type == FLOW_FORMULA ? 2 : 1, corners = 8;
  char message[PETVES_MAX_MESSAGE] = "";
  PetscReal largest = 0;
  PetscFunctionBeginUser;
  if (!FlowIsCustom(flow)) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < times * count * corners && !*message; k++) {
    const PetscReal t = k < count * corners ? 0 : LATER * end;
    PetscReal x[3], divergence = 0;
    for (int d = 0; d < 3; d++) x[d] = ListEntry(center, 3, k / corners % count, d) + R * (k >> d & 1 ? 0.55 : -0.45);
    PetscCall(Flow3Slopes(flow, t, x, STEP * R, &divergence, &largest));
    if (!(PetscAbsReal(divergence) <= TOLERATED * largest + 1e-12))
      PetscCall(PetscSNPrintf(message, sizeof(message),
                              "-flow_type %s: u_inf has the divergence %.3g at (%.3g, %.3g, %.3g), time %.3g; allowed: "
                              "none, and finite numbers",
                              FlowName(flow), (double)divergence, (double)x[0], (double)x[1], (double)x[2], (double)t));
  }
  PetscCall(AgreeMessage(comm, message));
  PetvesCheck(!*message, comm, "%s", message);
  *rate = largest;
  PetscFunctionReturn(PETSC_SUCCESS);
}
