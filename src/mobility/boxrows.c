/* What a marker has of a box table. */
#include "base/lanes.h"
#include "mobility/boxtable.h"

/* a[4 n] = weights of count functions times their rows of vectors, 4 n of the `modes` that a row has: in registers. */
static inline void BoxBlockVectors(const int n, PetscInt count, const PetscReal weight[], const PetscReal *row,
                                   PetscInt modes, PetscReal a[]) {
  Lanes sum[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt f = 0; f < count; f++, row += modes)
    for (int k = 0; k < n; k++) sum[k] += weight[f] * LanesAt(row + LANES * k);
  for (int k = 0; k < n; k++) LanesPut(sum[k], a + LANES * k);
}

/* The last four overlap others. */
void BoxBlockSum(const BoxBlock *q, int first, int components, const PetscReal weight[], PetscReal a[]) {
  const PetscInt modes = q->modes, functions = q->n[0] * q->n[1], count = components * functions;
  const PetscReal *Q = q->Q + first * functions * modes;
  PetscInt m = 0;
  for (; m + 4 * LANES <= modes; m += 4 * LANES) BoxBlockVectors(4, count, weight, Q + m, modes, a + m);
  for (; m + LANES <= modes; m += LANES) BoxBlockVectors(1, count, weight, Q + m, modes, a + m);
  if (m < modes && modes >= LANES) {
    m = modes - LANES;
    BoxBlockVectors(1, count, weight, Q + m, modes, a + m);
    m = modes;
  }
  for (; m < modes; m++) {
    a[m] = 0;
    for (PetscInt f = 0; f < count; f++) a[m] += weight[f] * Q[f * modes + m];
  }
}

void BoxTableRows(const BoxTable *t, const PetscReal X[2], PetscReal part, int first, int count, PetscReal rows[]) {
  PetscReal vx[BOX_PLACES], vy[BOX_PLACES], weight[BOX_BLOCK_FUNCTIONS];
  (void)PetscArrayzero(rows, count * t->rank);
  if (part == 0) return;
  BoxTableFunctions(t, 0, X[0], vx);
  BoxTableFunctions(t, 1, X[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < count; c++) {
      const BoxBlock *b = &t->block[q];
      const PetscReal *fx = vx + b->first[first + c][0], *fy = vy + b->first[first + c][1];
      for (PetscInt i = 0; i < b->n[0]; i++)
        for (PetscInt j = 0; j < b->n[1]; j++) weight[i * b->n[1] + j] = part * fx[i] * fy[j];
      BoxBlockSum(b, first + c, 1, weight, rows + c * t->rank + b->start);
    }
}

PetscReal BoxProduct(PetscInt r, const PetscReal l[], const PetscReal x[], const PetscReal y[]) {
  Lanes sum = {0};
  PetscReal rest = 0;
  PetscInt m = 0;
  for (; m + LANES <= r; m += LANES) sum += LanesAt(l + m) * (LanesAt(x + m) * LanesAt(y + m));
  for (; m < r; m++) rest += l[m] * (x[m] * y[m]);
  return LanesSum(sum) + rest;
}
