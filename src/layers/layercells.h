/* Velocity and pressure of the membranes' forces and of a viscosity contrast at cell centres (cellrow.h): the exact
   single or double layer next to a membrane in the place of what the regularised delta function makes of it on the
   infinite lattice, as for the markers' velocity; in unbounded fluid all of it. With a contrast (docs/contrast.md,
   Output) the solved velocity inside a vesicle is the ratio times the fluid's own. */
#pragma once
#include "layers/layersetting.h"
#include "layers/stencilsums.h"

/* field[3][rows][nx]: u, v and p at this rank's cell centres, NULL for those not wanted; X: the membranes' markers.
   Collective.

   SingleCellsCorrect - to the grid's answer to the forces times ds F[2n] on the markers X of the first bodies, those of
   a layout; lattice: LatticeStokeslet.

   DoubleCellsCorrect - to the solved velocity, background included, u and v together or neither, of vesicles with these
   ratios of viscosities whose markers move with U; lattice: LatticeDipoles. */
PETSC_EXTERN PetscErrorCode SingleCellsCorrect(const LayerSetting *set, const OffsetTable *lattice, Layout layout,
                                               Vec F, Vec X, PetscReal *const field[3]);
PETSC_EXTERN PetscErrorCode DoubleCellsCorrect(const LayerSetting *set, const OffsetTable lattice[2],
                                               const PetscReal ratio[], Vec U, Vec X, PetscReal *const field[3]);
