/* The pressure drop and the flux of a flow past obstacles (docs/obstacles.md): from the mean momentum balance along x.
   Sums cross ranks. */
#pragma once
#include "scheme/stepcommon.h"

/* Along x, in a box that is periodic in x. */
typedef struct {
  PetscReal pressure_drop; /* from x_min to x_max, background's included (length^2/time^2, density 1) */
  PetscReal flux;          /* through a line across the box, background's included (length^2/time) */
} Drive;

/* DriveMeasure - at the present state, in quasi-steady flow; not a number where x has walls. The mean of momentum over
   the box gives the mean pressure gradient g: H u + g = f, of forces f of obstacles, gravity and contact with solids.
   Collective. */
PETSC_EXTERN PetscErrorCode DriveMeasure(Scheme scheme, Drive *drive);

/* PressureGradient - the mean gradient along x that the pressure of the present state lacks (length/time^2): what
   drives the flow, or that of the background. Collective. */
PETSC_EXTERN PetscErrorCode PressureGradient(Scheme scheme, PetscReal *gradient);
