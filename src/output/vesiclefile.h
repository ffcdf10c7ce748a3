/* vesicles.h5: the columns that each vesicle has of its own, where vesicles are too many for series.csv.

   vesicles.h5 is an appended file whose entries are rows, one a step (appendedfile.h): /step and /time [rows], and a
   series [rows, vesicles] for each of RecordVesicleColumns. With at most RECORD_FEW vesicles there is no file, and
   every call does nothing. The values are the same on every rank. */
#pragma once
#include "output/appendedfile.h"
#include "output/record.h"

/* VesicleFileCreate - a new, empty file. VesicleFileGoOn - the file of an earlier run, cut behind the row of `step`.
   Collective; both stop with one line, which names `restart`, when the row is missing or the file cannot be written.
   The file is flushed and closed by AppendedFlush and AppendedClose. */
PETSC_EXTERN PetscErrorCode VesicleFileCreate(AppendedFile *file, Folder *folder, Scheme scheme);
PETSC_EXTERN PetscErrorCode VesicleFileGoOn(AppendedFile *file, Folder *folder, Scheme scheme, PetscInt step,
                                            const char restart[]);

/* VesicleFileWrite - the row of a step's record. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode VesicleFileWrite(AppendedFile *file, const Record *record, PetscInt step, PetscReal time);
