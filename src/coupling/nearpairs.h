/* Which markers the near field joins: by a list of cells, in a time in proportion to the vesicles. */
#pragma once
#include "coupling/nearfield.h"

/* NearPairsFind - the blocks of the own vesicles where the markers are, without their values. Every pair of
   vesicles, or of images, once: two own ones' in the first one's rows. Blocks are in the order of their rows. Not
   collective. */
PETSC_EXTERN PetscErrorCode NearPairsFind(NearField near);
