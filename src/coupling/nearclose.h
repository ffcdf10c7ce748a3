/* Two membranes nearer to one another than their markers: the single layer between them on finer points. */
#pragma once
#include "coupling/nearfield.h"

/* NearBlockRefine - to image->C, the block of these two curves, for the column's image at image->shift: where its gap
   to the row's curve is below 1.3 marker spacings, the difference between the Stokeslet on finer points of both and on
   the markers; nothing for wider gaps. Not collective. */
PETSC_EXTERN PetscErrorCode NearBlockRefine(NearField near, const NearBlock *image);
