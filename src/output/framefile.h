/* run.h5 as a file: its attributes and series, whose entries are the frames. */
#pragma once
#include "output/growing.h"

/* The series of a frame; without vesicles the fluid's three. FRAME_SERIES - the most that there are. */
#define FRAME_SERIES 6
PETSC_EXTERN const char *const FrameSeries[FRAME_SERIES];

/* FrameKind - run.h5 for this scheme: its series, and how an empty one is made. */
PETSC_EXTERN PetscErrorCode FrameKind(Scheme scheme, GrowingKind *kind);
