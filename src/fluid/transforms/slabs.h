/* The recurrences of modefactors.h across the slabs of rows that ranks have: y = y2 of the own rows, and what comes
   into the slab from outside.

   It is known from what all slabs say by themselves: Y leaves a slab of m rows as its own and M^m times what came in, Z
   as its own, the gain times Y from below and M^m times Z from above. Each rank closes a part of the modes for all
   slabs; two messages a solve go to every rank, and their size does not grow with the number of ranks. */
#pragma once
#include "fluid/transforms/modefactors.h"

typedef struct _p_Slabs *Slabs;
struct _p_Slabs {
  Grid grid;                /* borrowed */
  ModeFactors factors;      /* borrowed */
  PetscInt rows, width;     /* rows on this rank; modes, rounded up to whole blocks */
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

/* SlabsCreate - for the rows of the factors' field; the factors are borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode SlabsCreate(ModeFactors factors, Slabs *slabs);
PETSC_EXTERN PetscErrorCode SlabsDestroy(Slabs *slabs);

/* SlabsReserve - make y, once, of zeros, before the first solve: a solver that is never used has none. Not collective.
 */
PETSC_EXTERN PetscErrorCode SlabsReserve(Slabs slabs);

/* SlabsStore - row j of y is stored in its first blocks of modes. Not collective. */
static inline void SlabsStore(Slabs s, PetscInt j, PetscInt blocks) {
  s->stored[j] = blocks;
}

/* SlabsClose - y of each slab is that of a slab into which nothing comes, and `state` has Y of its last row: find
   what comes into every slab, and add it to y. sum: becomes the sum of a number of every rank. Collective.
   SlabsReopen - take what came in off y again. SlabsAddLast - `state` += Y of the last row when it was closed. Not
   collective. */
PETSC_EXTERN PetscErrorCode SlabsClose(Slabs slabs, PetscReal *sum);
PETSC_EXTERN void SlabsReopen(Slabs slabs);
static inline void SlabsAddLast(Slabs s) {
  for (PetscInt k = 0; k < 2 * s->width; k++) s->state[k] += s->own[2 * s->width + k];
}
