/* Backward differentiation formulas with variable steps: du/dt ~ a0 u - current u_n - old u_{n-1}. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscReal a0;      /* leading coefficient (1/time) */
  PetscReal current; /* weight of the present value: uhat = current u + old u_old */
  PetscReal old;
  PetscReal ratio; /* dt over the step before; 0 in a first step: extrapolation u* = (1 + ratio) u - ratio u_old */
} BDF;

/* BDFCoefficients - order 1 (dt_old is not used), or order 2 with the step dt after a step dt_old. For dt = dt_old
   order 2 is a0 = 3/(2dt), uhat = (2u - u_old/2)/dt, u* = 2u - u_old. */
static inline BDF BDFCoefficients(PetscInt order, PetscReal dt, PetscReal dt_old) {
  BDF b = {1 / dt, 1 / dt, 0, 0};
  if (order > 1) {
    const PetscReal r = dt / dt_old;
    b.a0 = (1 + 2 * r) / ((1 + r) * dt);
    b.current = (1 + r) / dt;
    b.old = -r * r / ((1 + r) * dt);
    b.ratio = r;
  }
  return b;
}
