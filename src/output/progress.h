/* What a run prints on the terminal. */
#pragma once
#include "output/record.h"
#include "output/written.h"

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  PetscLogDouble start, printed; /* wall time at the start, at the last progress line */
} Progress;

PETSC_EXTERN PetscErrorCode ProgressStart(Progress *progress, MPI_Comm comm);

/* ProgressSeconds - wall seconds since the start. */
PETSC_EXTERN PetscReal ProgressSeconds(const Progress *progress);

/* ProgressLine - a line with step, time, percent of t_end and expected time left, at most every few seconds unless
   `force`. */
PETSC_EXTERN PetscErrorCode ProgressLine(Progress *progress, const State *state, PetscReal t_end, PetscBool force);

/* ProgressTable - the table that a run ends with: the last row, and what is in its folder. Collective. */
PETSC_EXTERN PetscErrorCode ProgressTable(const Progress *progress, const Record *record, const char folder[],
                                          const Written *written, const char reason[]);
