/* One shape's matrices times the columns of all own vesicles that take it, each in its shape's frame. Arrays are the
   own parts of marker vectors and of edge vectors; entries of vesicles of other shapes stay as they are. */
#pragma once
#include "precondition/shapeset.h"

/* SharedShapeSolveAlone - from U[2n] and sigma[n] = r_s: V and sigma of each vesicle's dense problem, and their
   sources unless NULL. SharedShapeSources - the sources of the answers to (W, 0). SharedShapeAddAnswer - (U, sigma) +=
   these answers. Not collective. */
PETSC_EXTERN void SharedShapeSolveAlone(SharedShapes shapes, const SharedShape *shape, PetscScalar U[],
                                        PetscScalar sigma[], const ShapeSources *sources);
PETSC_EXTERN void SharedShapeSources(SharedShapes shapes, const SharedShape *shape, const PetscScalar W[],
                                     const ShapeSources *sources);
PETSC_EXTERN void SharedShapeAddAnswer(SharedShapes shapes, const SharedShape *shape, const PetscScalar W[],
                                       PetscScalar U[], PetscScalar sigma[]);
