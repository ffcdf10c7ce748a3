/* Velocity and pressure at cell centres. */
#pragma once
#include "scheme/stepcommon.h"

/* CellForces - forces times ds on the fluid and the markers where they act, for the caller to destroy, of vesicles or,
   in unbounded fluid, of all bodies, and the layout of these. Collective. */
PETSC_EXTERN PetscErrorCode CellForces(Scheme scheme, Layout *layout, Vec *F, Vec *X);

/* CellFields - velocity u, v, background included, and pressure p at cell centres, of the disturbance unless the form
   is total. The velocity is the mean of the cell's faces and the background's; next to membranes the near field
   corrects it. In unbounded fluid, where nothing is on the grid, the fields are those of the single layer of the
   membranes and bodies, with no pressure far away. Arrays [rows][nx] of this rank's rows, NULL on every rank for a
   field that is not wanted. Collective. */
PETSC_EXTERN PetscErrorCode CellFields(Scheme scheme, PetscReal u[], PetscReal v[], PetscReal p[]);
