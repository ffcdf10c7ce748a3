/* Which markers the near field joins: by a list of cells, in a time in proportion to the vesicles. */
#pragma once
#include "coupling/nearfield.h"

/* NearPairsFind - the blocks of the own bodies where the markers are, without their values. Every pair of bodies, or of
   images, once: two own ones' in the first one's rows. Those of two obstacles are looked for where obstacles have moved
   since the last time, or never been; else they, and their values, are as they were. `first`: the first of all blocks
   that has to get its values. Not collective. */
PETSC_EXTERN PetscErrorCode NearPairsFind(NearField near, PetscInt *first);
