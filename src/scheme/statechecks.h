/* The checks of the state after a step: each rank looks at its own vesicles, and all ranks agree on the first failure.
 */
#pragma once
#include "scheme/stepcommon.h"

/* SchemeCheck - check that values are finite, that markers keep away from walls, that edge ratio, area and length are
   within -limit_*, and that membranes do not cross; report.failure names what is wrong and what to try. Warn of
   membranes in contact, of markers that do not resolve their membrane or a film, of a vesicle in a corner of two walls
   and of a fixed step that is too large. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheck(Scheme scheme);
