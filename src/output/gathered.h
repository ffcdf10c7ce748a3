/* What a state has of its markers, gathered: the one place where the files' writers and the restart touch
   these vectors. */
#pragma once
#include "scheme/scheme.h"

/* Arrays of all vesicles, the same on every rank. */
typedef struct {
  PetscInt M;          /* markers */
  PetscInt W;          /* markers of obstacles */
  PetscReal *markers;  /* [M][2] */
  PetscReal *velocity; /* [M][2], background included */
  PetscReal *tension;  /* [M] */
  PetscReal *solid;    /* [W][2] force on obstacles */
} Gathered;

/* GatheredCreate - arrays of the state's sizes, zero. GatheredDestroy - free them. Collective. */
PETSC_EXTERN PetscErrorCode GatheredCreate(const State *state, Gathered *arrays);
PETSC_EXTERN PetscErrorCode GatheredDestroy(Gathered *arrays);

/* GatherState - copy the state's vectors into the arrays. ScatterState - copy the arrays into the state's vectors.
   Collective. */
PETSC_EXTERN PetscErrorCode GatherState(const State *state, Gathered *arrays);
PETSC_EXTERN PetscErrorCode ScatterState(const Gathered *arrays, const State *state);
