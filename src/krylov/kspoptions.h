/* The settings of a Krylov solve in force, as options that bring them back. */
#pragma once
#include "base/base.h"

/* KSPWriteOptions - a KSP's settings in force as options with this prefix, one a line; pc: its preconditioner where the
   KSP's own is a shell around it, else NULL. */
PETSC_EXTERN PetscErrorCode KSPWriteOptions(KSP ksp, PC pc, const char prefix[], FILE *file);
