/* The markers' stencils by rows of the grid: which of them reach a row, so that forces are spread to it and its
   velocity interpolated while it is in the cache. */
#pragma once
#include "fluid/grid.h"
#include "kernel/kernel.h"

/* Where a marker sees one component: rows y.first.., columns x.first.., with their weights. */
typedef struct {
  PetscInt first[2], n[2]; /* x, y; first wrapped into the grid where periodic */
  PetscReal weight[2][KERNEL_MAX_POINTS];
} Stencil;

typedef struct {
  PetscInt stencil, entry; /* number of the stencil; which of its rows */
} RowEntry;

typedef struct _p_MarkerRows *MarkerRows;
struct _p_MarkerRows {
  Grid grid; /* borrowed */
  PetscInt stencils;
  const Stencil *stencil; /* [stencils] borrowed: component c of marker k at 2k + c */
  PetscInt *start[2];     /* [rows+2] of u and v: first entry of each row of this rank and of the row above them */
  RowEntry *entry[2];     /* by rows, stencils in order */
  PetscInt room[2];       /* entries that there is room for */
};

/* MarkerRowsCreate - for so many stencils. Not collective. */
PETSC_EXTERN PetscErrorCode MarkerRowsCreate(Grid grid, PetscInt stencils, MarkerRows *rows);
PETSC_EXTERN PetscErrorCode MarkerRowsDestroy(MarkerRows *rows);

/* MarkerRowsPlace - of stencil[stencils], which stays the caller's; weights along x are zero beyond n. Not collective.
 */
PETSC_EXTERN PetscErrorCode MarkerRowsPlace(MarkerRows rows, const Stencil stencil[]);

/* MarkerRowSpread - row += alpha E^T F in this rank's row j of u or v, F[stencils]; j may be the number of rows: the
   next rank's first. MarkerRowsSpread - the same to all of this rank's rows, one after the other in `all`.
   MarkerRowInterpolate - U[stencils] += what row j gives. Not collective. */
PETSC_EXTERN void MarkerRowSpread(MarkerRows rows, Field field, PetscInt j, PetscReal alpha, const PetscScalar F[],
                                  PetscScalar row[]);
PETSC_EXTERN void MarkerRowsSpread(MarkerRows rows, Field field, PetscReal alpha, const PetscScalar F[],
                                   PetscScalar all[]);
PETSC_EXTERN void MarkerRowInterpolate(MarkerRows rows, Field field, PetscInt j, const PetscScalar row[],
                                       PetscScalar U[]);
