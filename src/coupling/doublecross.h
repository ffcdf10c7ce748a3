/* The exact double layer between different membranes, for the preconditioner of many vesicles: without lattice, box
   and walls, no dense blocks kept. */
#pragma once
#include "coupling/doublelayer.h"

typedef struct _p_DoubleCross *DoubleCross;
struct _p_DoubleCross {
  DoubleLayer layer;    /* borrowed: markers, normals, and the near field's pairs of vesicles */
  PetscReal *X, *N, *J; /* [2M] with room for whole vectors: places, normals times length, jumps of all markers */
};

/* DoubleCrossCreate - of a double layer. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossCreate(DoubleLayer layer, DoubleCross *cross);
PETSC_EXTERN PetscErrorCode DoubleCrossDestroy(DoubleCross *cross);

/* DoubleCrossPlace - where the layer has been placed. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossPlace(DoubleCross cross);

/* DoubleCrossApply - W += what the jumps J do to the markers of other vesicles, own parts [2n] of marker vectors.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossApply(DoubleCross cross, const PetscScalar J[], PetscScalar W[]);
