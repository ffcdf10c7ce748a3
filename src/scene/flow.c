/* Background flows: exact steady Stokes flows without a vesicle, or a function of the caller. */
#include "scene/flow.h"
#include "base/agree.h"

void FlowVelocity(const Flow *flow, PetscReal t, PetscReal x, PetscReal y, PetscReal u[2]) {
  const PetscReal dx = x - flow->center[0], dy = y - flow->center[1];
  u[0] = u[1] = 0;
  switch (flow->type) {
  case FLOW_SHEAR:
    u[0] = flow->rate * dy;
    break;
  case FLOW_POISEUILLE:
    u[0] = flow->peak * (1 - PetscSqr(dy / flow->half_width));
    break;
  case FLOW_EXTENSION:
    u[0] = flow->rate * dx;
    u[1] = -flow->rate * dy;
    break;
  case FLOW_UNIFORM:
    for (int c = 0; c < 2; c++) u[c] = flow->velocity.v[c];
    break;
  case FLOW_CUSTOM: {
    const PetscReal X[2] = {x, y};
    if (flow->function(t, 1, X, u, flow->ctx)) u[0] = u[1] = NAN;
    break;
  }
  default:
    break;
  }
}

PetscErrorCode FlowVelocities(const Flow *flow, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[],
                              char message[PETVES_MAX_MESSAGE]) {
  PetscFunctionBeginUser;
  message[0] = 0;
  if (flow->type != FLOW_CUSTOM) {
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
      PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                              "-flow_type custom: u_inf is (%g, %g) at (%g, %g), time %g; allowed: finite numbers",
                              (double)u[2 * k], (double)u[2 * k + 1], (double)X[2 * k], (double)X[2 * k + 1],
                              (double)t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FlowGradient(const Flow *flow, PetscReal t, PetscReal x, PetscReal y, PetscReal gradient[2][2]) {
  const PetscReal dy = y - flow->center[1];
  gradient[0][0] = gradient[0][1] = gradient[1][0] = gradient[1][1] = 0;
  switch (flow->type) {
  case FLOW_SHEAR:
    gradient[0][1] = flow->rate;
    break;
  case FLOW_POISEUILLE:
    gradient[0][1] = -2 * flow->peak * dy / PetscSqr(flow->half_width);
    break;
  case FLOW_EXTENSION:
    gradient[0][0] = flow->rate;
    gradient[1][1] = -flow->rate;
    break;
  default:
    break;
  }
}

void FlowPressureGradient(const Flow *flow, PetscReal nu, PetscReal g[2]) {
  g[0] = flow->type == FLOW_POISEUILLE ? -2 * nu * flow->peak / PetscSqr(flow->half_width) : 0;
  g[1] = 0;
}

PetscReal FlowShearRate(const Flow *flow) {
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION) return PetscAbsReal(flow->rate);
  if (flow->type == FLOW_POISEUILLE) return 2 * PetscAbsReal(flow->peak) / flow->half_width;
  return 0;
}

#define POINTS 7       /* in x, and in y, in the box */
#define STEP 1e-3      /* of the differences, in cells: their error is a millionth of the flow's change over a cell */
#define TOLERATED 1e-3 /* divergence over the largest gradient: flows from tables of numbers have some */
#define ROUNDOFF 1e-11 /* of a velocity, which differences show too */

typedef struct {
  PetscReal divergence, x, y; /* the largest, and where */
  PetscReal gradient, speed;  /* largest values */
} Largest;

/* Differences about one point from the velocities to its right, left, top and bottom. */
static void FlowCompare(const PetscReal u[8], PetscReal x, PetscReal y, PetscReal apart, Largest *most) {
  const PetscReal ux = (u[0] - u[2]) / apart, vx = (u[1] - u[3]) / apart;
  const PetscReal uy = (u[4] - u[6]) / apart, vy = (u[5] - u[7]) / apart;
  const PetscReal gradient = PetscMax(PetscMax(PetscAbsReal(ux), PetscAbsReal(uy)),
                                      PetscMax(PetscAbsReal(vx), PetscAbsReal(vy)));
  for (int k = 0; k < 8; k++) most->speed = PetscMax(most->speed, PetscAbsReal(u[k]));
  most->gradient = PetscMax(most->gradient, gradient);
  if (PetscAbsReal(ux + vy) <= PetscAbsReal(most->divergence)) return;
  most->divergence = ux + vy;
  most->x = x;
  most->y = y;
}

PetscErrorCode FlowCheckDivergence(MPI_Comm comm, const Flow *flow, const PetscReal box[4], PetscReal h) {
  const PetscReal step = STEP * h;
  char message[PETVES_MAX_MESSAGE] = "";
  Largest most = {0};
  PetscFunctionBeginUser;
  if (flow->type != FLOW_CUSTOM) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < POINTS * POINTS && !*message; k++) {
    const PetscReal x = box[0] + (box[1] - box[0]) * ((PetscReal)(k % POINTS) + 0.5) / POINTS;
    const PetscReal y = box[2] + (box[3] - box[2]) * ((PetscReal)(k / POINTS) + 0.5) / POINTS;
    const PetscReal at[8] = {x + step, y, x - step, y, x, y + step, x, y - step};
    PetscReal u[8];
    PetscCall(FlowVelocities(flow, 0, 4, at, u, message));
    if (!*message) FlowCompare(u, x, y, 2 * step, &most);
  }
  if (!*message && PetscAbsReal(most.divergence) > TOLERATED * most.gradient + ROUNDOFF * most.speed / step)
    PetscCall(PetscSNPrintf(message, sizeof(message),
                            "-flow_type custom: u_inf has the divergence %.3g at (%.3g, %.3g), time 0; allowed: none, "
                            "here up to %.1g, a thousandth of its largest gradient",
                            (double)most.divergence, (double)most.x, (double)most.y,
                            (double)(TOLERATED * most.gradient)));
  PetscCall(AgreeMessage(comm, message));
  PetvesCheck(!*message, comm, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}
