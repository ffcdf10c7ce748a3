/* The back ends of scalar solves that petves has. */
#pragma once
#include "fluid/transforms/fastsolver.h"

/* FastSolversRegister - register "fftw_tridiagonal", "fftw" and "hypre" for FastSolverCreate, once. Not collective. */
PETSC_EXTERN PetscErrorCode FastSolversRegister(void);
