/* checkpoint.h5: everything that a restart needs, and a checksum of all its bytes behind them. */
#pragma once
#include "output/folder.h"
#include "output/record.h"

/* Where a checkpoint has the states before the present one. */
static inline const char *CheckpointGroup(PetscInt j) {
  static const char *const groups[] = {"/previous", "/previous_1", "/previous_2", "/previous_3", "/previous_4"};
  return groups[j];
}

typedef struct {
  Folder *folder; /* borrowed */
  PetscInt keep;  /* checkpoints kept, the newest included */
  PetscInt step;  /* of the newest checkpoint.h5 that this run wrote; -1 none */
} Checkpoint;

PETSC_EXTERN PetscErrorCode CheckpointCreate(Checkpoint *checkpoint, Folder *folder, PetscInt keep);

/* CheckpointWrite - the scheme's state, the record and the number of scheduled frames: to a temporary name, with a
   checksum at its end, all of it on the disk, then renamed. The ones before it become checkpoint_1.h5 and so on. Rows
   and frames that belong to it must be on the disk. Collective; stops with one line when it cannot be written, and the
   checkpoints before it are whole. */
PETSC_EXTERN PetscErrorCode CheckpointWrite(Checkpoint *checkpoint, Scheme scheme, const Record *record,
                                            PetscInt frames);

/* CheckpointAdopt - the checkpoint that -restart names in the folder becomes its newest: later ones belong to steps
   that are taken anew. Collective; stops with one line when that fails. */
PETSC_EXTERN PetscErrorCode CheckpointAdopt(const Checkpoint *checkpoint, const char restart[]);

/* CheckpointClear - remove all checkpoints of the folder, on rank 0. */
PETSC_EXTERN PetscErrorCode CheckpointClear(Folder *folder);
