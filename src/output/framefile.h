/* run.h5 as a file: its attributes and series, whose entries are the frames. */
#pragma once
#include "output/h5.h"
#include "scheme/scheme.h"

/* The series of a frame; without vesicles the fluid's three. FRAME_SERIES - the most that there are. */
#define FRAME_SERIES 6
PETSC_EXTERN const char *const FrameSeries[FRAME_SERIES];
PETSC_EXTERN PetscInt FrameSeriesCount(Scheme scheme);

/* FrameEntries - numbers in one frame of series k. */
PETSC_EXTERN PetscInt FrameEntries(Scheme scheme, PetscInt k);

/* FrameIsSingle - whether series k is in single precision. */
PETSC_EXTERN PetscBool FrameIsSingle(Scheme scheme, PetscInt k);

/* FrameFileCreate - a file with the attributes and the empty series of run.h5. Collective; what went wrong is kept in
   the file. */
PETSC_EXTERN PetscErrorCode FrameFileCreate(Scheme scheme, const char path[], H5File *file);
