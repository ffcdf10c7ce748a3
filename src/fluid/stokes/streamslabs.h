/* The recurrences of a solve by stream function (stream.c) across the slabs of rows that ranks have: y of the own rows,
   and what comes into the slab from outside. Each rank closes a part of the modes for all slabs; two messages a solve
   go to every rank, and their size does not grow with the number of ranks. */
#pragma once
#include "fluid/stokes/streamfactors.h"

typedef struct _p_StreamSlabs *StreamSlabs;
struct _p_StreamSlabs {
  Grid grid;                /* borrowed */
  StreamFactors factors;    /* borrowed */
  PetscInt rows, width;     /* rows of nodes on this rank; modes, rounded up to whole blocks */
  PetscReal *y;             /* [rows][width] y2; NULL before the first solve */
  PetscInt *stored;         /* [rows] blocks of modes that are stored in a row of y; y of the others is zero */
  PetscReal *state;         /* [2][width] Y on the way up, Z on the way down */
  PetscReal *below, *above; /* [2][width] Y below the slab, Z above it */
  PetscReal *own;           /* [4][width] first Z and last Y of the slab, and behind them a number to be summed */
  PetscInt part, begin;     /* modes that a rank closes (the last ranks have fewer); the first mode of this rank */
  PetscInt count;           /* modes that this rank closes */
  PetscInt message;         /* numbers of a part with the number to be summed */
  PetscReal *send,
      *all;         /* [ranks][message] what a rank has of each part, what each has of this one; on one rank: own */
  PetscReal *Y, *Z; /* [ranks][2][part] Y below each slab, Z above it; on one rank: below, above */
  PetscReal *last, *first; /* [2][part] Y above all rows, Z in the first one */
  PetscReal *zero;         /* [width] */
};

/* StreamSlabsCreate - for a grid and its factors, borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsCreate(Grid grid, StreamFactors factors, StreamSlabs *slabs);
PETSC_EXTERN PetscErrorCode StreamSlabsDestroy(StreamSlabs *slabs);

/* StreamSlabsReserve - allocate y. Not collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsReserve(StreamSlabs slabs);

/* StreamSlabsClose - y of each slab is that of a slab into which nothing comes, and `state` has Y of its last row: find
   what comes into every slab, and add it to y. sum: becomes the sum of a number of every rank. Collective.
   StreamSlabsReopen - take what came in off y again. Not collective. */
PETSC_EXTERN PetscErrorCode StreamSlabsClose(StreamSlabs slabs, PetscReal *sum);
PETSC_EXTERN void StreamSlabsReopen(StreamSlabs slabs);
