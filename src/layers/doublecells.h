/* Velocity and pressure of a viscosity contrast at cell centres (cellrow.h, docs/contrast.md, Output): the double layer
   next to the membranes as it is, in the place of what the grid has of it, and inside a vesicle the fluid's own
   velocity, the solved one over the ratio. */
#pragma once
#include "layers/layersetting.h"
#include "layers/stencilsums.h"

/* DoubleCellsCorrect - to the solved velocity u, v, background included, and the pressure p at this rank's cell
   centres, field[3][rows][nx], u and v together or neither, p or NULL: of vesicles with these ratios of viscosities at
   X that move with U, all as marker vectors of the membranes; lattice: LatticeDipoles. In unbounded fluid all of the
   double layer is added, else the difference to the grid's next to the membranes. Collective. */
PETSC_EXTERN PetscErrorCode DoubleCellsCorrect(const LayerSetting *set, const OffsetTable lattice[2],
                                               const PetscReal ratio[], Vec U, Vec X, PetscReal *const field[3]);
