/* Background flows: exact steady Stokes flows without a vesicle, or a function of the caller. */
#include "scene/flow.h"
#include "base/agree.h"

/* A flow of the table, with the place d from the flow's centre:

     u_a = c_a + SUM_b G_ab d_b,   and u_x has q d_y^2 too. */
typedef struct {
  PetscReal c[2], G[2][2], q;
} FlowForm;

static FlowForm FlowFormOf(const Flow *flow) {
  FlowForm f = {0};
  if (flow->type == FLOW_SHEAR) f.G[0][1] = flow->rate;
  if (flow->type == FLOW_EXTENSION) {
    f.G[0][0] = flow->rate;
    f.G[1][1] = -flow->rate;
  }
  if (flow->type == FLOW_POISEUILLE) {
    f.c[0] = flow->peak;
    f.q = -flow->peak / PetscSqr(flow->half_width);
  }
  for (int k = 0; k < 2 && flow->type == FLOW_UNIFORM; k++) f.c[k] = flow->velocity.v[k];
  return f;
}

void FlowVelocity(const Flow *flow, PetscReal t, PetscReal x, PetscReal y, PetscReal u[2]) {
  const PetscReal dx = x - flow->center[0], dy = y - flow->center[1], X[2] = {x, y};
  const FlowForm f = FlowFormOf(flow);
  for (int k = 0; k < 2; k++) u[k] = f.c[k] + f.G[k][0] * dx + f.G[k][1] * dy;
  u[0] += f.q * dy * dy;
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
  const FlowForm f = FlowFormOf(flow);
  for (int k = 0; k < 4; k++) gradient[k / 2][k % 2] = f.G[k / 2][k % 2];
  gradient[0][1] += 2 * f.q * (y - flow->center[1]);
}

void FlowPressureGradient(const Flow *flow, PetscReal nu, PetscReal g[2]) {
  g[0] = 2 * nu * FlowFormOf(flow).q;
  g[1] = 0;
}

PetscReal FlowShearRate(const Flow *flow) {
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION || flow->type == FLOW_AXIAL)
    return PetscAbsReal(flow->rate);
  if (flow->type == FLOW_POISEUILLE || flow->type == FLOW_TUBE) return 2 * PetscAbsReal(flow->peak) / flow->half_width;
  return 0;
}

#define POINTS 7       /* in x, and in y, in the box */
#define STEP 1e-3      /* of the differences, in cells: their error is a millionth of the flow's change over a cell */
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
