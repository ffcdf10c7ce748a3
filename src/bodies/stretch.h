/* How an edge of a membrane resists stretching: the laws of elastic membranes in the plane (Breyiannis and Pozrikidis,
   Theor. Comput. Fluid Dyn. 13, 2000). With the stretch lambda = |e|/ds, e an edge and ds its length at rest, W the
   energy a length at rest and T the tension,

       T = dW/dlambda,      sigma = T/lambda = 2 dW/dq,      q = lambda^2,

       hooke          W = E/2 (lambda - 1)^2
       green          W = E/8 (lambda^2 - 1)^2
       neo_hookean    T = E/3 (lambda^(3/2) - lambda^(-3/2))

   All three have T = E (lambda - 1) at small strain, and a sigma that grows with q. */
#pragma once
#include "bodies/membrane.h"

/* One edge: sigma, its derivative by q, and W, all over E. */
typedef struct {
  PetscReal sigma, slope, energy;
} Stretch;

/* StretchOf - of an edge of this q by the law, which is not LAW_INEXTENSIBLE. Not collective. */
PETSC_EXTERN Stretch StretchOf(LawType law, PetscReal q);
