/* A dense matrix stored for products with many columns: in panels of 8 rows, whose entries of one column are
   contiguous, so that a product keeps the sums of 8 rows and 4 columns in vector registers whatever the BLAS is. */
#pragma once
#include "base/lanes.h"

#define PANEL_ROWS (2 * LANES)

/* PanelsRows - rows with the zeros that fill the last panel. PanelsSize - numbers that rows x columns take. */
static inline PetscInt PanelsRows(PetscInt rows) {
  return (rows + PANEL_ROWS - 1) / PANEL_ROWS * PANEL_ROWS;
}
static inline PetscInt PanelsSize(PetscInt rows, PetscInt columns) {
  return PanelsRows(rows) * columns;
}

/* PanelsSetColumn - entries a[rows] to column j of a matrix of so many columns. Not collective. */
PETSC_EXTERN void PanelsSetColumn(PetscInt rows, PetscInt columns, PetscInt j, const PetscReal a[], PetscReal panels[]);

/* PanelsProduct - c = A b for `count` columns b, apart[0] numbers from one to the next, by the first `inner` of the
   matrix's columns; to columns c, apart[1] >= PanelsRows(rows) numbers from one to the next, zeros in the last panel's
   surplus rows. Not collective. */
PETSC_EXTERN void PanelsProduct(PetscInt rows, PetscInt columns, const PetscReal panels[], PetscInt inner,
                                PetscInt count, const PetscInt apart[2], const PetscReal b[], PetscReal c[]);
