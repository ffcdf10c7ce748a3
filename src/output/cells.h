/* Velocity and pressure at cell centres, as run.h5 and callers have them.

   The velocity at a centre is the mean of the cell's faces and the background's velocity there; next to membranes the
   near field corrects it. In unbounded fluid, where nothing is on the grid, it is the single layer of the membranes.
   Every rank has the cells of its own rows. */
#pragma once
#include "scheme/scheme.h"

/* CellFields - u, v: velocity, background included; p: pressure, of the disturbance unless the form is total, in
   unbounded fluid zero far away. Arrays [rows][nx], NULL on every rank for a field that is not wanted. Collective. */
PETSC_EXTERN PetscErrorCode CellFields(Scheme scheme, PetscReal u[], PetscReal v[], PetscReal p[]);
