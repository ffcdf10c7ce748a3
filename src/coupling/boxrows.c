/* What a marker has of a box table. */
#include "base/lanes.h"
#include "coupling/boxtable.h"

PetscReal BoxTableFade(const BoxTable *t, Grid g, const PetscReal X[2]) {
  const PetscReal last = t->H > g->h * (1 + 1e-9) ? t->H
                                                  : 0.5 * g->h; /* the table of the run's own grid ends at its limit */
  PetscReal fade = 1;
  for (int d = 0; d < 2; d++) {
    const PetscReal *x = &X[d], end = t->axis[d].low - g->lo[d] - (last < t->H ? last : 0);
    if (!g->wall[d]) continue;
    fade *= BoxSmoothStep(PetscMin(*x - g->lo[d], g->hi[d] - *x), end, end + last);
  }
  return fade;
}

/* a[4 n] = weights of count functions times their rows of vectors, 4 n of the `modes` that a row has: in registers. */
static inline void Sums(const int n, PetscInt count, const PetscReal weight[], const PetscReal *row, PetscInt modes,
                        PetscReal a[]) {
  Lanes sum[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt f = 0; f < count; f++, row += modes)
    for (int k = 0; k < n; k++) sum[k] += weight[f] * LanesAt(row + LANES * k);
  for (int k = 0; k < n; k++) LanesPut(sum[k], a + LANES * k);
}

/* a[modes] of the block: weights of one component's functions times its vectors. The last four overlap others. */
static void BlockRow(const BoxBlock *q, int c, const PetscReal weight[], PetscReal a[]) {
  const PetscInt modes = q->modes, count = q->n[0] * q->n[1];
  const PetscReal *Q = q->Q + c * count * modes;
  PetscInt m = 0;
  for (; m + 4 * LANES <= modes; m += 4 * LANES) Sums(4, count, weight, Q + m, modes, a + m);
  for (; m + LANES <= modes; m += LANES) Sums(1, count, weight, Q + m, modes, a + m);
  if (m < modes && modes >= LANES) {
    m = modes - LANES;
    Sums(1, count, weight, Q + m, modes, a + m);
    m = modes;
  }
  for (; m < modes; m++) {
    a[m] = 0;
    for (PetscInt f = 0; f < count; f++) a[m] += weight[f] * Q[f * modes + m];
  }
}

void BoxTableRows(const BoxTable *t, const PetscReal X[2], PetscReal fade, int first, int count, PetscReal rows[]) {
  PetscReal vx[BOX_FUNCTIONS], vy[BOX_FUNCTIONS], weight[BOX_BLOCK_FUNCTIONS];
  (void)PetscArrayzero(rows, count * t->rank);
  if (fade == 0) return;
  BoxTableFunctions(t, 0, X[0], vx);
  BoxTableFunctions(t, 1, X[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < count; c++) {
      const BoxBlock *b = &t->block[q];
      const PetscReal *x = vx + b->first[first + c][0], *y = vy + b->first[first + c][1];
      for (PetscInt k = 0; k < b->n[0] * b->n[1]; k++) weight[k] = fade * x[k / b->n[1]] * y[k % b->n[1]];
      BlockRow(b, first + c, weight, rows + c * t->rank + b->start);
    }
}

PetscReal BoxSum(PetscInt r, const PetscReal l[], const PetscReal x[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * x[m + q];
  for (; m < r; m++) rest += l[m] * x[m];
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}
