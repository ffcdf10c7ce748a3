/* The box part of the double layer: D takes the error of second order off what walls and periodic images add to the
   dipoles' velocity,

       U += D T = phi Q diag(l) Q^T psi^T T,

   phi and psi the values of the table's functions at the markers. A product sums tensors into the functions, goes
   through the eigenvectors once, and takes velocities out of the functions. A rank has the values of its own markers; a
   product sums the amplitudes over all ranks.

   Create, Place wherever the markers have been placed, then Apply. */
#pragma once
#include "mobility/boxtable.h"
#include "markers/markers.h"

typedef struct _p_DoubleBox *DoubleBox;
struct _p_DoubleBox {
  const FluidSpec *spec; /* borrowed */
  Markers markers;       /* borrowed */
  BoxLattice lattice;
  BoxTable table;       /* made when it is first needed */
  PetscInt width;       /* functions of y, filled up with zeros to whole vectors */
  PetscReal *value;     /* [n][functions of x + width] of the own markers */
  PetscReal *function;  /* [BOX_COMPONENTS][functions of x][width] work */
  PetscReal *amplitude; /* [rank] work */
  PetscLogEvent make;
};

/* DoubleBoxCreate - for markers on the grid that `spec` makes, which is borrowed as the lattice's tables of dipoles
   (LatticeDipoles) are. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice,
                                            DoubleBox *box);
PETSC_EXTERN PetscErrorCode DoubleBoxDestroy(DoubleBox *box);

/* DoubleBoxPlace - where the markers have been placed. Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxPlace(DoubleBox box);

/* DoubleBoxApply - y += alpha D T, own part y[2n] of a marker vector, tensors T[DIPOLE_COUNT n] of the own markers.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxApply(DoubleBox box, PetscReal alpha, const PetscReal T[], PetscScalar y[]);
