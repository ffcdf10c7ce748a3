/* Velocity and pressure of the membranes' forces at cell centres (cellrow.h): the exact single layer next to a membrane
   in the place of what the regularised delta function makes of it on the infinite lattice, as for the markers'
   velocity; in unbounded fluid all of it. */
#pragma once
#include "layers/layer.h"
#include "layers/layersetting.h"
#include "layers/stencilsums.h"

/* NearCellsCorrect - to the velocity u, v and the pressure p at this rank's cell centres, field[3][rows][nx], NULL for
   those not wanted, that the grid has of the layer's forces; lattice: LatticeStokeslet. Not collective. */
PETSC_EXTERN PetscErrorCode NearCellsCorrect(const LayerSetting *set, const OffsetTable *lattice, Layer layer,
                                             PetscReal *const field[3]);
