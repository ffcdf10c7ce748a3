/* summary.json: why the run ended, its last row, its totals and times. */
#pragma once
#include "output/folder.h"
#include "output/record.h"
#include "output/written.h"

/* SummaryWrite - seconds: wall time of the run; reason: why it ended ("finished", "steady", "stopped", or the failure).
   Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode SummaryWrite(Folder *folder, Scheme scheme, const Record *record, const Written *written,
                                         PetscReal seconds, const char reason[]);
