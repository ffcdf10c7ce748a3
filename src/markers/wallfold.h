/* Stencils that reach across a wall (docs/nearfield.md, Walls).

   The flow goes on across a wall at rest: the velocity component along the wall is continued as an odd function, the
   component across it as an even one. So a weight beyond the wall goes to the mirror image's entry, with or without a
   change of sign. The stress, which tensors act on, is continued smoothly. All functions work on one rank. */
#pragma once
#include "kernel/kernel.h"

#define FOLD_SCALED 3 /* cells from a wall within which WallScale is not 1 */

typedef enum {
  FOLD_ODD,    /* odd continuation; entries are half a cell, one and a half, .. from the wall */
  FOLD_EVEN,   /* even continuation; entries are whole cells from the wall, and one on the wall drops out */
  FOLD_SMOOTH, /* continuation by the polynomial through the five entries next to the wall */
} FoldKind;

/* FoldLow - fold the weights[n], an array of KERNEL_MAX_POINTS, of entries first .. first + n - 1 at a wall below entry
   0; first, n and weights change. FoldHigh - fold them at a wall above entry `last`. Not collective. */
PETSC_EXTERN void FoldLow(FoldKind kind, PetscInt *first, PetscInt *n, PetscReal weights[]);
PETSC_EXTERN void FoldHigh(FoldKind kind, PetscInt last, PetscInt *first, PetscInt *n, PetscReal weights[]);

/* WallScale - the factor s of the component normal to a wall at rest, of a marker y cells from the wall. This component
   grows like y^2 from the wall, and a stencil of the kernel's second moment m gives y^2 + m:

     s = y^2/(y^2 + m).

   From FOLD_SCALED cells on s is 1, with a smooth change to it. Not collective. */
PETSC_EXTERN PetscReal WallScale(const Kernel *kernel, PetscReal y);
