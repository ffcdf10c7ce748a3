/* HDF5 files to which a run adds an entry at a time, run.h5 and vesicles.h5, and beside each an index, run.h5.index:
   where the entries lie, while a run writes on it. HDF5 changes its tables in place, so that a process that is killed
   can leave a file that cannot be read, or not be written on. The entries themselves never move: with their places they
   are copied into a new file. A run that closes the file removes the index. */
#pragma once
#include "output/folder.h"
#include "output/h5.h"
#include "scheme/scheme.h"

#define GROWING_SERIES 32

/* What such a file holds. create - the file with its attributes and empty series, /time among them; what went wrong is
   kept in the file. Collective. */
typedef struct {
  const char *name;                 /* of the file */
  PetscInt series;                  /* beside /time */
  const char *const *path;          /* [series] */
  PetscInt entries[GROWING_SERIES]; /* numbers in an entry of each, */
  PetscBool single[GROWING_SERIES]; /* in single precision */
  Scheme scheme;                    /* borrowed */
  PetscErrorCode (*create)(Scheme scheme, const char path[], H5File *file);
} GrowingKind;

typedef struct {
  Folder *folder; /* borrowed */
  GrowingKind kind;
  H5File file;
  PetscBool open;  /* on every rank */
  FILE *index;     /* rank 0, when open */
  PetscInt count;  /* entries in the file; an entry is written at this place */
  PetscReal *time; /* [count] of the entries that GrowingGoOn has found; else NULL */
} Growing;

/* GrowingCreate - a new, empty file. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode GrowingCreate(Growing *growing, Folder *folder, const GrowingKind *kind);

/* GrowingOpen - the file of an earlier run, repaired where that was killed: then of its first `most` entries, or those
   that can be read. length: how many there are; 0 when it cannot be read. GrowingGoOn - cut it to `count` of them and
   go on. what: the entries in the user's words. Both collective; they stop with one line, which names `restart`, when
   there are not so many or the file cannot be written. */
PETSC_EXTERN PetscErrorCode GrowingOpen(Growing *growing, Folder *folder, const GrowingKind *kind, PetscInt most,
                                        PetscInt *length);
PETSC_EXTERN PetscErrorCode GrowingGoOn(Growing *growing, PetscInt length, PetscInt count, const char what[],
                                        const char restart[]);

/* GrowingAppend - the entry at `count`, whose values are in the file, is of this time: with that readers count it.
   Nothing is flushed. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode GrowingAppend(Growing *growing, PetscReal time);

/* GrowingFlush - hand everything to the system; sync: and put it on the disk. Collective; stops with one line when it
   cannot be written. */
PETSC_EXTERN PetscErrorCode GrowingFlush(Growing *growing, PetscBool sync);

/* GrowingClose - close the file and free everything; good: all of it was written, or an error of it is known already.
   Rank 0 closes, and good is TRUE elsewhere. */
PETSC_EXTERN PetscErrorCode GrowingClose(Growing *growing, PetscBool *good);
