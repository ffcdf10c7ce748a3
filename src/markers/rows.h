/* The entries of stencils, sorted by rows of the grid.

   A Stokes solve by stream function passes the grid row by row. Forces are spread to a row, and its velocity is
   interpolated, while it is in the cache. The list is made once, when markers are placed. Every rank has the stencils
   of all markers and the entries of its own rows and of a few next to it; nothing crosses ranks here. */
#pragma once
#include "base/lanes.h"
#include "fluid/grid/grid.h"
#include "kernel/kernel.h"

#define STENCIL_POINTS (2 * LANES) /* KERNEL_MAX_POINTS + 1, rounded up to whole vectors */

/* The entries of one field that a marker's kernel reaches: columns first[0] .. and rows first[1] .., with the weights

       weight[0][i] weight[1][j],

   which are zero from entry n on. */
typedef struct {
  PetscInt first[2], n[2]; /* in x and y; in a periodic direction `first` is an entry of the grid, or one less */
  PetscReal weight[2][STENCIL_POINTS];
} Stencil;

/* The stencils that one marker has, and which of its `parts` strengths each of them takes. */
typedef struct {
  PetscInt stencils, parts;
  struct {
    Field field;
    PetscInt part;
  } of[6];
} StencilForm;

typedef struct {
  PetscInt stencil; /* number of the stencil */
  PetscInt source;  /* number of its strength */
  PetscReal value;  /* weight of the row */
} RowEntry;

typedef struct _p_StencilRows *StencilRows;
struct _p_StencilRows {
  Grid grid; /* borrowed */
  const StencilForm *form;
  PetscInt below, above;  /* rows below and above this rank's that the list has */
  PetscInt markers;       /* with form->stencils stencils each */
  const Stencil *stencil; /* borrowed */
  PetscInt *start[3];     /* [rows of u + below + above + 2] first entry of each row, in each field */
  RowEntry *entry[3];     /* entries row by row, in each row in the order of stencils */
  PetscInt room[3];       /* capacity of entry */
};

/* StencilRowsCreate - without stencils; the form must stay. Not collective. */
PETSC_EXTERN PetscErrorCode StencilRowsCreate(Grid grid, const StencilForm *form, PetscInt below, PetscInt above,
                                              StencilRows *rows);
PETSC_EXTERN PetscErrorCode StencilRowsDestroy(StencilRows *rows);

/* StencilRowsPlace - find the entries of the stencils of markers, which stay the caller's. Not collective. */
PETSC_EXTERN PetscErrorCode StencilRowsPlace(StencilRows rows, PetscInt markers, const Stencil stencil[]);

/* StencilRowSpread - in local row j of a field, F the strengths of all markers,

       row_i += alpha SUM F weight[0][i] weight[1][j].

   StencilRowInterpolate - U += SUM_i row_i weight[0][i] weight[1][j]. Not collective. */
PETSC_EXTERN void StencilRowSpread(StencilRows rows, Field field, PetscInt j, PetscReal alpha, const PetscScalar F[],
                                   PetscScalar row[]);
PETSC_EXTERN void StencilRowInterpolate(StencilRows rows, Field field, PetscInt j, const PetscScalar row[],
                                        PetscScalar U[]);
