/* What a marker has of a box table. */
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

/* a[modes] += weights of one velocity component's functions times the block's vectors. */
static void AddBlock(const BoxBlock *q, int c, const PetscReal vx[], const PetscReal vy[], PetscReal fade,
                     PetscReal a[]) {
  const PetscInt modes = q->modes;
  const PetscReal *row = q->Q + c * q->n[0] * q->n[1] * modes, *y = vy + q->first[c][1];
  for (PetscInt i = 0; i < q->n[0]; i++) {
    const PetscReal x = fade * vx[q->first[c][0] + i];
    PetscInt j = 0;
    for (; j + 4 <= q->n[1]; j += 4, row += 4 * modes) /* four at once: a is read and written a quarter as often */
      for (PetscInt m = 0; m < modes; m++)
        a[m] += x * (y[j] * row[m] + y[j + 1] * row[modes + m] + y[j + 2] * row[2 * modes + m] +
                     y[j + 3] * row[3 * modes + m]);
    for (; j < q->n[1]; j++, row += modes)
      for (PetscInt m = 0; m < modes; m++) a[m] += x * y[j] * row[m];
  }
}

void BoxTableRows(const BoxTable *t, const PetscReal X[2], PetscReal fade, int first, int count, PetscReal rows[]) {
  PetscReal vx[BOX_FUNCTIONS], vy[BOX_FUNCTIONS];
  (void)PetscArrayzero(rows, count * t->rank);
  if (fade == 0) return;
  BoxTableFunctions(t, 0, X[0], vx);
  BoxTableFunctions(t, 1, X[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < count; c++)
      AddBlock(&t->block[q], first + c, vx, vy, fade, rows + c * t->rank + t->block[q].start);
}

PetscReal BoxSum(PetscInt r, const PetscReal l[], const PetscReal x[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * x[m + q];
  for (; m < r; m++) rest += l[m] * x[m];
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}
