/* The forces that the program has, in the order in which they are walked. */
#pragma once
#include "bodies/force.h"

/* ForcesCreate - the forces on these membranes in the box of this grid, both borrowed, as the scene has them; scene
   NULL: without gravity and repulsion. Not collective. */
PETSC_EXTERN PetscErrorCode ForcesCreate(Bodies bodies, Grid grid, Scene scene, Forces *forces);
