/* series.csv: a header, then a row a step. Rank 0 has the file; every row is handed to the system at once. A file that
   goes on is copied up to a step under a temporary name first, so that nothing of an earlier run is lost before all of
   its files have been checked.

   Order: SeriesCut where the file goes on, SeriesOpen, SeriesWrite and SeriesFlush, SeriesClose. */
#pragma once
#include "output/folder.h"

typedef struct {
  Folder *folder; /* borrowed */
  FILE *file;     /* rank 0, when open */
  PetscBool cut;  /* a copy of an earlier run's file waits to take its name */
} Series;

/* SeriesCut - a copy of the file in the folder, up to the row of `step`, and the number of these rows; stops with one
   line, which names `restart`, when the file has other columns or lacks the row. SeriesOpen - this copy, or else a new
   file of the header and, unless it is "", a first row, has the name series.csv and is open for further rows.
   Collective. */
PETSC_EXTERN PetscErrorCode SeriesCut(Series *series, Folder *folder, const char header[], PetscInt step,
                                      const char restart[], PetscInt *rows);
PETSC_EXTERN PetscErrorCode SeriesOpen(Series *series, Folder *folder, const char header[], const char row[]);

/* SeriesWrite - add a row; not collective. SeriesFlush - hand the rows to the system and, with sync, put them on the
   disk. Collective; stops with one line when a row could not be written. */
PETSC_EXTERN void SeriesWrite(Series *series, const char row[]);
PETSC_EXTERN PetscErrorCode SeriesFlush(Series *series, PetscBool sync);

/* SeriesClose - close the file; whether all of it was written, TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscBool SeriesClose(Series *series);
