/* The exact double layer between different membranes, for the preconditioner of many vesicles with viscosity contrast:
       W(x) = -(1/pi) SUM_k r (r.N_k)(r.J_k)/r^4,      r = X_k - x,
   over the markers X_k of the vesicles near the one of x, N_k their normals times length and J_k their jumps. It leaves
   out lattice, box and walls, and is summed in each product, so that no dense blocks are kept. Jumps of all ranks are
   gathered. */
#pragma once
#include "mobility/doublelayer.h"

typedef struct _p_DoubleCross *DoubleCross;
struct _p_DoubleCross {
  DoubleLayer layer;    /* borrowed: markers, normals, and the near field's pairs of vesicles */
  PetscReal *X, *N, *J; /* [2M] of all markers, with room for whole vectors (lanes.h) */
};

/* DoubleCrossCreate - of a double layer. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossCreate(DoubleLayer layer, DoubleCross *cross);
PETSC_EXTERN PetscErrorCode DoubleCrossDestroy(DoubleCross *cross);

/* DoubleCrossPlace - where the layer has been placed. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossPlace(DoubleCross cross);

/* DoubleCrossApply - W += what the jumps J do to the markers of other vesicles, own parts [2n] of marker vectors.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleCrossApply(DoubleCross cross, const PetscScalar J[], PetscScalar W[]);
