/* Tracers: passive points that the flow carries along (-tracer_file, -tracer_grid). After each step they go on by
   Heun's rule, with their velocity at the last state and that at the new one, of second order for steps of any length,

       Y = X + dt U(X, t),      X' = X + dt/2 (U(X, t) + U(Y, t + dt)),

   U by pointvelocity.h. The state at the start of a run has no velocity: its first step takes that of its end. Without
   tracers nothing is done. Every rank has all of them. */
#pragma once
#include "scheme/stepcommon.h"

typedef struct {
  PetscInt n;
  PetscReal *X, *U; /* [2n] places, not wrapped into a periodic box, and velocities at the last state */
  PetscReal t;      /* time of the last state */
  PetscBool moving; /* U is known */
} Tracers;

/* TracersCreate - where the options put them; stops with the user's message. TracersMove - to the scheme's new
   state. Collective. */
PETSC_EXTERN PetscErrorCode TracersCreate(Scene scene, Tracers *tracers);
PETSC_EXTERN PetscErrorCode TracersMove(Tracers *tracers, Scheme scheme);
PETSC_EXTERN PetscErrorCode TracersDestroy(Tracers *tracers);
