/* The lattice's answer to tensor dipoles in cells and at nodes, h = 1 (docs/contrast.md, Near field): to the force
   -DIV T and the source tr T/2 that markers/dipoles.h spreads. Both are differences of the lattice's Stokeslet and of
   the gradient of its Green's function. Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "layers/stencilsums.h"
#include "markers/dipoles.h"

/* LatticeDipoles - velocity along x (table[0]) and y (table[1]) at a face, of a unit tensor part (value[DipolePart]),
   for offsets up to `reach` cells, entry of the face minus entry of the part: its force -DIV T and its source tr T/2.
   Independent of the viscosity; in length units it is table/h. Not collective. */
PETSC_EXTERN PetscErrorCode LatticeDipoles(PetscInt reach, OffsetTable table[2]);

/* DipoleContract - a pair's response to J of parts that respond with K to tensors, N = n w: T = (2 J_x N_x, 2 J_y N_y,
   J_x N_y + J_y N_x). M[4]: x from J_x, y from J_x, x from J_y, y from J_y. Not collective. */
static inline void DipoleContract(const PetscReal K[2][DIPOLE_COUNT], const PetscReal N[2], PetscReal scale,
                                  PetscReal M[4]) {
  for (int c = 0; c < 2; c++) {
    M[c] = scale * (2 * N[0] * K[c][DIPOLE_XX] + N[1] * K[c][DIPOLE_XY]);
    M[2 + c] = scale * (2 * N[1] * K[c][DIPOLE_YY] + N[0] * K[c][DIPOLE_XY]);
  }
}

/* DipoleContractFour - the same of four pairs. Not collective. */
static inline void DipoleContractFour(Lanes K[2][DIPOLE_COUNT], const PetscReal N[2], Lanes M[4]) {
  for (int c = 0; c < 2; c++) {
    M[c] = 2 * N[0] * K[c][DIPOLE_XX] + N[1] * K[c][DIPOLE_XY];
    M[2 + c] = 2 * N[1] * K[c][DIPOLE_YY] + N[0] * K[c][DIPOLE_XY];
  }
}
