/* run.h5: the fields at cell centres and the markers, per saved time. */
#pragma once
#include "output/framefile.h"
#include "output/gathered.h"

typedef struct {
  Scheme scheme; /* borrowed */
  Growing grown;
  PetscInt scheduled;    /* frames at multiples of -output_every, the first included */
  PetscReal time;        /* of the last frame */
  PetscScalar *cells[3]; /* u, v, p at cell centres, this rank's rows */
  PetscReal *force;      /* [W][2] on obstacles, as their curves are seen; work */
} Frames;

/* FramesCreate - a new, empty file. FramesGoOn - the one of an earlier run, repaired where that was killed and cut to
   its first `scheduled` frames, whose times are in `grown`: a frame that was saved only because that run ended goes.
   Stops with one line, naming `restart`, when there are not so many. Collective. */
PETSC_EXTERN PetscErrorCode FramesCreate(Frames *frames, Folder *folder, Scheme scheme);
PETSC_EXTERN PetscErrorCode FramesGoOn(Frames *frames, Folder *folder, Scheme scheme, PetscInt scheduled,
                                       const char restart[]);

/* FramesWrite - add the scheme's present fields, and its markers as gathered; scheduled: a saved time of -output_every,
   not only the end of this run. An unscheduled frame is written over by the next one, where a run goes on after its
   end. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode FramesWrite(Frames *frames, const Gathered *now, PetscBool scheduled);

/* FramesMarkers - markers[frames][2 M] of the frames that FramesGoOn has found, to be freed. Collective. */
PETSC_EXTERN PetscErrorCode FramesMarkers(Frames *frames, PetscReal **markers);

/* FramesSync - put all of it on the disk. Collective; stops with one line when it cannot be written. */
PETSC_EXTERN PetscErrorCode FramesSync(Frames *frames);

/* FramesClose - close the file and free everything; good: all of it was written, or an error of it is known already.
   Rank 0 closes, and good is TRUE elsewhere. */
PETSC_EXTERN PetscErrorCode FramesClose(Frames *frames, PetscBool *good);
