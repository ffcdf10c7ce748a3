/* Two membranes nearer to one another than their markers: the single layer between them on finer points. */
#pragma once
#include "coupling/nearfield.h"

/* NearBlockRefine - to the block between two curves whose gap is below 1.3 marker spacings, the difference between the
   Stokeslet on finer points of both and on the markers; nothing for wider gaps. Not collective. */
PETSC_EXTERN PetscErrorCode NearBlockRefine(NearField near, NearBlock *block);
