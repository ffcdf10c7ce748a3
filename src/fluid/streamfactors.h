/* The constants of the recurrences in stream.c, and how slabs of rows and walls close them. */
#pragma once
#include "fluid/rowtransform.h"

/* A 2 x 2 matrix for each mode, [4][width]: its entries 11, 12, 21, 22. */
typedef PetscReal *PairMatrix;

/* Of the two entries of power and gain the first is for a slab of full height, the second for the last rank's. */
typedef struct _p_StreamFactors *StreamFactors;
struct _p_StreamFactors {
  Grid grid;
  PetscInt modes, width;    /* of a row's transform, and the same rounded up to whole blocks */
  const PetscReal *lambda;  /* [modes] borrowed, minus the second difference's eigenvalues times h^2 */
  const PetscReal *scale;   /* [modes] borrowed, of the transform */
  PetscReal alpha;          /* coefficient that they are for; -1 none yet */
  PetscReal *r[2], *factor; /* [width] decays; chi/h over z2 */
  PairMatrix power[2];      /* M^m */
  PairMatrix gain[2];       /* Z in the first row of a slab without right-hand side, of Y below it */
  PairMatrix bottom, top;   /* what closes them at walls or at the seam */
  PetscInt *reach;          /* [blocks] rows in which a block's modes feel what comes in from outside */
};

/* StreamFactorsCreate - for the modes of a row transform of the grid (lambda borrowed). Not collective. */
PETSC_EXTERN PetscErrorCode StreamFactorsCreate(Grid grid, RowTransform t, StreamFactors *factors);
PETSC_EXTERN PetscErrorCode StreamFactorsDestroy(StreamFactors *factors);

/* StreamFactorsSet - for alpha (1/time) and nu (length^2/time). Not collective. */
PETSC_EXTERN void StreamFactorsSet(StreamFactors factors, PetscReal alpha, PetscReal nu);
