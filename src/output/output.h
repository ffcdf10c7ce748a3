/* Everything that a run leaves on disk, all in -output_dir, and what it prints: the writers, and when each is due. */
#pragma once
#include "output/checkpoint.h"
#include "output/frames.h"
#include "output/progress.h"
#include "output/series.h"
#include "output/vesiclefile.h"
#include "output/xdmf.h"

typedef struct _p_Output *Output;
struct _p_Output {
  Scene scene;   /* borrowed */
  Scheme scheme; /* borrowed */
  Folder folder;
  Gathered now;  /* the present markers */
  Record record; /* the present numbers */
  Series series;
  VesicleFile vesicles; /* where they are many */
  Frames frames;
  Xdmf xdmf;
  Checkpoint checkpoint;
  Progress progress;
  PetscBool go_on;              /* the files go on after the checkpoint of -restart */
  PetscReal next;               /* time of the next saved frame */
  PetscReal checkpoint_seconds; /* longest that writing a checkpoint has taken */
};

/* OutputCreate - make the folder, open series.csv and run.h5, write resolved.opts; with -restart put the scheme into
   the checkpoint's state first. The folder may hold results already with -output_overwrite only, or when -restart names
   a checkpoint in it: then the files go on after the checkpoint's step. After an error what there is of the output is
   to be destroyed. Collective. */
PETSC_EXTERN PetscErrorCode OutputCreate(Scene scene, Scheme scheme, Output *output);

/* OutputDestroy - close every file and free everything. Collective; stops with one line, everything freed, when a file
   cannot be closed, unless it is known already that one could not be written. */
PETSC_EXTERN PetscErrorCode OutputDestroy(Output *output);

/* OutputBegin - the first row and frame; those of a checkpoint are there already, or (in a new folder) its row is. */
PETSC_EXTERN PetscErrorCode OutputBegin(Output output);

/* OutputStep - after a good step: its row, and the frame, the checkpoint and the progress line that are due. */
PETSC_EXTERN PetscErrorCode OutputStep(Output output);

/* OutputEnd - the end state, when no saved time fell on it, its checkpoint, and the summaries. reason: why the run
   ended; failure: why a step could not be taken, or NULL. */
PETSC_EXTERN PetscErrorCode OutputEnd(Output output, const char reason[], const char failure[]);

/* OutputCheckpoint - write checkpoint.h5, with all rows and frames before it on the disk. Does nothing when this run
   has written the present step's. */
PETSC_EXTERN PetscErrorCode OutputCheckpoint(Output output);
