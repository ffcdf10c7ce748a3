/* The state that a scheme advances in time. Vectors are distributed like the grid and the markers. */
#pragma once
#include "problem/coupling.h"

/* Which of w and p have been made; SchemeVelocity makes w, SchemeFields makes both. */
typedef enum { FIELDS_MADE, FIELDS_WITHOUT_P, FIELDS_WITHOUT_BOTH } StateFields;

/* Everything that moves in time. */
typedef struct {
  PetscInt step;
  PetscReal t, dt;
  PetscReal dt_last; /* the step that led to this state; 0 at the start */
  PetscBool solved;  /* flow, tension and velocities are those of a solve; not of fluid that starts from rest */
  Vec w;             /* velocity on the faces: the disturbance, or the whole in the total form */
  Vec p;             /* pressure, zero mean */
  Vec flow;        /* velocity as a flow (fluid/stokes/streamflow.h), in fluid with inertia; NULL where steps make w */
  Forcing forcing; /* the forcing from which p follows, and w where there is no flow; empty where steps make both */
  PetscReal a0;    /* the time coefficient of the solve from forcing to w and p */
  StateFields fields;
  Vec sigma; /* unknowns of the membranes' law (bodies/law.h), the tension; an edge vector */
  Vec X;     /* markers, a marker vector */
  Vec U;     /* markers' velocity, background included */
  Vec solid; /* the fluid's force on the markers of obstacles (length^3/time^2), then the velocities of own free bodies
                (bodies/freebodies.h); NULL without obstacles */
  Vec place; /* of free bodies, on every rank; NULL without */
} State;

/* StateInstant - its time and its bodies' places. Not collective. */
static inline Instant StateInstant(const State *state) {
  return (Instant){state->t, state->place};
}

/* StateCreate - a state at rest, of zero vectors. StateDuplicate - zero vectors of the same kinds; times are not
   copied. Collective. */
PETSC_EXTERN PetscErrorCode StateCreate(Coupling coupling, State *state);
PETSC_EXTERN PetscErrorCode StateDuplicate(const State *state, State *copy);
PETSC_EXTERN PetscErrorCode StateDestroy(State *state);

/* StateFlowWidth - numbers of a flow in a row of u of the grid; 0 without a flow. Not collective. */
static inline PetscInt StateFlowWidth(const State *state, Grid grid) {
  PetscInt size = 0;
  if (state->flow) (void)VecGetLocalSize(state->flow, &size);
  return size / grid->rows[FIELD_U];
}

/* StateCopy - copy times, vectors and StateFields; vectors that the target lacks are made. fields: vectors on the grid
   are copied too; else those of the target stay. Collective. */
PETSC_EXTERN PetscErrorCode StateCopy(const State *from, State *to, PetscBool fields);

/* StateSwap - exchange the vectors that both states have; times and StateFields stay. Not collective. */
PETSC_EXTERN void StateSwap(State *a, State *b);
