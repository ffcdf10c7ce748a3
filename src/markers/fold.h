/* What becomes of a stencil that reaches across a wall (docs/nearfield.md, Walls): weights beyond it go to the mirror
   image's face, with the sign of the velocity that continues the flow across a wall at rest: the component along the
   wall is odd, the one across it even. */
#pragma once
#include "kernel/kernel.h"

#define FOLD_SCALED 3 /* cells from a wall up to which WallScale is not 1: where the box part ends */

/* FoldLow - fold the weights [n] of entries first .. first + n - 1 at a wall below entry 0: half a cell below (normal
   false), or a whole one, on a face, which drops out (normal true). first, n and weights change. Not collective. */
PETSC_EXTERN void FoldLow(PetscBool normal, PetscInt *first, PetscInt *n, PetscReal weights[]);

/* FoldHigh - the same at a wall above the last of `cells` cells. */
PETSC_EXTERN void FoldHigh(PetscBool normal, PetscInt cells, PetscInt *first, PetscInt *n, PetscReal weights[]);

/* WallScale - s of a marker y cells from a wall: the component normal to a wall at rest grows like y^2 from it, a
   stencil gives y^2 and the kernel's second moment instead, and s times that is y^2 again; 1 from FOLD_SCALED cells on.
 */
PETSC_EXTERN PetscReal WallScale(const Kernel *kernel, PetscReal y);
