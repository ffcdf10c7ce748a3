/* run.h5: velocity and pressure at cell centres and the markers, at the saved times.

   run.h5 is an appended file whose entries are frames (appendedfile.h): three series of the fluid, three of the
   vesicles where there are any, the force on obstacles where there are any, their markers where they move, and tracers.
   Each rank sends its rows of the fluid's fields to rank 0; markers are on every rank. */
#pragma once
#include "output/appendedfile.h"
#include "output/gathered.h"
#include "output/tracers.h"

typedef struct {
  const Tracers *tracers; /* borrowed, set before FramesOpen */
  Scheme scheme;          /* borrowed */
  AppendedFile file;
  PetscInt scheduled;    /* frames at multiples of -output_every, the first included */
  PetscReal time;        /* time of the last frame */
  PetscScalar *cells[3]; /* u, v, p at cell centres of this rank's rows */
  PetscReal *all;        /* values of all ranks; work */
} Frames;

/* FramesAreWrapped - whether the file has the markers by whole periods in the box too: where the box is periodic. Not
   collective. */
PETSC_EXTERN PetscBool FramesAreWrapped(Scheme scheme);

/* FramesOpen - a new, empty file (`scheduled` APPENDED_NEW), or the file of an earlier run, cut to its first
   `scheduled` frames by AppendedOpen: a frame that was saved only because that run ended goes. Collective. */
PETSC_EXTERN PetscErrorCode FramesOpen(Frames *frames, Folder *folder, Scheme scheme, PetscInt scheduled,
                                       const char restart[]);

/* FramesWrite - add a frame of the scheme's present state. scheduled: the time is one
   of -output_every, not only the end of this run. The next frame replaces a frame that is not scheduled, where a run
   goes on after its end. Collective; stops with one line when the frame cannot be written. */
PETSC_EXTERN PetscErrorCode FramesWrite(Frames *frames, PetscBool scheduled);

/* FramesPrintXdmf - one frame in run.xmf (Xdmf.print; framesxdmf.c). Not collective. */
PETSC_EXTERN void FramesPrintXdmf(const void *frames, FILE *file, PetscInt frame, PetscReal time);

/* FramesClose - close the file and free everything. good: all of it was written, or a line has said that it was not;
   TRUE on ranks other than 0. Not collective. */
PETSC_EXTERN PetscErrorCode FramesClose(Frames *frames, PetscBool *good);
