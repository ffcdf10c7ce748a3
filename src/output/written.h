/* How much a run has on the disk. */
#pragma once
#include "output/folder.h"

typedef struct {
  PetscInt frames; /* in run.h5 */
  double h5,
      all; /* bytes: run.h5, and what else a run writes with it (series.csv, run.xmf, vesicles.h5, checkpoints) */
} Written;

/* WrittenCount - look at the files of the folder, on rank 0; zeros elsewhere. Not collective. */
PETSC_EXTERN PetscErrorCode WrittenCount(Folder *folder, PetscInt frames, PetscInt checkpoints, Written *written);
