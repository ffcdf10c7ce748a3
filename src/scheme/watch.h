/* What is looked at after a step. */
#pragma once
#include "scheme/scheme.h"

/* SchemeCheck - finite values, markers away from walls, edge ratio, area and length within -limit_*; what is wrong and
   what to try goes into report.failure. Warns when membranes come closer than 2 h. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheck(Scheme scheme);
