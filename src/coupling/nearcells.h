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

/* NearCellStencil - the weights by which a field's entries make its value at the centre of a cell: the two faces' mean,
   or the entry. Not collective. */
PETSC_EXTERN void NearCellStencil(Field field, const PetscInt cell[2], PaddedStencil *padded);

/* NearCellsBox - cells from box[dir][0] to box[dir][1] hold n markers X[2n] and all within reach (length) of them;
   indices go beyond the grid where it is periodic. NearCellIs - whether x is within reach of a marker. Not collective.
 */
PETSC_EXTERN void NearCellsBox(Grid grid, PetscInt n, const PetscReal X[], PetscReal reach, PetscInt box[2][2]);
PETSC_EXTERN PetscBool NearCellIs(PetscInt n, const PetscReal X[], PetscReal reach, const PetscReal x[2]);
