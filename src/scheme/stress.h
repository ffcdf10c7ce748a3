/* The stress that membranes and obstacles add to a sheared channel with walls in y, periodic in x
   (docs/suspensions.md, Stress). It is measured twice, at the walls and from the membranes' forces; the sums cross
   ranks. */
#pragma once
#include "scheme/stepcommon.h"

/* StressApplies - whether the scene is a sheared channel with bodies. Not collective. */
PETSC_EXTERN PetscBool StressApplies(Scheme scheme);

/* StressMeasure - fill in report.stress. The stress at the walls is that of velocity w and pressure p (NULL: from
   report.measures). The bodies' stress is that of F, minus their force times ds (length^3/time^2; marker vector of
   all), at the markers X of all, where the coupling has been placed and a step solved. Both agree to rounding in fluid
   without inertia. NaN in other scenes. Collective. */
PETSC_EXTERN PetscErrorCode StressMeasure(Scheme scheme, Vec w, Vec p, Vec F, Vec X);
