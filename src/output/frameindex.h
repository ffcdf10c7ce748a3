/* run.h5.index: where in run.h5 the frames lie, while a run writes on it. HDF5 changes its tables in place, so that a
   process that is killed can leave a file that cannot be read, or not be written on. The frames themselves never move:
   with their places they are copied into a new file. A run that closes run.h5 removes the index. */
#pragma once
#include "output/folder.h"
#include "output/framefile.h"

typedef struct {
  Folder *folder; /* borrowed */
  Scheme scheme;  /* borrowed */
  FILE *file;     /* rank 0, when open */
} FrameIndex;

/* FrameIndexOpen - write the index of the frames so far, with their times, and go on with it. FrameIndexAppend - a
   further frame, whose values are in run.h5. Both collective; they stop with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode FrameIndexOpen(FrameIndex *index, Folder *folder, Scheme scheme, H5File *fields,
                                           PetscInt frames, const PetscReal times[]);
PETSC_EXTERN PetscErrorCode FrameIndexAppend(FrameIndex *index, H5File *fields, PetscInt frame, PetscReal time);

/* FrameIndexSync - 0 when all of it is on the disk. FrameIndexClose - the end of it; whole: run.h5 is closed and good,
   so that the index goes. Rank 0's. */
PETSC_EXTERN int FrameIndexSync(FrameIndex *index);
PETSC_EXTERN PetscErrorCode FrameIndexClose(FrameIndex *index, PetscBool whole);

/* FrameIndexRepair - where a run was killed (its index is there): run.h5 anew, of its first `frames` frames. Stops with
   one line when that cannot be written; frames that cannot be read leave run.h5 as it is. Collective. */
PETSC_EXTERN PetscErrorCode FrameIndexRepair(Folder *folder, Scheme scheme, PetscInt frames);
