/* The pull of a tension that turns with the edges (docs/membrane.md, The tension turns with the membrane). With the
   expected tension sigma >= 0 of the new time, which is zero where the force has just been placed, minus the force is

       K_sigma X - K_sigma X*,      K_sigma = MembraneVesiclePull,

   where K_sigma X* = Dm^T sigma is what the solved tension gives along the edges of X*. */
#pragma once
#include "bodies/force.h"

typedef struct {
  Membrane membrane;  /* borrowed */
  PetscReal *tension; /* [n] of the own vesicles (length^3/time^2) */
} Turning;

/* TurningExpect - until the forces are placed again, let the expected tension (edge vector), where it is positive, pull
   along the new edges, as far as waves of the membrane would otherwise be unstable in a step with a0, in fluid of the
   viscosity nu. Not collective. */
PETSC_EXTERN PetscErrorCode TurningExpect(Forces forces, PetscReal nu, PetscReal a0, Vec expected);
