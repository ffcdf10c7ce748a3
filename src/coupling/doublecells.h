/* Velocity and pressure of a viscosity contrast at cell centres (docs/contrast.md, Output): the double layer
   next to the membranes as it is, in the place of what the grid has of it, and inside a vesicle the fluid's own
   velocity, the solved one over the ratio. */
#pragma once
#include "coupling/coupling.h"

/* DoubleCellsCorrect - to the solved velocity u, v, background included, and the pressure p at this rank's cell
   centres, [rows][nx] each, u and v together or neither, p or NULL: of markers X that move with U. In unbounded fluid
   all of the double layer is added, else the difference to the grid's next to the membranes. Nothing without contrast.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleCellsCorrect(Coupling coupling, Vec U, Vec X, PetscReal u[], PetscReal v[],
                                               PetscReal p[]);
