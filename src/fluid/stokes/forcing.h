/* The right-hand side of a Stokes solve, H u + G p = f, G^T u = source, that knows where it is not zero: markers force
   only the faces that their kernels reach, a small part of the grid. Whoever adds to a forcing notes the window of what
   is added, so that the next ForcingClear zeroes just that and a solve visits just that. A window is of this rank's own
   rows and columns; all ranks agree on `everywhere`. */
#pragma once
#include "fluid/stokes/fluid.h"

typedef struct {
  Grid grid;            /* borrowed */
  Vec values;           /* f on the faces (length/time^2); NULL: no forcing has been made */
  Vec source;           /* in the cells (1/time); NULL: zero */
  PetscReal mean[2];    /* mean velocity that goes with the source in a box periodic both ways, or without flux */
  GridWindow window;    /* values and source are zero outside the window, unless `everywhere` */
  PetscBool everywhere; /* values and source may be anywhere */
} Forcing;

/* ForcingCreate - a zero forcing, with a source or without one. ForcingCopy - copy vectors, mean and window; vectors
   that the target lacks are made. Collective. */
PETSC_EXTERN PetscErrorCode ForcingCreate(Grid grid, PetscBool source, Forcing *forcing);
PETSC_EXTERN PetscErrorCode ForcingCopy(const Forcing *from, Forcing *to);
PETSC_EXTERN PetscErrorCode ForcingDestroy(Forcing *forcing);

/* ForcingClear - make the forcing zero. ForcingNote - note that values and source are written in this window too; NULL:
   everywhere. Not collective. */
PETSC_EXTERN PetscErrorCode ForcingClear(Forcing *forcing);
PETSC_EXTERN void ForcingNote(Forcing *forcing, const GridWindow *window);

/* ForcingAdd - values += term, which may be anywhere. ForcingRemoveMean - take the mean of each component off the
   values; the box must be periodic in x and y. Collective. */
PETSC_EXTERN PetscErrorCode ForcingAdd(Forcing *forcing, Vec term);
PETSC_EXTERN PetscErrorCode ForcingRemoveMean(Forcing *forcing, Fluid fluid);
