/* FFTW's wisdom, what it has measured about its plans, kept in a file from run to run (-fftw_wisdom). */
#pragma once
#include "scene/fluidspec.h"

/* WisdomInitialise - FFTW's MPI part, once: wisdom is read and planned with it alone. */
PETSC_EXTERN PetscErrorCode WisdomInitialise(void);

/* WisdomRead - a file on rank 0, if path names one that is there, told to all ranks; before any plan is made. A file
   that is not wisdom of this FFTW is a user's mistake. Collective. */
PETSC_EXTERN PetscErrorCode WisdomRead(MPI_Comm comm, const char path[]);

/* WisdomWrite - all ranks' wisdom into the file, through a temporary name, when the file lacks some of it; after all
   plans are made. Collective. */
PETSC_EXTERN PetscErrorCode WisdomWrite(MPI_Comm comm, const char path[]);
