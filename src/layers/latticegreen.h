/* The Stokeslet of the infinite staggered lattice, h = nu = 1: what the grid's Stokes solve gives at a face per unit
   force on a face, without box and without inertia (docs/nearfield.md, The lattice), and its pressure at cells. Both
   are Fourier integrals along x of closed forms across, and tabulated by offset. Its answer to tensor dipoles in cells
   and at nodes (docs/contrast.md, Near field), to the force -DIV T and the source tr T/2 that markers/dipoles.h
   spreads, is made of differences of both. Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "layers/stencilsums.h"
#include "markers/dipoles.h"

/* LatticePressure - the pressure at cell centres that goes with it, from sources u (value[OFFSET_UU], offset of cell
   (i, j) from the face (i - 1/2, j)) and v (value[OFFSET_VV], (i, j - 1/2)): the lattice's gradient of its Green's
   function, which tends to x/(2 pi r^2). In length units it is table/h. Not collective. */
PETSC_EXTERN PetscErrorCode LatticePressure(PetscInt reach, OffsetTable *table);

/* LatticeStokeslet - the table for offsets up to `reach` cells. Far away uu tends to (-ln r + x^2/r^2)/(4 pi), the
   constant included: in length units and with viscosity nu a velocity per force is (table - ln(h)/(4 pi))/nu on the
   diagonal and table/nu off it. Not collective. */
PETSC_EXTERN PetscErrorCode LatticeStokeslet(PetscInt reach, OffsetTable *table);

/* LatticeConstant - what uu has besides its integral. Not collective. */
PETSC_EXTERN PetscReal LatticeConstant(void);

/* LatticeDipoles - velocity along x (table[0]) and y (table[1]) at a face, of a unit tensor part (value[DipolePart]),
   for offsets up to `reach` cells, entry of the face minus entry of the part: its force -DIV T and its source tr T/2.
   Independent of the viscosity; in length units it is table/h. Not collective. */
PETSC_EXTERN PetscErrorCode LatticeDipoles(PetscInt reach, OffsetTable table[2]);
