/* The recurrences of a solve by stream function (stream.c) across the slabs of rows that ranks have: y of the own rows,
   and what comes into the slab from outside. Each rank closes a part of the modes for all slabs, so that what a rank
   sends, keeps and works on does not grow with the ranks. */
#pragma once
#include "fluid/streamfactors.h"

typedef struct _p_StreamSlabs *StreamSlabs;
struct _p_StreamSlabs {
  Grid grid;                /* borrowed */
  StreamFactors factors;    /* borrowed */
  PetscInt rows, width;     /* of nodes on this rank; modes, rounded up to whole blocks */
  PetscReal *y;             /* [rows][width] y2, NULL before the first solve, */
  PetscInt *alive;          /* [rows] of whose blocks of modes so many are stored; the others are zero */
  PetscReal *state;         /* [2][width] Y on the way up, Z on the way down */
  PetscReal *below, *above; /* [2][width] Y below the slab, Z above it */
  PetscReal *own;           /* [4][width] its first Z and last Y, and behind them a number to be summed */
  PetscInt part, begin;     /* modes that every rank closes (the last ones fewer), the first of this rank's */
  PetscInt count;           /* and how many these are */
  PetscInt message;         /* numbers of the part, and the number to be summed */
  PetscReal *send,
      *all;         /* [ranks][message] what a rank has of each part, what each has of this one; on one rank: own */
  PetscReal *Y, *Z; /* [ranks][2][part] Y below each slab, Z above it; on one rank: below, above */
  PetscReal *last, *first; /* [2][part] Y above all rows, Z in the first one */
  PetscReal *zero;         /* [width] */
};

/* StreamSlabsCreate - for a grid and its factors, borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsCreate(Grid grid, StreamFactors factors, StreamSlabs *slabs);
PETSC_EXTERN PetscErrorCode StreamSlabsDestroy(StreamSlabs *slabs);

/* StreamSlabsReserve - room for y. Not collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsReserve(StreamSlabs slabs);

/* StreamSlabsClose - from y of each slab with nothing coming in, and the last row's Y in `state`, to what comes in, and
   to y with it. sum: of a number of every rank. Collective. StreamSlabsReopen - what comes in is taken off y again. Not
   collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsClose(StreamSlabs slabs, PetscReal *sum);
PETSC_EXTERN void StreamSlabsReopen(StreamSlabs slabs);
