/* What a run says of itself: resolved.opts, progress lines on the terminal, and at its end a table on the terminal and
   summary.json. Rank 0 prints and writes; its clock counts. */
#pragma once
#include "output/model.h"

/* The caller fills in what is borrowed; else zero. */
typedef struct {
  Folder *folder;         /* borrowed */
  const Model *model;     /* borrowed */
  const Record *record;   /* borrowed */
  PetscInt frames;        /* in run.h5, when the run ends */
  const char *reason;     /* why the run has ended: "finished", "steady", "stopped", or the failure */
  double bytes_h5;        /* size of run.h5, when the run ends */
  double bytes;           /* of run.h5, run.xmf, series.csv, vesicles.h5 and the checkpoints */
  PetscReal seconds;      /* wall time of the run, when it ends */
  PetscReal from;         /* simulated time at the start */
  PetscLogDouble start;   /* wall time at the start */
  PetscLogDouble printed; /* and at the last progress line */
} Summary;

/* SummaryBegin - the run starts now: write resolved.opts, every option in force, with which the run is repeated.
   SummaryProgress - print step, time, percent of -time_end and the time that is left, at most every few seconds unless
   `force`. SummaryEnd - write summary.json, print the last progress line and the table that a run ends with; failure:
   why a step could not be taken, or NULL. Collective; files that cannot be written stop with one line. */
PETSC_EXTERN PetscErrorCode SummaryBegin(Summary *summary);
PETSC_EXTERN PetscErrorCode SummaryProgress(Summary *summary, PetscBool force);
PETSC_EXTERN PetscErrorCode SummaryEnd(Summary *summary, PetscInt frames, const char reason[], const char failure[]);
