/* series.csv: a row a step. */
#pragma once
#include "output/folder.h"

typedef struct {
  Folder *folder; /* borrowed */
  FILE *file;     /* rank 0, when open */
} Series;

/* SeriesPrepare - the new series.csv under a temporary name: the header and, unless it is "", a first row. SeriesCut -
   the one that is there, up to the row of `step`, under a temporary name; stops with one line that names `restart` when
   it has other columns or lacks the row. Collective. */
PETSC_EXTERN PetscErrorCode SeriesPrepare(Series *series, Folder *folder, const char header[], const char row[]);
PETSC_EXTERN PetscErrorCode SeriesCut(Series *series, Folder *folder, const char header[], PetscInt step,
                                      const char restart[]);

/* SeriesOpen - the prepared file takes its name and is open for further rows. Collective. */
PETSC_EXTERN PetscErrorCode SeriesOpen(Series *series);

/* SeriesWrite - add a row. It is in the file after SeriesFlush; with sync it is on the disk. SeriesFlush is collective
   and stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode SeriesWrite(Series *series, const char row[]);
PETSC_EXTERN PetscErrorCode SeriesFlush(Series *series, PetscBool sync);

/* SeriesClose - close the file; good: all of it was written. Rank 0 closes, and good is TRUE elsewhere. */
PETSC_EXTERN PetscErrorCode SeriesClose(Series *series, PetscBool *good);
