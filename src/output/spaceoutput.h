/* What a run in three dimensions leaves on the disk, with the writers of runs in the plane: series.csv, run.h5 with the
   surfaces at the saved times, run.xmf, checkpoint.h5, resolved.opts and summary.json.

   run.h5 has of each frame the points of all vesicles, a grid of the degree p with both poles, with velocity and
   tension there, and the coefficients [vesicle][3][count] of spherical harmonics (sphere/harmonics.h).

   Order: SpaceOutputCreate, SpaceOutputBegin, SpaceOutputStep after each step, SpaceOutputEnd, SpaceOutputDestroy. All
   are collective. */
#pragma once
#include "output/checkpoint.h"
#include "output/series.h"
#include "output/spacerecord.h"
#include "output/summary.h"
#include "output/xdmf.h"

typedef struct _p_SpaceOutput *SpaceOutput;
struct _p_SpaceOutput {
  Scene scene; /* borrowed */
  Space space; /* borrowed */
  Folder folder;
  SpaceRecord record;
  Series series;
  AppendedFile frames;
  Xdmf xdmf;
  Checkpoint checkpoint;
  ProgressClock clock;
  PetscBool go_on;                  /* the files go on after the checkpoint of -restart */
  PetscInt scheduled;               /* frames at multiples of -output_every, the first included */
  PetscReal shown;                  /* time of the last frame */
  PetscReal next;                   /* time of the next one */
  PetscReal checkpoint_seconds;     /* longest that writing a checkpoint has taken */
  PetscInt points;                  /* of a vesicle in frames */
  PetscReal *Y;                     /* [count][points] harmonics there */
  char warning[PETVES_MAX_MESSAGE]; /* that harmonics do not resolve a shape; empty: none */
  const char *reason;               /* why the run has ended */
};

PETSC_EXTERN PetscErrorCode SpaceOutputCreate(Scene scene, Space space, SpaceOutput *output);
PETSC_EXTERN PetscErrorCode SpaceOutputDestroy(SpaceOutput *output);
PETSC_EXTERN PetscErrorCode SpaceOutputBegin(SpaceOutput output);
PETSC_EXTERN PetscErrorCode SpaceOutputStep(SpaceOutput output);
PETSC_EXTERN PetscErrorCode SpaceOutputEnd(SpaceOutput output, const char reason[], const char failure[]);

/* SpaceFramesOpen, SpaceFramesWrite - run.h5 (spaceframes.c): a new file, or one cut to output->scheduled frames; a
   frame of the present state. SpaceFramesPrint - one in run.xmf. */
PETSC_EXTERN PetscErrorCode SpaceFramesOpen(SpaceOutput output);
PETSC_EXTERN PetscErrorCode SpaceFramesWrite(SpaceOutput output, PetscBool scheduled);
PETSC_EXTERN void SpaceFramesPrint(const void *output, FILE *file, PetscInt frame, PetscReal time);

/* SpaceCheckpoint - write checkpoint.h5. SpaceRestart - the state of -restart's checkpoint and output->scheduled
   (spacecheckpoint.c). */
PETSC_EXTERN PetscErrorCode SpaceCheckpoint(SpaceOutput output);
PETSC_EXTERN PetscErrorCode SpaceRestart(SpaceOutput output);
