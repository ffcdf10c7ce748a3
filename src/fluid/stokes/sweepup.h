/* The way up of a solve by stream function: from the forces on the rows of a slab to y = (y1, y2) of the modes
   (stream.c has the recurrences). Nothing crosses ranks. */
#pragma once
#include "fluid/stokes/streamstate.h"

/* StreamGather - y of all own rows from the forces, with nothing coming in from below. measured: the forces go to the
   meter too. Not collective. */
PETSC_EXTERN void StreamGather(Stream stream, const StreamRows *rows, PetscBool measured);
