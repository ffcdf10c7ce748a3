#include "fluid/transforms/fastsolvers.h"

PetscErrorCode FastSolversRegister(void) {
  PetscFunctionBeginUser;
  PetscCall(FastSolverRegister("fftw", FastSolverCreate_FFTW));
  PetscCall(FastSolverRegister("fftw_tridiagonal", FastSolverCreate_Tridiagonal));
  PetscCall(FastSolverRegister("hypre", FastSolverCreate_Hypre));
  PetscFunctionReturn(PETSC_SUCCESS);
}
