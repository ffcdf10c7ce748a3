/* The entries of the markers' stencils, sorted by rows of the grid.

   A Stokes solve by stream function passes the grid row by row. Forces are spread to a row, and its velocity is
   interpolated, while it is in the cache. Every rank has the stencils of all markers and the entries of its own rows
   and of the row above them; nothing crosses ranks here. */
#pragma once
#include "fluid/grid/grid.h"
#include "kernel/kernel.h"

/* The faces of one velocity component that a marker's kernel reaches: columns first[0] .. and rows first[1] .., with
   their weights. */
typedef struct {
  PetscInt first[2], n[2]; /* in x and y; in a periodic direction `first` is an entry of the grid */
  PetscReal weight[2][KERNEL_MAX_POINTS];
} Stencil;

typedef struct {
  PetscInt stencil; /* number of the stencil */
  PetscInt entry;   /* row of the stencil, from 0 */
} RowEntry;

typedef struct _p_MarkerRows *MarkerRows;
struct _p_MarkerRows {
  Grid grid; /* borrowed */
  PetscInt stencils;
  const Stencil *stencil; /* [stencils] borrowed: component c of marker k at 2k + c */
  PetscInt *start[2];     /* [rows+2] of u and v: first entry of each row of this rank and of the row above them */
  RowEntry *entry[2];     /* entries row by row, in each row in the order of stencils */
  PetscInt room[2];       /* capacity of entry */
};

/* MarkerRowsCreate - for a number of stencils. Not collective. */
PETSC_EXTERN PetscErrorCode MarkerRowsCreate(Grid grid, PetscInt stencils, MarkerRows *rows);
PETSC_EXTERN PetscErrorCode MarkerRowsDestroy(MarkerRows *rows);

/* MarkerRowsPlace - find the entries of stencil[stencils], which stays the caller's. Weights along x must be zero from
   entry n on. Not collective. */
PETSC_EXTERN PetscErrorCode MarkerRowsPlace(MarkerRows rows, const Stencil stencil[]);

/* MarkerRowSpread - row += alpha E^T F in row j of u or v, F[stencils]; row j is one of this rank's or the row above
   them. MarkerRowsSpread - all += alpha E^T F in all of this rank's rows, one behind the other. MarkerRowInterpolate -
   U[stencils] += E u of row j alone. Not collective. */
PETSC_EXTERN void MarkerRowSpread(MarkerRows rows, Field field, PetscInt j, PetscReal alpha, const PetscScalar F[],
                                  PetscScalar row[]);
PETSC_EXTERN void MarkerRowsSpread(MarkerRows rows, Field field, PetscReal alpha, const PetscScalar F[],
                                   PetscScalar all[]);
PETSC_EXTERN void MarkerRowInterpolate(MarkerRows rows, Field field, PetscInt j, const PetscScalar row[],
                                       PetscScalar U[]);
