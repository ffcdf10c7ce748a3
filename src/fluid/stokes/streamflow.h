/* Flows: velocities without divergence as a solve by stream function (stream.h) has them, in Fourier modes along rows.
   A step in fluid with inertia keeps the states before it as flows: these are half of the numbers of u and v, and their
   force on the next step needs no transform (docs/fluid.md, Flows).

   A flow is a Vec, [rows of u][each]: of row j the modes of chi/h on the nodes above u's row (zero on walls), padding,
   and behind `width` modes the mean of u in the row and that of v above it. */
#pragma once
#include "fluid/transforms/rowtransform.h"

#define STREAM_PAST 3 /* flows that make a force, at most */

/* The force uhat = SUM weight_j flow_j (velocity over time) of the states before. A solve that has it returns
   part u + lag uhat in place of its velocity u. */
typedef struct {
  PetscInt count;
  PetscReal weight[STREAM_PAST]; /* (1/time) */
  Vec flow[STREAM_PAST];
  PetscReal part, lag; /* 1, time */
  Vec made;            /* the flow of u, which the solve makes */
} StreamPast;

typedef struct _p_StreamFlows *StreamFlows;
struct _p_StreamFlows {
  Grid grid;            /* borrowed */
  RowTransform t;       /* borrowed, of a row of nodes */
  PetscInt rows, width; /* rows of nodes on this rank; modes, rounded up to whole blocks */
  PetscInt each;        /* numbers of a row of a flow */
  PetscReal *norm;      /* [width] sum over a row of the square of a mode of chi/h */
  PetscReal *curl;      /* [width] factor from a mode of chi/h to that of a transform of the row */
  PetscReal *middle;    /* [width] factor of the row itself in the curl */
  PetscReal *edge[2];   /* [each] the sum's row below the first row and above the last one; zero at walls */
  PetscReal *line[3];   /* [each] the sum in three rows, row j at j % 3 */
  PetscReal *modes;     /* [width] modes of the curl of the sum */
  const PetscScalar *flow[STREAM_PAST];
  PetscReal weight[STREAM_PAST];
  PetscReal square; /* SUM uhat^2 of the rows so far (velocity^2/time^2) */
};

/* StreamFlowsCreate - for a grid and the transform of its rows of nodes; width: its modes, rounded up to whole blocks.
   Not collective. StreamFlowsCreateVec - a flow at rest. Collective. */
PETSC_EXTERN PetscErrorCode StreamFlowsCreate(Grid grid, RowTransform t, PetscInt width, StreamFlows *flows);
PETSC_EXTERN PetscErrorCode StreamFlowsDestroy(StreamFlows *flows);
PETSC_EXTERN PetscErrorCode StreamFlowsCreateVec(StreamFlows flows, Vec *flow);

/* StreamFlowsBegin - from here on rows of a sum of flows can be asked for. Collective. StreamFlowsEnd - the last row
   has been asked for; square: SUM uhat^2 over the faces of this rank, NULL: not wanted. Not collective. */
PETSC_EXTERN PetscErrorCode StreamFlowsBegin(StreamFlows flows, const StreamPast *past);
PETSC_EXTERN PetscErrorCode StreamFlowsEnd(StreamFlows flows, const StreamPast *past, PetscReal *square);

/* StreamFlowsCurl - modes[width] of h times the curl of the sum on row j of nodes, as a transform of that row gives
   them. Rows are asked for upwards, each once. Not collective. */
PETSC_EXTERN const PetscReal *StreamFlowsCurl(StreamFlows flows, PetscInt j);

/* StreamFlowsRow - row j of the sum, -1 to rows, [each]. Borrowed until the next call. Not collective. */
PETSC_EXTERN const PetscReal *StreamFlowsRow(StreamFlows flows, PetscInt j);

/* StreamFlowsMean - mean of the sum's u in local row j of u, or (comp 1) of its v in row j of v. Not collective. */
PETSC_EXTERN PetscReal StreamFlowsMean(StreamFlows flows, PetscInt j, int comp);

/* StreamFlowsVelocity - w = the velocity of a flow. StreamFlowsSquare - SUM u^2 + v^2 over all faces
   (velocity^2). Collective. */
PETSC_EXTERN PetscErrorCode StreamFlowsVelocity(StreamFlows flows, Vec flow, Vec w);
PETSC_EXTERN PetscErrorCode StreamFlowsSquare(StreamFlows flows, Vec flow, PetscReal *square);
