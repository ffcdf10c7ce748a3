/* What the coarse grid does not know of two vesicles next to one another: between markers nearer than a few of its
   cells, the Stokeslet less the mean of what its kernel and lattice make of it (docs/suspensions.md, Near markers). For
   the preconditioner. */
#pragma once
#include "coupling/coarse.h"
#include "coupling/coupling.h"

#define SHORT_POINTS 512 /* of the table */

/* R of two markers, symmetric. */
typedef struct {
  PetscInt i, j; /* i is an own one */
  float xx, xy, yy;
} ShortPair;

typedef struct _p_ShortRange *ShortRange;
struct _p_ShortRange {
  Coupling coupling;              /* borrowed; has a near field, whose pairs of vesicles these are */
  PetscReal reach;                /* length */
  PetscReal across[SHORT_POINTS]; /* R = across I + (along - across) r r^T/r^2 by distance, from 0 to the reach */
  PetscReal along[SHORT_POINTS];
  ShortPair *pair;
  PetscInt pairs, room;
  PetscScalar *force; /* [2M] work */
};

/* ShortRangeCreate - for the coupling's membranes and this coarse grid. Not collective. */
PETSC_EXTERN PetscErrorCode ShortRangeCreate(Coupling coupling, Coarse coarse, ShortRange *range);
PETSC_EXTERN PetscErrorCode ShortRangeDestroy(ShortRange *range);

/* ShortRangePlace - the pairs where the markers have been placed. Not collective. */
PETSC_EXTERN PetscErrorCode ShortRangePlace(ShortRange range);

/* ShortRangeApply - U -= R F, own parts of marker vectors. Collective. */
PETSC_EXTERN PetscErrorCode ShortRangeApply(ShortRange range, const PetscScalar F[], PetscScalar U[]);
