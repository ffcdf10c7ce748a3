/* What is looked at after a step. */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeCheck - finite values, markers away from walls, edge ratio, area and length within -limit_*, membranes that do
   not cross; what is wrong and what to try goes into report.failure. Warns of membranes in contact, of markers that
   do not resolve their membrane or the film beside it, of a vesicle in a corner of two walls, and of a fixed step that
   is too large for what moves. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheck(Scheme scheme);
