/* The membranes' problems inside the coupled preconditioner for many vesicles (docs/suspensions.md, Shared shapes).

   A vesicle's exact mobility in unbounded fluid is that of any other vesicle of its shape, turned, moved and with its
   labels shifted. So the dense problem of one vesicle (denseblock.h) is inverted for a few shapes only. Each vesicle
   takes the inverse B^-1 of the shape that it is nearest to, in the frame of the rigid fit (rigidfit.h). What other
   vesicles and the walls do to it is added by interactions.h, on a coarse grid.

   That is for quasi-steady flow: with inertia the mobility of short steps depends on the place in the cells. It is not
   for permeable membranes: what seeps is stiff along the normals, which the shape's are not quite.

   Every rank knows all shapes, and they do not depend on the ranks; a rank has the matrices of those shapes that its
   own vesicles take. A step: Follow, then Solve for each application of the preconditioner. */
#pragma once
#include "precondition/shapeset.h"

/* SharedShapesCreate - for the coupling's membranes, which have a near field, in the quasi-steady fluid that spec
   makes. Collective. */
PETSC_EXTERN PetscErrorCode SharedShapesCreate(const FluidSpec *spec, Coupling coupling, SharedShapes *shapes);
PETSC_EXTERN PetscErrorCode SharedShapesDestroy(SharedShapes *shapes);

/* SharedShapesFollow - a shape for each vesicle where the coupling has been placed: its last one while that is within
   the tolerance, else the nearest, else a new one, of its own shape. All matrices are made anew where a0 has moved by
   more than 10 %. failed, on every rank, when a matrix is singular. Collective. */
PETSC_EXTERN PetscErrorCode SharedShapesFollow(SharedShapes shapes, PetscBool *failed);

/* SharedShapesSolve - from the own U[2(n + w)] and sigma[n] = r_s: V and sigma of each vesicle's dense problem,
   corrected by what the others and the walls do to it; U of the obstacles += what the vesicles do to them. Collective.
 */
PETSC_EXTERN PetscErrorCode SharedShapesSolve(SharedShapes shapes, PetscScalar U[], PetscScalar sigma[]);

/* SharedShapesGetMemory, SharedShapesSetMemory - the shapes as SharedShapesMemorySize numbers for a checkpoint, the
   same on every rank, and again from them; valid is false when they are not of these vesicles. Not collective. */
static inline PetscInt SharedShapesMemorySize(Layout layout) {
  return 1 + 2 * layout->M + 3 * layout->bodies;
}
PETSC_EXTERN void SharedShapesGetMemory(SharedShapes shapes, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode SharedShapesSetMemory(SharedShapes shapes, const PetscReal memory[], PetscBool *valid);
