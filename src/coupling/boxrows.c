/* What a marker has of a box table. */
#include "base/lanes.h"
#include "coupling/boxtable.h"

/* The velocity along a wall falls like the distance, the one across like its square, and the stress, which tensors
   feel, stays. */
void BoxTableGoOn(const BoxTable *t, Grid g, PetscReal x[2], PetscReal factor[BOX_COMPONENTS]) {
  for (int c = 0; c < BOX_COMPONENTS; c++) factor[c] = 1;
  for (int d = 0; d < 2; d++) {
    const PetscReal end[2] = {t->axis[d].low, t->axis[d].high}, wall[2] = {g->lo[d], g->hi[d]};
    for (int side = 0; side < 2 && g->wall[d]; side++) {
      const PetscReal part = (x[d] - wall[side]) / (end[side] - wall[side]);
      if (part >= 1) continue;
      x[d] = end[side];
      factor[d] *= PetscSqr(part);
      factor[1 - d] *= part;
    }
  }
}

/* a[4 n] = weights of count functions times their rows of vectors, 4 n of the `modes` that a row has: in registers. */
static inline void Sums(const int n, PetscInt count, const PetscReal weight[], const PetscReal *row, PetscInt modes,
                        PetscReal a[]) {
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

/* Functions at a place in the table, or beyond its end of their straight line. */
static void StraightOn(const BoxTable *t, int dir, PetscReal x, PetscReal values[]) {
  const PetscReal low = t->axis[dir].low, high = t->axis[dir].high, inner = PetscMax(low, PetscMin(high, x));
  PetscReal next[BOX_FUNCTIONS];
  if (!t->axis[dir].wall || inner == x) {
    BoxTableFunctions(t, dir, x, values);
    return;
  }
  BoxTableFunctions(t, dir, inner, values);
  BoxTableFunctions(t, dir, inner == low ? low + t->H : high - t->H, next);
  const PetscReal part = -PetscAbsReal(x - inner) / t->H;
  for (PetscInt f = 0; f < t->functions[dir]; f++) values[f] += part * (next[f] - values[f]);
}

void BoxTableRows(const BoxTable *t, Grid g, const PetscReal X[2], PetscReal part, int first, int count,
                  PetscReal rows[]) {
  PetscReal vx[BOX_FUNCTIONS], vy[BOX_FUNCTIONS], x[2] = {X[0], X[1]}, factor[BOX_COMPONENTS];
  PetscReal weight[BOX_BLOCK_FUNCTIONS];
  (void)PetscArrayzero(rows, count * t->rank);
  if (part == 0) return;
  if (!t->whole) BoxTableGoOn(t, g, x, factor);
  for (int c = 0; c < BOX_COMPONENTS && t->whole; c++) factor[c] = 1;
  (t->whole ? StraightOn : BoxTableFunctions)(t, 0, x[0], vx);
  (t->whole ? StraightOn : BoxTableFunctions)(t, 1, x[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < count; c++) {
      const BoxBlock *b = &t->block[q];
      const PetscReal scale = part * factor[first + c], *fx = vx + b->first[first + c][0],
                      *fy = vy + b->first[first + c][1];
      for (PetscInt k = 0; k < b->n[0] * b->n[1]; k++) weight[k] = scale * fx[k / b->n[1]] * fy[k % b->n[1]];
      BoxBlockSum(b, first + c, 1, weight, rows + c * t->rank + b->start);
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

PetscReal BoxProduct(PetscInt r, const PetscReal l[], const PetscReal x[], const PetscReal y[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * (x[m + q] * y[m + q]);
  for (; m < r; m++) rest += l[m] * (x[m] * y[m]);
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}
