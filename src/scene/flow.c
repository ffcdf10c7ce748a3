/* Background flows: exact steady Stokes flows without a vesicle (DESIGN section 2). */
#include "scene/scene.h"

void FlowVelocity(const Flow *flow, PetscReal x, PetscReal y, PetscReal u[2]) {
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
  default:
    break;
  }
}

void FlowGradient(const Flow *flow, PetscReal x, PetscReal y, PetscReal gradient[2][2]) {
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
