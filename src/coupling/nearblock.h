/* One block of the near field: pairs of markers. */
#pragma once
#include "coupling/nearfield.h"

#define NEAR_CELLS 30 /* up to which a pair's stencils are summed; farther pairs have a closed form, right to 2e-7 */

/* NearFarCoefficients - of a kernel, from its second moments along and across. */
PETSC_EXTERN void NearFarCoefficients(const Kernel *kernel, PetscReal far[5]);

/* NearBlockFill - the block's matrix at the present markers, close curves not yet refined (nearclose.h). Not
 * collective. */
PETSC_EXTERN PetscErrorCode NearBlockFill(NearField near, NearBlock *block);

/* NearLatticePair - L of markers i and j, d = X_i - X_j (length) that of the image meant: xx, yy, xy, yx. By stencils
   as far as the table goes, by closed form beyond. Of `near` it reads markers, stencil, lattice, far and nu. Not
   collective. */
PETSC_EXTERN void NearLatticePair(NearField near, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]);
