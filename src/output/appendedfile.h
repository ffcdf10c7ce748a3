/* HDF5 files to which a run appends an entry at a time, run.h5 and vesicles.h5: a series /time and others of the same
   length.

   A file is created or opened, entries are set and added, flushed, and the file is closed. Readers count an entry when
   its time is in the file, which is written last, so that a file of a run under way has whole entries.

   HDF5 changes its tables in place: a process that is killed between two of these writes, or a machine that crashes,
   can leave a file that cannot be read. The values of entries never move. While a run writes, a text file beside it
   (run.h5.index) has a line an entry: its number, its time, and the byte at which it begins in each series. A run that
   finds an index copies the entries at these places into a new file. A run that closes the file removes the index.

   Rank 0 alone has the file and the index; a failure is told to all ranks (FolderCheck).

   Order: AppendedOpen; for each entry AppendedSet of every series, then AppendedAdd; AppendedClose. */
#pragma once
#include "output/folder.h"
#include "output/h5series.h"

#define APPENDED_SERIES 32
#define APPENDED_NAME 32

/* One series besides /time. */
typedef struct {
  char path[APPENDED_NAME];
  PetscInt rows, columns; /* of an entry; 0 rows: an entry is one number */
  PetscBool single;       /* values have single precision in the file */
  const char *unit;       /* its attribute; NULL: none */
} AppendedSeries;

/* What an appended file holds. */
typedef struct {
  const char *name;    /* name of the file in the folder */
  const char *entries; /* what an entry is, in messages: "frames" */
  PetscReal now;       /* no entry of an earlier run is later */
  const void *context; /* of */
  PetscErrorCode (*describe)(const void *context,
                             H5File *file); /* writes attributes and what else is no series; collective */
  PetscInt n;                               /* number of series */
  AppendedSeries series[APPENDED_SERIES];
} AppendedKind;

/* AppendedAddSeries - one more series. Not collective. */
static inline void AppendedAddSeries(AppendedKind *kind, AppendedSeries series) {
  kind->series[kind->n++] = series;
}

typedef struct {
  Folder *folder; /* borrowed */
  AppendedKind kind;
  H5File file;
  PetscBool open;      /* on every rank */
  FILE *index;         /* rank 0, when open */
  char index_name[64]; /* name of the index in the folder */
  PetscInt count;      /* entries in the file; the next entry is set and added at this place */
  PetscReal *time;     /* [count] times of the entries that AppendedOpen has found; else NULL */
} AppendedFile;

/* APPENDED_NEW instead of a number of entries: the file is new. */
#define APPENDED_NEW (-1)

/* AppendedOpen - a new, empty file, or the file of an earlier run, cut to its first `count` entries; if that run was
   killed the file is made anew of these entries first. Collective; stops with one line, which names `restart`, when the
   file cannot be written or has fewer entries up to the present time. */
PETSC_EXTERN PetscErrorCode AppendedOpen(AppendedFile *file, Folder *folder, const AppendedKind *kind, PetscInt count,
                                         const char restart[]);

/* AppendedSet - the next entry of a series. AppendedAdd - the time of the next entry, by which readers count it.
   Nothing is flushed. AppendedAdd is collective and stops with one line when the entry could not be written. */
PETSC_EXTERN void AppendedSet(AppendedFile *file, PetscInt series, PetscReal values[]);
PETSC_EXTERN PetscErrorCode AppendedAdd(AppendedFile *file, PetscReal time);

/* AppendedFlush - hand everything to the system and, with sync, put it on the disk. Does nothing when the file is not
   open. Collective; stops with one line when the file cannot be written. */
PETSC_EXTERN PetscErrorCode AppendedFlush(AppendedFile *file, PetscBool sync);

/* AppendedClose - close the file, if it is open, and free everything. good: all of it was written, or a line has said
   that it was not; TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscErrorCode AppendedClose(AppendedFile *file, PetscBool *good);
