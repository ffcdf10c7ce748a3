/* vesicles.h5: what many vesicles have of their own, a row a step: /step and /time [rows], and a dataset [rows,
   vesicles] for each of RecordVesicleColumns. A scene of few has it in series.csv instead, and then every call does
   nothing. */
#pragma once
#include "output/growing.h"
#include "output/record.h"

#define VESICLE_NAME 32

typedef struct {
  Growing grown;
  const char *path[GROWING_SERIES]; /* of the datasets: /step, and those of the columns */
  char name[GROWING_SERIES][VESICLE_NAME];
  PetscReal *values; /* [vesicles] of a column */
} VesicleFile;

/* VesicleFileCreate - a new, empty file. VesicleFileGoOn - the one of an earlier run, repaired where that was killed
   and cut behind the row of `step`. Collective; stop with one line, which names `restart`, when it lacks that row or
   cannot be written. */
PETSC_EXTERN PetscErrorCode VesicleFileCreate(VesicleFile *file, Folder *folder, Scheme scheme);
PETSC_EXTERN PetscErrorCode VesicleFileGoOn(VesicleFile *file, Folder *folder, Scheme scheme, PetscInt step,
                                            const char restart[]);

/* VesicleFileWrite - a row of the step's record. It is in the file after VesicleFileFlush; with sync it is on the disk.
   Collective; stop with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode VesicleFileWrite(VesicleFile *file, const Record *record, PetscInt step, PetscReal time);
PETSC_EXTERN PetscErrorCode VesicleFileFlush(VesicleFile *file, PetscBool sync);

/* VesicleFileClose - close the file; good: all of it was written. Rank 0 closes, and good is TRUE elsewhere. */
PETSC_EXTERN PetscErrorCode VesicleFileClose(VesicleFile *file, PetscBool *good);
