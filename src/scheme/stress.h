/* The stress that membranes add to a sheared channel (docs/suspensions.md, Stress): walls in y, periodic in x. */
#pragma once
#include "scheme/stepcommon.h"

/* StressApplies - whether the scene is a sheared channel with vesicles. Not collective. */
PETSC_EXTERN PetscBool StressApplies(Scheme scheme);

/* StressMeasure - fill in report.stress: from what the fluid of velocity w and pressure p (NULL: that of
   report.measures) does to the walls, and from F, minus the membranes' force times ds (length^3/time^2; marker vector),
   at the markers where the coupling has been placed; X: the markers at which F is taken. The two agree to rounding in
   fluid without inertia. Not a number in other scenes. Collective. */
PETSC_EXTERN PetscErrorCode StressMeasure(Scheme scheme, Vec w, Vec p, Vec F, Vec X);
