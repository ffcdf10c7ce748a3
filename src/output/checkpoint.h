/* checkpoint.h5: everything that a restart needs.

   The file has the scene's options and digests of its curve files, the numbers of CheckpointNumbers, and the vectors of
   the present state and of those before it: fields of the grid under <group>/fluid, markers under <group>/vesicle and
   <group>/obstacle. Behind the bytes of HDF5, which does not read past its own end, stands a line with the CRC-32 of
   all of them.

   A checkpoint is written under a temporary name, put on the disk and renamed, so that a complete checkpoint.h5 exists
   at every moment. Earlier ones are renamed to checkpoint_1.h5 and so on. Rank 0 has the file; the ranks send it their
   rows of the grid and gather the markers. */
#pragma once
#include "output/folder.h"
#include "output/h5series.h"
#include "output/record.h"
#include "output/tracers.h"

#define CHECKPOINT_FORMAT 9
#define CHECKPOINT_TAIL "petves checkpoint, crc32 %08x\n"
#define CHECKPOINT_TAIL_LENGTH 34

/* The numbers of a checkpoint. */
typedef struct {
  SchemeTimes times;
  PetscInt frames;    /* scheduled frames in run.h5 */
  PetscInt totals[4]; /* sums over the columns of series.csv: solves, tension, bending, coupled */
} CheckpointNumbers;

typedef struct {
  Folder *folder; /* borrowed */
  PetscInt keep;  /* checkpoints kept, the newest included */
  PetscInt step;  /* step of the newest checkpoint.h5 that this run wrote; -1: none */
} Checkpoint;

/* CheckpointWrite - write the scheme's state, the record, the tracers and the number of scheduled frames. Rows and
   frames up to the state must be on the disk. Collective; stops with one line when the checkpoint cannot be written,
   and the checkpoints before it are whole. */
PETSC_EXTERN PetscErrorCode CheckpointWrite(Checkpoint *checkpoint, Scheme scheme, const Record *record,
                                            Tracers *tracers, PetscInt frames);

/* CheckpointStore - a checkpoint of that step, which `write` fills in, under its name and with its checksum, as
   CheckpointWrite. Collective. */
PETSC_EXTERN PetscErrorCode CheckpointStore(Checkpoint *checkpoint, PetscInt step,
                                            PetscErrorCode (*write)(void *context, H5File *file), void *context);

/* CheckpointAdopt - the checkpoint that -restart names, if it is in the folder, becomes the newest one: later ones
   belong to steps that are taken anew. Collective; stops with one line when the file cannot be renamed. */
PETSC_EXTERN PetscErrorCode CheckpointAdopt(const Checkpoint *checkpoint, const char restart[]);

/* CheckpointClear - remove all checkpoints of the folder, on rank 0. Not collective. */
PETSC_EXTERN void CheckpointClear(Folder *folder);

/* CheckpointPutScene - the format and every option in force. Collective. */
PETSC_EXTERN PetscErrorCode CheckpointPutScene(H5File *file, Scene scene);

/* CheckpointEntry - write or read n entries of `each` numbers, the same on every rank, as <group>/<name>; n = 0 does
   nothing. CheckpointVectors - write or read the vectors of one state of group j: 0 the present state, then those
   before it. CheckpointTracers - write or read the tracers of the present state. CheckpointMoveNumbers - write or read
   the numbers; what a run cannot have had is refused with a line that names `restart`. When they read, an entry that is
   missing or has another size makes the file fail. Collective. */
PETSC_EXTERN PetscErrorCode CheckpointEntry(H5File *file, PetscBool write, const char name[], PetscInt n, PetscInt each,
                                            PetscReal values[]);
PETSC_EXTERN PetscErrorCode CheckpointVectors(H5File *file, PetscBool write, Scheme scheme, PetscInt j, State *state);
PETSC_EXTERN PetscErrorCode CheckpointTracers(H5File *file, PetscBool write, Scheme scheme, Tracers *tracers);
PETSC_EXTERN PetscErrorCode CheckpointMoveNumbers(H5File *file, PetscBool write, CheckpointNumbers *numbers);

/* RestartOpen - open the checkpoint that -restart names, whose bytes are those that its checksum is of, and whose
   options fit the scene. RestartEntries - stop unless all entries so far could be read. Collective; stop with one line.
 */
PETSC_EXTERN PetscErrorCode RestartOpen(Scene scene, H5File *file);
PETSC_EXTERN PetscErrorCode RestartEntries(Scene scene, const H5File *file);

/* RestartRead - the state of -restart's checkpoint, the record, the tracers and the number of scheduled frames as they
   were. Rank 0 checks the checksum, which covers every byte; then all ranks read. Numbers that a run cannot have had
   are refused. Collective; stops with one line when the checkpoint is missing, damaged, of another format or of another
   scene. */
PETSC_EXTERN PetscErrorCode RestartRead(Scheme scheme, Record *record, Tracers *tracers, PetscInt *frames);

/* CheckpointChecksum - CRC-32 of a file up to its last `tail` bytes, which are copied to `end`; false when the file
   cannot be read or is shorter. Not collective. */
PETSC_EXTERN PetscBool CheckpointChecksum(const char path[], long tail, unsigned *crc, char *end);
