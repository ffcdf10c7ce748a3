/* What a scheme advances in time. */
#pragma once
#include "coupling/coupling.h"

/* Everything that moves in time. */
typedef struct {
  PetscInt step;
  PetscReal t, dt;
  PetscReal dt_last; /* the step that led here; 0 at the start */
  Vec w;             /* velocity on the faces: the disturbance, or the whole in the total form */
  Vec p;             /* pressure, zero mean */
  Vec flow;   /* velocity as fluid/streamflow.h has it, in fluid with inertia; NULL where w is made in each step */
  Vec force;  /* on the faces, from which p follows, and without a flow w; NULL where both are made in each step */
  Vec source; /* with it, the viscosity contrast's source of the divergence; NULL without */
  PetscReal mean[2]; /* and the mean velocity that goes with that */
  PetscReal a0;      /* and the solve's time coefficient */
  GridWindow window; /* force and source are zero outside it, without convection */
  PetscBool pending; /* p is not made yet: SchemeFields; */
  PetscBool hidden;  /* w neither: SchemeVelocity */
  Vec sigma;         /* tension, an edge vector */
  Vec X;             /* markers, a marker vector */
  Vec U;             /* markers' velocity, background included */
  Vec walls;         /* scheme coupled's wall forces; else NULL */
  Vec solid;         /* the fluid's force on the markers of obstacles (length^3/time^2); NULL without */
} State;

/* StateCreate - at rest: zero vectors, without wall forces. StateDuplicate - zero vectors of the same kinds, times not
   copied. Collective. */
PETSC_EXTERN PetscErrorCode StateCreate(Coupling coupling, State *state);
PETSC_EXTERN PetscErrorCode StateDuplicate(const State *state, State *copy);
PETSC_EXTERN PetscErrorCode StateDestroy(State *state);

/* StateFlowWidth - numbers that a flow has in a row of u of the grid; 0 without. Not collective. */
static inline PetscInt StateFlowWidth(const State *state, Grid grid) {
  PetscInt size = 0;
  if (state->flow) (void)VecGetLocalSize(state->flow, &size);
  return size / grid->rows[FIELD_U];
}

/* StateCopy - times, vectors and what is not made yet; the target's missing vectors are made. fields: what is on the
   grid too, else it stays. Collective. */
PETSC_EXTERN PetscErrorCode StateCopy(const State *from, State *to, PetscBool fields);

/* StateSwap - the vectors that two states both have change places; times and what is not made yet stay. Not collective.
 */
PETSC_EXTERN void StateSwap(State *a, State *b);
