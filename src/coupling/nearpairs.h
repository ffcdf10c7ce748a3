/* Which markers the near field joins: by a list of cells, in a time in proportion to the vesicles. */
#pragma once
#include "coupling/nearfield.h"

/* NearPairsFind - the blocks of the own bodies where the markers are, without their values. Every pair of bodies, or of
   images, once: two own ones' in the first one's rows. Those of two obstacles that rest are found the first time, and
   they and their values stay. `first`: the first of all blocks that has to get its values. Not collective. */
PETSC_EXTERN PetscErrorCode NearPairsFind(NearField near, PetscInt *first);
