/* The pull of a tension that turns with the edges (docs/steps.md, The tension turns with the membrane). With the
   expected tension sigma >= 0 of the new time, which is zero where the force has just been placed, minus the force is

       K_sigma X - K_sigma X*,      K_sigma = MembraneVesiclePull,

   where K_sigma X* = Dm^T sigma is what the solved tension gives along the edges of X*. */
#pragma once
#include "bodies/force.h"

typedef struct {
  Membrane membrane;  /* borrowed */
  PetscReal *tension; /* [n] of the own vesicles (length^3/time^2) */
} Turning;
