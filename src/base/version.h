/* Which petves this is. */
#pragma once
#include "base/base.h"

#define PETVES_VERSION "0.2.0"

/* PetvesVersion - one line: version, commit, the PETSc that runs, and the processor that the code is for. May be called
   before MPI and PETSc start. Not collective. PetvesCommit - the commit that was built, or "unknown". */
PETSC_EXTERN PetscErrorCode PetvesVersion(char line[], size_t length);
PETSC_EXTERN const char *PetvesCommit(void);
