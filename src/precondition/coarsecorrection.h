/* What the coarse grid lacks between markers of two vesicles next to one another (docs/suspensions.md, Near markers):
   the velocity -R F with
       R = S - L,
   S the Stokeslet and L the mean of what kernel and lattice of the coarse grid make of it, over the places in a cell
   and all directions. R fades smoothly to zero at a reach of four coarse cells and is tabulated by distance. Forces of
   all ranks are gathered. */
#pragma once
#include "precondition/coarsegrid.h"
#include "mobility/nearfield.h"

#define CORRECTION_POINTS 512 /* of the table */

/* R of two markers, symmetric. */
typedef struct {
  PetscInt i, j; /* i is an own one */
  float xx, xy, yy;
} CorrectionPair;

typedef struct _p_CoarseCorrection *CoarseCorrection;
struct _p_CoarseCorrection {
  NearField near;                      /* borrowed: markers, and the pairs of vesicles near one another */
  PetscReal reach;                     /* length */
  PetscReal across[CORRECTION_POINTS]; /* R = across I + (along - across) r r^T/r^2 by distance, from 0 to the reach */
  PetscReal along[CORRECTION_POINTS];
  CorrectionPair *pair;
  PetscInt pairs;
  size_t room;
  PetscScalar *force; /* [2M] work */
};

/* CoarseCorrectionCreate - for the near field's membranes and this coarse grid. Not collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionCreate(NearField near, CoarseGrid coarse, CoarseCorrection *range);
PETSC_EXTERN PetscErrorCode CoarseCorrectionDestroy(CoarseCorrection *range);

/* CoarseCorrectionPlace - the pairs where the markers have been placed. Not collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionPlace(CoarseCorrection range);

/* CoarseCorrectionApply - U -= R F, own parts of marker vectors. Collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionApply(CoarseCorrection range, const PetscScalar F[], PetscScalar U[]);
