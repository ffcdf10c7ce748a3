#include "markers/dipolerows.h"

#define BELOW 1 /* rows below the own ones, */
#define ABOVE 2 /* and above them, of which the force on the row above has to know */

/* A field's row j, which may be up to BELOW below the own ones or ABOVE above them. */
static PetscScalar *Row(DipoleRows d, Field f, PetscInt j) {
  return d->field[f] + (j + BELOW) * d->grid->n[0];
}

PetscErrorCode DipoleRowsCreate(Grid g, PetscReal nu, DipoleRows *out) {
  const PetscInt size = (g->rows[FIELD_U] + BELOW + ABOVE) * g->n[0];
  DipoleRows d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  *out = d;
  d->grid = g;
  d->nu = nu;
  PetscCall(
      PetscCalloc5(size, &d->field[0], size, &d->field[1], size, &d->field[2], g->n[1], &d->mean, g->n[1], &d->flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DipoleRowsDestroy(DipoleRows *rows) {
  DipoleRows d = *rows;
  PetscFunctionBeginUser;
  if (!d) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree5(d->field[0], d->field[1], d->field[2], d->mean, d->flow));
  PetscCall(PetscFree(*rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void Clear(DipoleRows d) {
  const PetscInt n = (d->window[1] - d->window[0]) * d->grid->n[0];
  for (int f = 0; f < 3 && n > 0; f++) (void)PetscArrayzero(Row(d, (Field)f, d->window[0]), n);
  d->window[0] = d->grid->rows[FIELD_U] + ABOVE;
  d->window[1] = -BELOW;
  (void)PetscArrayzero(d->mean, d->grid->n[1]);
}

/* The first local row that is this row of the grid; others follow after a period. */
static inline PetscInt FirstRow(const Grid g, PetscInt entry) {
  PetscInt j = entry - g->first;
  if (g->wall[1]) return j;
  while (j - g->n[1] >= -BELOW) j -= g->n[1];
  while (j < -BELOW) j += g->n[1];
  return j;
}

static void Add(DipoleRows d, const DipoleSpot *s, PetscReal part) {
  const Grid g = d->grid;
  const PetscReal *weight = s->line[0].weight;
  const PetscReal mean = LanesSum(LanesAt(weight) + LanesAt(weight + LANES)) / (PetscReal)g->n[0];
  const PetscInt end = g->rows[FIELD_U] + ABOVE, n = g->n[1];
  PetscInt low = d->window[0], high = d->window[1];
  for (PetscInt q = 0; q < s->line[1].n; q++) {
    const PetscInt entry = s->line[1].first + q;
    const PetscReal value = part * s->line[1].weight[q];
    if (s->field == FIELD_P) d->mean[entry < 0 ? entry + n : entry < n ? entry : entry - n] += mean * value;
    for (PetscInt j = FirstRow(g, entry); j >= -BELOW && j < end; j += g->wall[1] ? end + BELOW : n) {
      DipoleAddRow(g, s, value, Row(d, s->field, j));
      low = PetscMin(low, j);
      high = PetscMax(high, j + 1);
    }
  }
  d->window[0] = low;
  d->window[1] = high;
}

/* From a row's source to b, whose mean is zero. */
static void SumRow(PetscInt n, PetscReal h, PetscReal mean, PetscScalar row[]) {
  PetscReal b = 0, sum = 0;
  for (PetscInt i = 0; i < n; i++) {
    b += h * (mean - row[i]);
    row[i] = b;
    sum += b;
  }
  sum /= (PetscReal)n;
  for (PetscInt i = 0; i < n; i++) row[i] -= sum;
}

/* From the rows' mean sources to v, zero at a wall and else of zero mean. */
static void SumMeans(const Grid g, PetscScalar mean[]) {
  PetscReal v = 0, sum = 0;
  for (PetscInt j = 0; j < g->n[1]; j++) {
    v -= g->h * mean[j];
    mean[j] = v;
    sum += v;
  }
  for (PetscInt j = 0; j < g->n[1] && !g->wall[1]; j++) mean[j] -= sum / (PetscReal)g->n[1];
}

PetscErrorCode DipoleRowsSet(DipoleRows d, PetscInt M, const DipoleSpot spot[], const PetscReal T[],
                             const PetscReal profile[], const PetscReal mean[2]) {
  const Grid g = d->grid;
  PetscFunctionBeginUser;
  Clear(d);
  for (PetscInt k = 0; k < DIPOLE_SPOTS * M; k++) {
    const PetscReal *t = T + k / DIPOLE_SPOTS * DIPOLE_COUNT;
    if (t[0] != 0 || t[1] != 0 || t[2] != 0) Add(d, &spot[k], spot[k].value * t[spot[k].part]);
  }
  for (PetscInt j = d->window[0]; j < d->window[1]; j++)
    SumRow(g->n[0], g->h, d->mean[(j + g->first + g->n[1]) % g->n[1]], Row(d, FIELD_P, j));
  SumMeans(g, d->mean);
  for (PetscInt j = 0; j < g->n[1]; j++) {
    d->flow[j] = mean[0] * (profile ? profile[j] : g->wall[1] ? 0 : 1);
    if (!g->wall[1]) d->mean[j] += mean[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* row += factor (the five-point sum of b), rows low and high beside it, over a period. */
static void AddLaplacian(PetscInt n, PetscReal factor, const PetscScalar *restrict b, PetscReal below,
                         const PetscScalar *restrict low, PetscReal above, const PetscScalar *restrict high,
                         PetscScalar *restrict row) {
  row[0] += factor * (b[n - 1] + b[1] + below * low[0] + above * high[0] - 4 * b[0]);
  for (PetscInt i = 1; i + 1 < n; i++)
    row[i] += factor * (b[i - 1] + b[i + 1] + below * low[i] + above * high[i] - 4 * b[i]);
  row[n - 1] += factor * (b[n - 2] + b[0] + below * low[n - 1] + above * high[n - 1] - 4 * b[n - 1]);
}

/* y += x */
static void AddRow(PetscInt n, const PetscScalar *restrict x, PetscScalar *restrict y) {
  for (PetscInt i = 0; i < n; i++) y[i] += x[i];
}

void DipoleRowsAddForce(DipoleRows d, PetscBool own, Field f, PetscInt j, PetscScalar row[]) {
  const PetscInt n = d->grid->n[0];
  if (j < d->window[0] - 1 || j > d->window[1]) return;
  if (own) AddRow(n, Row(d, f, j), row);
  if (f == FIELD_V) return;
  /* beyond a wall there is minus the row next to it */
  const PetscBool bottom = d->grid->wall[1] && d->grid->first + j == 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool top = d->grid->wall[1] && d->grid->first + j == d->grid->n[1] - 1 ? PETSC_TRUE : PETSC_FALSE;
  const PetscScalar *low = Row(d, FIELD_P, bottom ? j : j - 1), *high = Row(d, FIELD_P, top ? j : j + 1);
  AddLaplacian(n, d->nu / PetscSqr(d->grid->h), Row(d, FIELD_P, j), bottom ? -1 : 1, low, top ? -1 : 1, high, row);
}

void DipoleRowsAddVelocity(DipoleRows d, PetscInt j, PetscScalar row[]) {
  if (j < d->window[0] || j >= d->window[1]) return;
  AddRow(d->grid->n[0], Row(d, FIELD_P, j), row);
}
