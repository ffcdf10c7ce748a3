/* A dense matrix stored for products with many columns at once: in panels of 8 rows, whose entries of one column are
   contiguous, so that a product keeps the sums of 8 rows and 4 columns in vector registers whatever the BLAS is. Zeros
   fill the rows of the last panel. */
#pragma once
#include "base/lanes.h"

#define PANEL_ROWS (2 * LANES)

typedef struct {
  PetscInt rows, columns;
  PetscReal *value; /* [PackedMatrixSize], the owner's; NULL: not made */
} PackedMatrix;

/* PackedMatrixRows - rows with the zeros that fill the last panel. PackedMatrixSize - numbers of all columns. Not
   collective. */
static inline PetscInt PackedMatrixRows(const PackedMatrix *A) {
  return (A->rows + PANEL_ROWS - 1) / PANEL_ROWS * PANEL_ROWS;
}
static inline PetscInt PackedMatrixSize(const PackedMatrix *A) {
  return PackedMatrixRows(A) * A->columns;
}

/* PackedMatrixSetColumn - column j of the matrix becomes a[rows]. Not collective. */
PETSC_EXTERN void PackedMatrixSetColumn(const PackedMatrix *A, PetscInt j, const PetscReal a[]);

/* PackedMatrixProduct - C = A B, A cut to its first `inner` columns, B (inner x count) with contiguous columns; columns
   of C are PackedMatrixRows numbers, with zeros behind the last row. Not collective. */
PETSC_EXTERN void PackedMatrixProduct(const PackedMatrix *A, PetscInt inner, PetscInt count, const PetscReal B[],
                                      PetscReal C[]);
