/* The way down of a solve by stream function: from y = (y1, y2) and what comes into a slab from outside to the stream
   function chi, and from chi to rows of velocity (stream.c has the recurrences). Nothing crosses ranks:
   StreamSlabsClose comes first. */
#pragma once
#include "fluid/stokes/streamstate.h"

/* StreamBeginDown - start at the uppermost row of the slab. StreamNodeModes - the modes of chi/h of row j of nodes, the
   next row downwards, and their number; they are written to `into` unless that is NULL. squares: the meter gets them.
   Not collective. */
PETSC_EXTERN void StreamBeginDown(Stream stream);
PETSC_EXTERN PetscInt StreamNodeModes(Stream stream, PetscInt j, PetscBool squares, PetscReal *into, PetscReal **modes);

/* StreamScatter - the whole way down, or to the last row that is wanted: rows of velocity, their flow and what is
   measured. Not collective. */
PETSC_EXTERN void StreamScatter(Stream stream, const StreamRows *rows, PetscBool measured);
