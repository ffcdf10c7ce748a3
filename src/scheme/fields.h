/* Velocity and pressure of the state of a scheme whose steps leave them to be made when they are asked for: a step
   needs neither on the grid where fluid/stokes/stream.h gives the velocity (docs/membrane.md, One step). All is
   collective. */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeFields - make the velocity and the pressure of the state, w and p, where the step has not. SchemeVelocity - w
   alone, if there is a cheaper way. To be called before they are read. */
PETSC_EXTERN PetscErrorCode SchemeFields(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeVelocity(Scheme scheme);

/* SchemeVelocityOf - w = the velocity of a state that has a flow. SchemeFlowOf - the flow of w. SchemeSquare - SUM u^2
   over the faces of the state's velocity, which is not made. */
PETSC_EXTERN PetscErrorCode SchemeVelocityOf(Scheme scheme, const State *state, Vec w);
PETSC_EXTERN PetscErrorCode SchemeFlowOf(Scheme scheme, Vec w, Vec flow);
PETSC_EXTERN PetscErrorCode SchemeSquare(Scheme scheme, PetscReal *square);
