/* The methods of the literature that the default scheme is compared with. Nothing else in src/ uses this folder. */
#pragma once
#include "scheme/scheme.h"

/* BaselinesRegister - register split and penalty, for -scheme_type. Not collective. */
PETSC_EXTERN PetscErrorCode BaselinesRegister(void);
