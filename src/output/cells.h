/* Velocity at cell centres, as run.h5 and the callers of SimulationGetCellVelocity have it. */
#pragma once
#include "scheme/scheme.h"

/* CellVelocity - component c of the velocity w (local array) at this rank's cell centres: mean of the cell's two faces,
   plus the background at the flow's time; cells[rows][nx]. Collective. */
PETSC_EXTERN PetscErrorCode CellVelocity(Scheme scheme, int c, const PetscScalar w[], PetscScalar cells[]);
