/* What becomes of a stencil that reaches across a wall (docs/nearfield.md, Walls): the velocity continues the flow
   across a wall at rest, the component along the wall oddly, the one across it evenly, so that weights beyond it go to
   the mirror image's entry. The stress, which tensors act on, goes on smoothly. */
#pragma once
#include "kernel/kernel.h"

#define FOLD_SCALED 3 /* cells from a wall up to which WallScale is not 1 */

typedef enum {
  FOLD_ODD,    /* entries half a cell from the wall and on */
  FOLD_EVEN,   /* entries on the wall, which drop out, and whole cells away */
  FOLD_SMOOTH, /* weights beyond the wall, or on it, go to the five entries next to it by the polynomial through them */
} FoldKind;

/* FoldLow - fold the weights [n], with room for KERNEL_MAX_POINTS, of entries first .. first + n - 1 at a wall below
   entry 0. first, n and weights change. FoldHigh - the same at a wall above entry `last`. Not collective.
 */
PETSC_EXTERN void FoldLow(FoldKind kind, PetscInt *first, PetscInt *n, PetscReal weights[]);
PETSC_EXTERN void FoldHigh(FoldKind kind, PetscInt last, PetscInt *first, PetscInt *n, PetscReal weights[]);

/* WallScale - s of a marker y cells from a wall: the component normal to a wall at rest grows like y^2 from it, a
   stencil gives y^2 and the kernel's second moment instead, and s times that is y^2 again; 1 from FOLD_SCALED cells on.
 */
PETSC_EXTERN PetscReal WallScale(const Kernel *kernel, PetscReal y);
