/* What a scheme advances in time. */
#pragma once
#include "coupling/coupling.h"

/* What of w and p is made: SchemeVelocity makes w, SchemeFields both. */
typedef enum { FIELDS_MADE, FIELDS_WITHOUT_P, FIELDS_WITHOUT_BOTH } StateFields;

/* Everything that moves in time. */
typedef struct {
  PetscInt step;
  PetscReal t, dt;
  PetscReal dt_last; /* the step that led here; 0 at the start */
  Vec w;             /* velocity on the faces: the disturbance, or the whole in the total form */
  Vec p;             /* pressure, zero mean */
  Vec flow;        /* velocity as fluid/streamflow.h has it, in fluid with inertia; NULL where w is made in each step */
  Forcing forcing; /* from which p follows, and without a flow w; none where both are made in each step */
  PetscReal a0;    /* the time coefficient of the solve that does */
  StateFields fields;
  Vec sigma; /* tension, an edge vector */
  Vec X;     /* markers, a marker vector */
  Vec U;     /* markers' velocity, background included */
  Vec solid; /* the fluid's force on the markers of obstacles (length^3/time^2); NULL without */
} State;

/* StateCreate - at rest: zero vectors. StateDuplicate - zero vectors of the same kinds, times not
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
