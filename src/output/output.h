/* Everything that a run leaves on the disk, all in -output_dir, and what it prints: the writers, and when each is due.

   A row of series.csv and vesicles.h5 is due after every step, a frame of run.h5 and run.xmf at multiples of
   -output_every and at the end, a checkpoint every -checkpoint_every steps and at the end. Before a checkpoint is
   written all rows and frames up to its state are on the disk, so that a restart can cut the files to it. Rank 0 writes
   all files. What they hold is the model's (model.h).

   Order: OutputCreate, OutputBegin, OutputStep after each step, OutputEnd, OutputDestroy. */
#pragma once
#include "output/checkpoint.h"
#include "output/series.h"
#include "output/summary.h"
#include "output/vesiclefile.h"
#include "output/xdmf.h"

typedef struct _p_Output *Output;
struct _p_Output {
  const Model *model; /* borrowed */
  Folder folder;
  Record record; /* the present state in numbers */
  Series series;
  AppendedFile vesicles; /* vesicles.h5; open where vesicles are many */
  AppendedFile frames;   /* run.h5 */
  Xdmf xdmf;
  Checkpoint checkpoint;
  Summary summary;
  PetscBool go_on;              /* the files go on after the checkpoint of -restart */
  PetscInt scheduled;           /* frames at multiples of -output_every, the first included */
  PetscReal shown;              /* time of the last frame */
  PetscReal next;               /* time of the next frame at a multiple of -output_every */
  PetscReal checkpoint_seconds; /* longest that writing a checkpoint has taken */
};

/* OutputCreate - make the folder, open series.csv and run.h5, write resolved.opts; with -restart put the model into the
   checkpoint's state first. The folder may hold results already with -output_overwrite only, or when -restart names a
   checkpoint in it: then the files go on after the checkpoint's step. After an error the caller destroys what has been
   made. Collective. */
PETSC_EXTERN PetscErrorCode OutputCreate(const Model *model, Output *output);

/* OutputDestroy - close every file and free everything. Collective; stops with one line, with everything freed, when a
   file cannot be closed, unless a line has said already that a file could not be written. */
PETSC_EXTERN PetscErrorCode OutputDestroy(Output *output);

/* OutputBegin - the first row and frame. After a restart in its own folder they exist already; after a restart in a new
   folder the row exists. Collective. */
PETSC_EXTERN PetscErrorCode OutputBegin(Output output);

/* OutputStep - after a good step: its row, and the frame, the checkpoint and the progress line that are due.
   Collective. */
PETSC_EXTERN PetscErrorCode OutputStep(Output output);

/* OutputEnd - the checkpoint of the end state, its frame unless it was saved, and the summaries. reason: why the run
   ended; failure: why a step could not be taken, or NULL. Collective. */
PETSC_EXTERN PetscErrorCode OutputEnd(Output output, const char reason[], const char failure[]);

/* OutputCheckpoint - write checkpoint.h5. Does nothing when this run has written the checkpoint of the present step.
   Collective. */
PETSC_EXTERN PetscErrorCode OutputCheckpoint(Output output);
