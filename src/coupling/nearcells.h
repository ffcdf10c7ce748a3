/* Fields at cell centres next to a membrane: the grid's velocity and pressure are smoothed there by the kernel. Cells
   within a few h of a membrane get the difference between the exact single layer and what the kernel makes of it on the
   infinite lattice, as the markers' velocity does (nearfield.h). */
#pragma once
#include "coupling/coupling.h"

/* NearCellsCorrect - to the velocity u, v and the pressure p at this rank's cell centres, [rows][nx] each, NULL for
   those not wanted, that the coupling's grid has of markers X with tension sigma; nothing without near field.
   Collective. */
PETSC_EXTERN PetscErrorCode NearCellsCorrect(Coupling coupling, Vec sigma, Vec X, PetscReal u[], PetscReal v[],
                                             PetscReal p[]);
