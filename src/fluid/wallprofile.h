/* The flow of a force wave on a wall: profiles across the box, from which channel.c and walls.c build
   their inverses. */
#pragma once
#include "fluid/fluid.h"

/* WallProfile - the projection of a unit force wave on the first of n rows between two walls, of fields that vary along
   the walls with the symbol s of the gradient, |s|^2 = lambda (1/length^2). w[n] is H^-1 of the force; the potential is
   -conj(s) psi[n]; work[n]. docs/fluid.md, "Channel", has the flow that follows. Not collective. */
PETSC_EXTERN void WallProfile(Fluid fluid, PetscInt n, PetscReal lambda, PetscReal work[], PetscReal w[],
                              PetscReal psi[]);
