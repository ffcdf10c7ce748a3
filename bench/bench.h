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
static inline void Elapsed(PetscLogDouble start, PetscReal *seconds) {
  PetscLogDouble now;
  TestCall(PetscTime(&now));
  *seconds = now - start;
  TestCall(MPI_Allreduce(MPI_IN_PLACE, seconds, 1, MPIU_REAL, MPI_MAX, PETSC_COMM_WORLD));
}

/* Start together. */
static inline void Begin(PetscLogDouble *start) {
  TestCall(MPI_Barrier(PETSC_COMM_WORLD));
  TestCall(PetscTime(start));
}
