#include "numerics/packedmatrix.h"

#define TOGETHER 4 /* columns */

void PackedMatrixSetColumn(const PackedMatrix *A, PetscInt j, const PetscReal a[]) {
  for (PetscInt i = 0; i < PackedMatrixRows(A); i++)
    A->value[(i / PANEL_ROWS * A->columns + j) * PANEL_ROWS + i % PANEL_ROWS] = i < A->rows ? a[i] : 0;
}

/* Four columns of the product with one panel, which are `rows` numbers apart. */
static void PackedFour(const PetscReal panel[], PetscInt inner, const PetscReal b[], PetscInt rows, PetscReal c[]) {
  Lanes low[TOGETHER] = {{0}}, high[TOGETHER] = {{0}};
  for (PetscInt j = 0; j < inner; j++, panel += PANEL_ROWS) {
    const Lanes first = LanesAt(panel), second = LanesAt(panel + LANES);
    for (int q = 0; q < TOGETHER; q++) {
      low[q] += first * b[q * inner + j];
      high[q] += second * b[q * inner + j];
    }
  }
  for (int q = 0; q < TOGETHER; q++) {
    *(Lanes *)(c + q * rows) = low[q];
    *(Lanes *)(c + q * rows + LANES) = high[q];
  }
}

/* One column of the product with one panel, in four sums a row: additions to one sum would wait for one another. */
static void PackedOne(const PetscReal panel[], PetscInt inner, const PetscReal b[], PetscReal c[]) {
  Lanes low[TOGETHER] = {{0}}, high[TOGETHER] = {{0}};
  PetscInt j = 0;
  for (; j + TOGETHER <= inner; j += TOGETHER)
    for (int q = 0; q < TOGETHER; q++) {
      low[q] += LanesAt(panel + (j + q) * PANEL_ROWS) * b[j + q];
      high[q] += LanesAt(panel + (j + q) * PANEL_ROWS + LANES) * b[j + q];
    }
  for (; j < inner; j++) {
    low[0] += LanesAt(panel + j * PANEL_ROWS) * b[j];
    high[0] += LanesAt(panel + j * PANEL_ROWS + LANES) * b[j];
  }
  *(Lanes *)c = (low[0] + low[1]) + (low[2] + low[3]);
  *(Lanes *)(c + LANES) = (high[0] + high[1]) + (high[2] + high[3]);
}

void PackedMatrixProduct(const PackedMatrix *A, PetscInt inner, PetscInt count, const PetscReal B[], PetscReal C[]) {
  const PetscInt rows = PackedMatrixRows(A);
  for (PetscInt i = 0; i < rows; i += PANEL_ROWS) {
    const PetscReal *panel = A->value + i * A->columns;
    PetscInt k = 0;
    for (; k + TOGETHER <= count; k += TOGETHER) PackedFour(panel, inner, B + k * inner, rows, C + k * rows + i);
    for (; k < count; k++) PackedOne(panel, inner, B + k * inner, C + k * rows + i);
  }
}
