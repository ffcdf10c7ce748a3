/* What the coarse grid lacks between markers of a vesicle and a body next to it (docs/suspensions.md, Near markers),
   the velocity -R F + D J of forces F and, with viscosity contrast, of jumps J.

       R = S - L,

   S the Stokeslet and L the mean of what kernel and lattice of the coarse grid make of it, over the places in a cell
   and all directions. R fades smoothly to zero at a reach of four coarse cells and is tabulated by distance.

       D J(x) = -(1/pi) SUM_k r (r.N_k)(r.J_k)/r^4,      r = X_k - x,

   is the exact double layer of the markers X_k, N_k their normals times length: without lattice, box and walls, and
   summed in each product, so that no dense blocks are kept. Forces and jumps of all ranks are gathered. */
#pragma once
#include "precondition/coarsegrid.h"
#include "mobility/mobility.h"

#define CORRECTION_POINTS 512 /* of the table */

/* R of two markers, symmetric. */
typedef struct {
  PetscInt i, j; /* i is an own one */
  float xx, xy, yy;
} CorrectionPair;

typedef struct _p_CoarseCorrection *CoarseCorrection;
struct _p_CoarseCorrection {
  Mobility mobility;                   /* borrowed: markers, normals, and the pairs of bodies near one another */
  PetscReal reach;                     /* length */
  PetscReal across[CORRECTION_POINTS]; /* R = across I + (along - across) r r^T/r^2 by distance, from 0 to the reach */
  PetscReal along[CORRECTION_POINTS];
  CorrectionPair *pair;
  PetscInt pairs;
  size_t room;
  PetscScalar *force, *jump; /* [2(M + W)] work */
};

/* CoarseCorrectionCreate - for the bodies of a mobility that has a near field, and this coarse grid. Not collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionCreate(Mobility mobility, CoarseGrid coarse, CoarseCorrection *range);
PETSC_EXTERN PetscErrorCode CoarseCorrectionDestroy(CoarseCorrection *range);

/* CoarseCorrectionPlace - the pairs where the markers have been placed. Not collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionPlace(CoarseCorrection range);

/* CoarseCorrectionApply - U += -R F + D J, own parts of marker vectors of all bodies; J NULL: without contrast.
   Collective. */
PETSC_EXTERN PetscErrorCode CoarseCorrectionApply(CoarseCorrection range, const PetscScalar F[], const PetscScalar J[],
                                                  PetscScalar U[]);
