#include "coupling/panels.h"

#define TOGETHER 4 /* columns */

void PanelsSetColumn(PetscInt rows, PetscInt columns, PetscInt j, const PetscReal a[], PetscReal panels[]) {
  for (PetscInt i = 0; i < PanelsRows(rows); i++)
    panels[(i / PANEL_ROWS * columns + j) * PANEL_ROWS + i % PANEL_ROWS] = i < rows ? a[i] : 0;
}

/* One panel, four columns. */
static void Four(const PetscReal panel[], PetscInt inner, PetscInt apart, const PetscReal b[], PetscInt apart_c,
                 PetscReal c[]) {
  Lanes low[TOGETHER] = {{0}}, high[TOGETHER] = {{0}};
  for (PetscInt j = 0; j < inner; j++, panel += PANEL_ROWS) {
    const Lanes first = LanesAt(panel), second = LanesAt(panel + LANES);
    for (int q = 0; q < TOGETHER; q++) {
      low[q] += first * b[q * apart + j];
      high[q] += second * b[q * apart + j];
    }
  }
  for (int q = 0; q < TOGETHER; q++) {
    *(Lanes *)(c + q * apart_c) = low[q];
    *(Lanes *)(c + q * apart_c + LANES) = high[q];
  }
}

/* One panel, one column: four sums of each row, as one would wait for itself. */
static void One(const PetscReal panel[], PetscInt inner, const PetscReal b[], PetscReal c[]) {
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

void PanelsProduct(PetscInt rows, PetscInt columns, const PetscReal panels[], PetscInt inner, PetscInt count,
                   const PetscInt apart[2], const PetscReal b[], PetscReal c[]) {
  for (PetscInt i = 0; i < rows; i += PANEL_ROWS) {
    const PetscReal *panel = panels + i * columns;
    PetscInt k = 0;
    for (; k + TOGETHER <= count; k += TOGETHER)
      Four(panel, inner, apart[0], b + k * apart[0], apart[1], c + k * apart[1] + i);
    for (; k < count; k++) One(panel, inner, b + k * apart[0], c + k * apart[1] + i);
  }
}
