/* The lattice's answer to tensor dipoles in cells and at nodes, spread as markers/dipoles.h does, h = 1
   (docs/contrast.md, Near field). */
#pragma once
#include "coupling/offsets.h"
#include "markers/dipoles.h"

/* LatticeDipoles - velocity along x (table[0]) and y (table[1]) at a face, of a unit tensor part (value[DipolePart]),
   for offsets up to `reach` cells, entry of the face minus entry of the part: its force -DIV T and its source tr T/2.
   Independent of the viscosity; in length units it is table/h. Not collective. */
PETSC_EXTERN PetscErrorCode LatticeDipoles(PetscInt reach, OffsetTable table[2]);
