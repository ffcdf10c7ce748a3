/* FFTW's wisdom, what it has measured about its plans, kept in a file from run to run (-fftw_wisdom). */
#pragma once
#include "scene/fluidspec.h"

/* WisdomInitialise - start FFTW's MPI part, on the first call only. It adds algorithms of its own to FFTW's, and wisdom
   that was made with them can be read only with them. Not collective. */
PETSC_EXTERN PetscErrorCode WisdomInitialise(void);

/* WisdomRead - rank 0 reads the file, if path names one that is there, and tells all ranks; before any plan is made.
   Collective. Errors, agreed on by all ranks: a file that cannot be read, or that is not wisdom of this FFTW. */
PETSC_EXTERN PetscErrorCode WisdomRead(MPI_Comm comm, const char path[]);

/* WisdomWrite - rank 0 collects all ranks' wisdom and writes the file, through a temporary name, when the file lacks
   some of it; after all plans are made. Collective. Errors, agreed on by all ranks: a file that cannot be written. */
PETSC_EXTERN PetscErrorCode WisdomWrite(MPI_Comm comm, const char path[]);
