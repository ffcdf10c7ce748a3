/* What a run says of itself: resolved.opts, progress lines on the terminal, and at its end a table on the terminal and
   summary.json. Rank 0 prints and writes; its clock counts. */
#pragma once
#include "output/folder.h"
#include "output/record.h"

/* The clock of a run. */
typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank;
  PetscReal from;                /* simulated time at the start */
  PetscLogDouble start, printed; /* wall time at the start and at the last progress line */
} Progress;

/* ProgressStart - the run starts now, at the simulated time t. ProgressSeconds - wall seconds since the start.
   ProgressLine - print step, time, percent of t_end and the time that is left, at most every few seconds unless
   `force`. Not collective. */
PETSC_EXTERN void ProgressStart(Progress *progress, MPI_Comm comm, PetscReal t);
PETSC_EXTERN PetscReal ProgressSeconds(const Progress *progress);
PETSC_EXTERN void ProgressLine(Progress *progress, const State *state, PetscReal t_end, PetscBool force);

/* What a run has on the disk. */
typedef struct {
  PetscInt frames; /* in run.h5 */
  double h5;       /* bytes of run.h5 */
  double all;      /* bytes of run.h5, run.xmf, series.csv, vesicles.h5 and the checkpoints */
} DiskUsage;

/* DiskUsageCount - sizes of the files in the folder, on rank 0; zeros on other ranks. Not collective. */
PETSC_EXTERN void DiskUsageCount(const Folder *folder, PetscInt frames, PetscInt checkpoints, DiskUsage *usage);

/* SummaryResolved - write resolved.opts: every option in force, with which the run is repeated. SummaryTable - print
   the table that a run ends with. SummaryWrite - write summary.json. seconds: wall time of the run; reason: why it
   ended ("finished", "steady", "stopped", or the failure). Collective; files that cannot be written stop with one line.
 */
PETSC_EXTERN PetscErrorCode SummaryResolved(Folder *folder, Scheme scheme);
PETSC_EXTERN PetscErrorCode SummaryTable(const Folder *folder, const Record *record, const DiskUsage *usage,
                                         PetscReal seconds, const char reason[]);
PETSC_EXTERN PetscErrorCode SummaryWrite(Folder *folder, Scheme scheme, const Record *record, const DiskUsage *usage,
                                         PetscReal seconds, const char reason[]);
