/* vesicles.h5: the columns that each vesicle has of its own, where vesicles are too many for series.csv.

   vesicles.h5 is an appended file whose entries are rows, one a step (appendedfile.h): /step and /time [rows], and a
   series [rows, vesicles] for each column that vesicles have of their own (record.h). With at most RECORD_FEW vesicles
   there is no file, and every call does nothing. The values are the same on every rank. */
#pragma once
#include "output/appendedfile.h"
#include "output/record.h"

/* VesicleFileOpen - a new, empty file, or that of an earlier run, which has reached the time `now`, cut to its first
   `rows` rows, by AppendedOpen. The file is flushed and closed by AppendedFlush and AppendedClose. Collective. */
PETSC_EXTERN PetscErrorCode VesicleFileOpen(AppendedFile *file, Folder *folder, const RecordSetting *columns,
                                            PetscReal now, PetscInt rows, const char restart[]);

/* VesicleFileWrite - the row of a step's record. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode VesicleFileWrite(AppendedFile *file, const Record *record, PetscInt step, PetscReal time);
