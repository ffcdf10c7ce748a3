/* Velocity and pressure at cell centres, as run.h5 and callers have them. */
#pragma once
#include "scheme/scheme.h"

/* CellFields - u, v: the velocity, background included, at this rank's cell centres; means of the cells' faces, with
   the near field next to membranes, or in unbounded fluid that of the membranes' single layer; p likewise, of the
   disturbance unless the form is total; in unbounded fluid it is zero far away. Arrays [rows][nx], NULL on every rank
   for those not wanted. Collective. */
PETSC_EXTERN PetscErrorCode CellFields(Scheme scheme, PetscReal u[], PetscReal v[], PetscReal p[]);
