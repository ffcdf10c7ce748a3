/* The vectors of a state on markers as arrays of all ranks' values. Writers of files and the restart touch
   these vectors here only. A gather is one message a vector; a scatter needs none, as every rank copies its own part.
 */
#pragma once
#include "scheme/scheme.h"

enum { GATHERED_MARKERS, GATHERED_VELOCITY, GATHERED_TENSION, GATHERED_SOLIDS, GATHERED_COUNT };

typedef struct {
  const char *name;  /* in checkpoints */
  PetscInt each;     /* numbers a marker, or 1 */
  PetscInt n;        /* markers; 0: the state has no such vector */
  PetscReal *values; /* [n][each] the same on every rank */
} GatheredPart;

typedef struct {
  GatheredPart part[GATHERED_COUNT];
} Gathered;

/* GatheredCreate - arrays for the vectors of a state, zero. GatherState - copy the state's vectors into the arrays.
   ScatterState - copy the arrays into the state's vectors. GatheredDestroy - free the arrays. Collective. */
PETSC_EXTERN PetscErrorCode GatheredCreate(const State *state, Gathered *all);
PETSC_EXTERN PetscErrorCode GatherState(const State *state, Gathered *all);
PETSC_EXTERN PetscErrorCode ScatterState(const Gathered *all, const State *state);
PETSC_EXTERN PetscErrorCode GatheredDestroy(Gathered *all);
