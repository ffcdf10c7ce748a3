/* Background flows: exact steady Stokes flows without a vesicle, or a function of the caller. */
#include "scene/flow.h"

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
