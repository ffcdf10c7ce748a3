/* What the bench programs share: numbers printed as one JSON object a line. */
#pragma once
#include "world.h"

/* "name": [values], */
static inline void PrintList(const char name[], PetscInt n, const PetscReal values[]) {
  printf("\"%s\": [", name);
  for (PetscInt i = 0; i < n; i++) printf("%s%.6g", i ? ", " : "", (double)values[i]);
  printf("]");
}

/* Seconds since `start`, of the slowest rank. Collective. */
static inline PetscErrorCode Elapsed(PetscLogDouble start, PetscReal *seconds) {
  PetscLogDouble now;
  PetscFunctionBeginUser;
  PetscCall(PetscTime(&now));
  *seconds = now - start;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, seconds, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Start together. */
static inline PetscErrorCode Begin(PetscLogDouble *start) {
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
  PetscCall(PetscTime(start));
  PetscFunctionReturn(PETSC_SUCCESS);
}
