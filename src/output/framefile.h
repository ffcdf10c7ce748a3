/* run.h5 as a file: its attributes and series, whose entries are the frames. */
#pragma once
#include "output/growing.h"

/* All series that a frame may have: three of the fluid, then three of vesicles, then one of obstacles where there are
   any, and another one where they move. */
enum { FRAME_FLUID, FRAME_VESICLES = 3, FRAME_FORCE = 6, FRAME_SOLIDS, FRAME_SERIES };
PETSC_EXTERN const char *const FrameSeries[FRAME_SERIES];

/* FrameKind - run.h5 for this scheme: its series, and how an empty one is made. */
PETSC_EXTERN PetscErrorCode FrameKind(Scheme scheme, GrowingKind *kind);
