/* What is measured of a velocity that a stream function gives: from its Fourier modes and from the rows that are made
   of it, so that it need not be on the grid. */
#pragma once
#include "fluid/rowtransform.h"

typedef struct {
  PetscReal square; /* SUM u^2 + v^2 over all faces (length^2/time^2) */
  PetscReal
      divergence; /* largest |G^T u - source| of the cells whose velocity is made (1/time); NaN if one is not finite */
  PetscReal slip; /* mean of u in the first row less that in the last (length/time); 0 between walls in x */
  PetscReal pressure; /* mean over the rows of cells next to both walls less that of all; 0 without walls */
  PetscReal past;     /* SUM uhat^2 of the states before that are a force (velocity^2/time^2); 0 without */
} StreamMeasures;

/* Rows come in downwards. */
typedef struct {
  Grid grid;          /* borrowed */
  PetscInt width;     /* of a row's modes */
  PetscReal *norm[2]; /* [width] squares of a mode of chi/h and of its difference, summed over a row */
  PetscReal *chi[2];  /* [width] modes of chi/h in the last two rows of nodes, */
  PetscInt count[2];  /* how many of them are not zero, */
  int now;            /* and which row came last */
  StreamMeasures own; /* of this rank so far */
} * StreamMeter;

/* StreamMeterCreate - for a grid and its transform of rows of nodes. Not collective. */
PETSC_EXTERN PetscErrorCode StreamMeterCreate(Grid grid, RowTransform t, StreamMeter *meter);
PETSC_EXTERN PetscErrorCode StreamMeterDestroy(StreamMeter *meter);

/* StreamMeterBegin - a solve begins. Not collective. StreamMeterEnd - what it gave, of all ranks. Collective. */
PETSC_EXTERN void StreamMeterBegin(StreamMeter meter);
PETSC_EXTERN PetscErrorCode StreamMeterEnd(StreamMeter meter, StreamMeasures *measures);

/* StreamMeterForce - the sum of v's force over local row j. Not collective. */
PETSC_EXTERN void StreamMeterForce(StreamMeter meter, PetscInt j, PetscReal sum);

/* StreamMeterNodes - room for `count` modes of the next row of nodes; any others are zero. Not collective. */
PETSC_EXTERN PetscReal *StreamMeterNodes(StreamMeter meter, PetscInt count);

/* StreamMeterSlip - of local row j of u with this mean. Not collective. */
PETSC_EXTERN void StreamMeterSlip(StreamMeter meter, PetscInt j, PetscReal mean_u);

/* StreamMeterSquares - of local row j of u with this mean between the last two rows of nodes (u: the row itself, which
   may have more than the nodes give; NULL: not made), and of v in the upper one with its mean; has_v: whether there is
   one. Not collective. */
PETSC_EXTERN void StreamMeterSquares(StreamMeter meter, PetscInt j, const PetscScalar u[], PetscReal mean_u,
                                     PetscBool has_v, PetscReal mean_v);

/* StreamMeterDivergence - of a row of cells, from the rows of u and of chi/h below and above it and what is added to v
   above less that below, less the source that it should have (NULL: none). Not collective. */
PETSC_EXTERN void StreamMeterDivergence(StreamMeter meter, const PetscScalar u[], const PetscScalar low[],
                                        const PetscScalar high[], PetscReal rise, const PetscScalar source[]);
