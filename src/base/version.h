/* The version of petves. */
#pragma once
#include "base/base.h"

#define PETVES_VERSION "0.2.0"

/* PetvesVersion - one line with the version, the commit, the PETSc that runs, and the processor that the code is for.
   May be called before MPI and PETSc start. PetvesCommit - the commit that was built, or "unknown". Not collective. */
PETSC_EXTERN PetscErrorCode PetvesVersion(char line[], size_t length);
PETSC_EXTERN const char *PetvesCommit(void);
