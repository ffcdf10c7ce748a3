/* HDF5 files to which a run appends an entry at a time, run.h5 and vesicles.h5: a series /time and others of the same
   length.

   A file is created or opened, entries are set and added, flushed, and the file is closed. Readers count an entry when
   its time is in the file, which is written last, so that a file of a run under way has whole entries.

   HDF5 changes its tables in place: a process that is killed between two of these writes, or a machine that crashes,
   can leave a file that cannot be read. The values of entries never move. While a run writes, a text file beside it
   (run.h5.index) has a line an entry: its number, its time, and the byte at which it begins in each series. A run that
   finds an index copies the entries at these places into a new file. A run that closes the file removes the index.

   Rank 0 alone has the file and the index; a failure is told to all ranks (FolderCheck).

   Order: AppendedCreate, or AppendedOpen and AppendedGoOn; for each entry AppendedSet of every series, then
   AppendedAdd; AppendedClose. */
#pragma once
#include "output/folder.h"
#include "output/h5series.h"
#include "scheme/scheme.h"

#define APPENDED_SERIES 32
#define APPENDED_NAME 32

/* What an appended file holds. */
typedef struct {
  const char *name;    /* name of the file in the folder */
  const char *entries; /* what an entry is, in messages: "frames" */
  Scheme scheme;       /* borrowed */
  PetscErrorCode (*describe)(Scheme scheme,
                             H5File *file); /* writes attributes and what else is no series; collective */
  PetscInt series;                          /* number of series besides /time */
  char path[APPENDED_SERIES][APPENDED_NAME];
  PetscInt dims[APPENDED_SERIES][2]; /* rows and columns of an entry; 0 rows: an entry is one number */
  PetscBool single[APPENDED_SERIES]; /* values have single precision in the file */
} AppendedKind;

typedef struct {
  Folder *folder; /* borrowed */
  AppendedKind kind;
  H5File file;
  PetscBool open;      /* on every rank */
  FILE *index;         /* rank 0, when open */
  char index_name[64]; /* name of the index in the folder */
  PetscInt count;      /* entries in the file; the next entry is set and added at this place */
  PetscReal *time;     /* [count] times of the entries that AppendedGoOn has found; else NULL */
} AppendedFile;

/* AppendedAddSeries - one more series of a kind. Not collective. */
PETSC_EXTERN void AppendedAddSeries(AppendedKind *kind, const char path[], PetscInt rows, PetscInt columns,
                                    PetscBool single);

/* AppendedCreate - a new, empty file. Collective; stops with one line when the file cannot be written. */
PETSC_EXTERN PetscErrorCode AppendedCreate(AppendedFile *file, Folder *folder, const AppendedKind *kind);

/* AppendedOpen - the file of an earlier run. If that run was killed the file is made anew of its first `most` entries,
   or, with PETSC_MAX_INT, of all entries that can be read. length: number of entries; 0 when the file cannot be read.
   AppendedGoOn - cut the file to `count` entries and go on. Collective; both stop with one line, which names `restart`,
   when there are fewer entries or the file cannot be written. */
PETSC_EXTERN PetscErrorCode AppendedOpen(AppendedFile *file, Folder *folder, const AppendedKind *kind, PetscInt most,
                                         PetscInt *length);
PETSC_EXTERN PetscErrorCode AppendedGoOn(AppendedFile *file, PetscInt length, PetscInt count, const char restart[]);

/* AppendedSet - the next entry of a series. AppendedAdd - the time of the next entry, by which readers count it.
   Nothing is flushed. AppendedAdd is collective and stops with one line when the entry could not be written. */
PETSC_EXTERN void AppendedSet(AppendedFile *file, PetscInt series, const PetscReal values[]);
PETSC_EXTERN PetscErrorCode AppendedAdd(AppendedFile *file, PetscReal time);

/* AppendedFlush - hand everything to the system and, with sync, put it on the disk. Does nothing when the file is not
   open. Collective; stops with one line when the file cannot be written. */
PETSC_EXTERN PetscErrorCode AppendedFlush(AppendedFile *file, PetscBool sync);

/* AppendedClose - close the file, if it is open, and free everything. good: all of it was written, or a line has said
   that it was not; TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscErrorCode AppendedClose(AppendedFile *file, PetscBool *good);
