/* checkpoint.h5: everything that a restart needs.

   The file has the scene's options, the last row of series.csv, and what the model writes: numbers of the run as
   attributes, arrays of the present state and of those before it as datasets. Behind the bytes of HDF5, which does not
   read past its own end, stands a line with the CRC-32 of all of them.

   A checkpoint is written under a temporary name, put on the disk and renamed, so that a complete checkpoint.h5 exists
   at every moment. Earlier ones are renamed to checkpoint_1.h5 and so on. Rank 0 has the file. */
#pragma once
#include "output/model.h"

#define CHECKPOINT_FORMAT 9
#define CHECKPOINT_TAIL "petves checkpoint, crc32 %08x\n"
#define CHECKPOINT_TAIL_LENGTH 34

typedef struct {
  Folder *folder; /* borrowed */
  PetscInt keep;  /* checkpoints kept, the newest included */
  PetscInt step;  /* step of the newest checkpoint.h5 that this run wrote; -1: none */
} Checkpoint;

/* CheckpointWrite - write the model's state, its row of series.csv and the number of scheduled frames. Rows and frames
   up to the state must be on the disk. Collective; stops with one line when the checkpoint cannot be written, and the
   checkpoints before it are whole. */
PETSC_EXTERN PetscErrorCode CheckpointWrite(Checkpoint *checkpoint, const Model *model, const char row[],
                                            PetscInt frames);

/* CheckpointAdopt - the checkpoint that -restart names, if it is in the folder, becomes the newest one: later ones
   belong to steps that are taken anew. Collective; stops with one line when the file cannot be renamed. */
PETSC_EXTERN PetscErrorCode CheckpointAdopt(const Checkpoint *checkpoint, const char restart[]);

/* CheckpointClear - remove all checkpoints of the folder, on rank 0. Not collective. */
PETSC_EXTERN void CheckpointClear(Folder *folder);

/* Numbers of a checkpoint: whole ones or real ones. */
typedef struct {
  const char *name;
  PetscReal least, most; /* allowed; most 0: all */
  PetscInt *whole;
  PetscReal *real;
  PetscInt count; /* 0: one number */
} CheckpointNumber;

/* CheckpointMoveNumbers - write or read numbers; what a run cannot have had is refused with a line that names the file.
   CheckpointEntry - write or read n entries of `each` numbers, the same on every rank, as the dataset `name`; n = 0
   does nothing. When they read, an entry that is missing or has another size makes the file fail. Collective. */
PETSC_EXTERN PetscErrorCode CheckpointMoveNumbers(H5File *file, PetscBool write, PetscInt numbers,
                                                  const CheckpointNumber number[]);
PETSC_EXTERN PetscErrorCode CheckpointEntry(H5File *file, PetscBool write, const char name[], PetscInt n, PetscInt each,
                                            PetscReal values[]);

/* CheckpointFinite - the file fails unless all of n values that have been read, the same on every rank, are finite. Not
   collective. */
PETSC_EXTERN void CheckpointFinite(H5File *file, PetscInt n, const PetscReal values[]);

/* RestartRead - the state of -restart's checkpoint, the record and the number of scheduled frames as they were. Rank 0
   checks the checksum, which covers every byte; then all ranks read. Numbers that a run cannot have had are refused.
   Collective; stops with one line when the checkpoint is missing, damaged, of another format or of another scene. */
PETSC_EXTERN PetscErrorCode RestartRead(const Model *model, Record *record, PetscInt *frames);

/* RestartEntries - stop unless all entries so far could be read. Collective; stops with one line. */
PETSC_EXTERN PetscErrorCode RestartEntries(Scene scene, const H5File *file);

/* CheckpointChecksum - CRC-32 of a file up to its last `tail` bytes, which are copied to `end`; false when the file
   cannot be read or is shorter. Not collective. */
PETSC_EXTERN PetscBool CheckpointChecksum(const char path[], long tail, unsigned *crc, char *end);
