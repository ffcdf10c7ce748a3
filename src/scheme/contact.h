/* Membranes that cross or come close. */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeCheckContact - a failure when membranes cross, one another or themselves, or when a fixed step has drained a
   film (films.h); a warning, once when it begins, when they are so close that the fluid between them is not resolved.
   In a time in proportion to the markers. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheckContact(Scheme scheme);
