/* Measures of a velocity that a stream function gives, from its Fourier modes and from its rows as they are made, so
   that the velocity need not be kept on the grid. Rows come downwards; StreamMeterEnd sums over the ranks. */
#pragma once
#include "fluid/transforms/rowtransform.h"

typedef struct {
  PetscReal square; /* SUM u^2 + v^2 over all faces (length^2/time^2) */
  PetscReal
      divergence; /* largest |G^T u - source| of the cells whose velocity is made (1/time); NaN if one is not finite */
  PetscReal slip; /* mean of u in the first row less that in the last row (length/time); 0 between walls in x */
  PetscReal pressure; /* mean pressure of the rows of cells next to both walls less that of all; 0 without walls */
  PetscReal past;     /* SUM uhat^2 of the states before, where they act as a force (velocity^2/time^2); else 0 */
} StreamMeasures;

typedef struct {
  Grid grid;          /* borrowed */
  PetscInt width;     /* modes of a row */
  PetscReal *norm[2]; /* [width] sums over a row of the square of a mode of chi/h and of its difference */
  PetscReal *chi[2];  /* [width] modes of chi/h in the last two rows of nodes */
  PetscInt count[2];  /* modes of these rows that are not zero */
  int now;            /* which of the two rows came last */
  StreamMeasures own; /* measures of this rank so far */
} * StreamMeter;

/* StreamMeterCreate - for a grid and its transform of rows of nodes. Not collective. */
PETSC_EXTERN PetscErrorCode StreamMeterCreate(Grid grid, RowTransform t, StreamMeter *meter);
PETSC_EXTERN PetscErrorCode StreamMeterDestroy(StreamMeter *meter);

/* StreamMeterBegin - a solve begins. Not collective. StreamMeterEnd - the measures of the solve, of all ranks.
   Collective. */
PETSC_EXTERN void StreamMeterBegin(StreamMeter meter);
PETSC_EXTERN PetscErrorCode StreamMeterEnd(StreamMeter meter, StreamMeasures *measures);

/* StreamMeterForce - the sum of v's force over local row j. Not collective. */
PETSC_EXTERN void StreamMeterForce(StreamMeter meter, PetscInt j, PetscReal sum);

/* StreamMeterNodes - room for `count` modes of the next row of nodes; any others are zero. Not collective. */
PETSC_EXTERN PetscReal *StreamMeterNodes(StreamMeter meter, PetscInt count);

/* StreamMeterSlip - take in local row j of u, whose mean is given. Not collective. */
PETSC_EXTERN void StreamMeterSlip(StreamMeter meter, PetscInt j, PetscReal mean_u);

/* StreamMeterSquares - take in the squares of local row j of u, with this mean, between the last two rows of nodes (u:
   the row itself, which may have more than the nodes give; NULL: not made), and those of v with its mean in the upper
   row of nodes; has_v: there is such a row of v. Not collective. */
PETSC_EXTERN void StreamMeterSquares(StreamMeter meter, PetscInt j, const PetscScalar u[], PetscReal mean_u,
                                     PetscBool has_v, PetscReal mean_v);

/* StreamMeterDivergence - take in the divergence of a row of cells less its source (NULL: none), from its row of u,
   chi/h below and above, and rise: what is added to v above less what is added below. Not collective. */
PETSC_EXTERN void StreamMeterDivergence(StreamMeter meter, const PetscScalar u[], const PetscScalar low[],
                                        const PetscScalar high[], PetscReal rise, const PetscScalar source[]);
