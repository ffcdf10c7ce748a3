/* The constants of the recurrences in stream.c, and the 2 x 2 matrices by which slabs of rows, walls and the seam of a
   period close them. Every rank has all of them. */
#pragma once
#include "fluid/transforms/rowtransform.h"

/* A 2 x 2 matrix for each mode, [4][width]: its entries 11, 12, 21, 22. */
typedef PetscReal *PairMatrix;

/* power[0] and gain[0] are for a slab of full height, power[1] and gain[1] for the last rank's slab. */
typedef struct _p_StreamFactors *StreamFactors;
struct _p_StreamFactors {
  Grid grid;
  PetscInt modes, width;    /* modes of a row's transform; that number rounded up to whole blocks */
  const PetscReal *lambda;  /* [modes] borrowed, minus the second difference's eigenvalues times h^2 */
  const PetscReal *scale;   /* [modes] borrowed, of the transform */
  PetscReal alpha;          /* the coefficient that the constants are for; -1: none yet */
  PetscReal *r[2], *factor; /* [width] decays; chi/h over z2 */
  PairMatrix power[2];      /* M^m */
  PairMatrix gain[2];       /* from Y below a slab without right-hand side to Z in its first row */
  PairMatrix bottom, top;   /* what closes the recurrences at walls or at the seam */
  PetscInt *reach;          /* [blocks] rows after which what comes in from outside is negligible in a block's modes */
};

/* StreamFactorsCreate - for the modes of a row transform of the grid (lambda borrowed). Not collective. */
PETSC_EXTERN PetscErrorCode StreamFactorsCreate(Grid grid, RowTransform t, StreamFactors *factors);
PETSC_EXTERN PetscErrorCode StreamFactorsDestroy(StreamFactors *factors);

/* StreamFactorsSet - for alpha (1/time) and nu (length^2/time). Not collective. */
PETSC_EXTERN void StreamFactorsSet(StreamFactors factors, PetscReal alpha, PetscReal nu);
