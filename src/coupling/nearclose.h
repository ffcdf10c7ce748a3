/* Two membranes nearer to one another than their markers: the single layer between them on finer points. */
#pragma once
#include "coupling/nearfield.h"

/* NearCloseGap - the gap of two curves, the column's moved by shift, whose markers come as near as this to one another
   (length): that of finer points where it may be below 1.3 marker spacings, else as it is. `close`: whether it is. Not
   collective. */
PETSC_EXTERN PetscErrorCode NearCloseGap(NearField near, PetscInt row, PetscInt column, const PetscReal shift[2],
                                         PetscReal *gap, PetscBool *close);

/* NearCloseFineness - so many fine points a marker, and the window (length) of a close pair. Not collective. */
PETSC_EXTERN void NearCloseFineness(NearField near, const NearClose *close, PetscInt *factor, PetscReal *window);

/* NearCloseAdd - to the block of such curves the difference between the Stokeslet on finer points of both and on the
   markers. Not collective. */
PETSC_EXTERN PetscErrorCode NearCloseAdd(NearField near, const NearClose *close);
