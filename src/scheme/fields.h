/* Velocity and pressure of the state of a scheme whose steps leave them to be made when they are asked for: a step
   needs neither on the grid where fluid/stokes/stream.h gives the velocity (docs/steps.md, One step). All is
   collective. */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeFields - make the velocity and the pressure of the state, w and p, where the step has not. SchemeVelocity - w
   alone, if there is a cheaper way. To be called before they are read. */
PETSC_EXTERN PetscErrorCode SchemeFields(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeVelocity(Scheme scheme);

/* SchemeFluidAtMarkers - the fluid's velocity at the vesicles' markers in a solved state: that of the markers, but for
   the water that passes. VecDestroy gives it back; not to be changed. */
PETSC_EXTERN PetscErrorCode SchemeFluidAtMarkers(Scheme scheme, Vec *U);

/* SchemeFlows - what states that have a flow are turned into velocities by, borrowed. */
PETSC_EXTERN StreamFlows SchemeFlows(Scheme scheme);
