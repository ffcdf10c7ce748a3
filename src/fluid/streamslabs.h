/* The recurrences of a solve by stream function (stream.c) across the slabs of rows that ranks have: y of the own rows,
   and what comes into each slab from outside. */
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
  PetscReal *below, *above; /* [ranks][2][width] Y below each slab, Z above it */
  PetscReal *last, *first;  /* [2][width] Y above all rows, Z in the first one */
  PetscReal *own, *all;     /* [message], [ranks][message] first Z, last Y, and a number to be summed */
  PetscInt message;         /* numbers of it */
  PetscReal *zero;          /* [width] */
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
