/* The methods of the literature that the default scheme is compared with. Nothing else in src/ uses this folder. */
#pragma once
#include "scheme/scheme.h"

/* BaselinesRegister - register split and penalty, for -scheme_type. Not collective. */
PETSC_EXTERN PetscErrorCode BaselinesRegister(void);

/* SchemeCreate_Split, SchemeCreate_Penalty - give a scheme the operations of one of the methods. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCreate_Split(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeCreate_Penalty(Scheme scheme);
