#include "markers/dipolerows.h"

/* Row j of a field: this rank's, up to DIPOLE_BELOW rows below them or DIPOLE_ABOVE above them. */
static PetscScalar *DipoleRow(DipoleRows d, Field f, PetscInt j) {
  return d->field[f] + (j + DIPOLE_BELOW) * d->grid->n[0];
}

PetscErrorCode DipoleRowsCreate(Grid g, PetscReal nu, DipoleRows *out) {
  const PetscInt size = (g->rows[FIELD_U] + DIPOLE_BELOW + DIPOLE_ABOVE) * g->n[0];
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

/* Find the mean source of every row. */
static void DipoleRowMeans(DipoleRows d, StencilRows list, const PetscReal T[]) {
  const PetscInt n = d->grid->n[1];
  (void)PetscArrayzero(d->mean, n);
  for (PetscInt k = 0; k < list->markers; k++)
    for (int q = 0; q < DIPOLE_SPOTS; q++) {
      const Stencil *s = &list->stencil[DIPOLE_SPOTS * k + q];
      if (dipole_form.of[q].field != FIELD_P || !s->n[1]) continue;
      const PetscReal along = LanesSum(LanesAt(s->weight[0]) + LanesAt(s->weight[0] + LANES));
      const PetscReal value = T[DIPOLE_COUNT * k + dipole_form.of[q].part] * along / (PetscReal)d->grid->n[0];
      for (PetscInt b = 0, j = s->first[1]; b < s->n[1]; b++, j++)
        d->mean[j < 0 ? j + n : j < n ? j : j - n] += value * s->weight[1][b];
    }
}

/* Replace the sources of a row by b along x, with zero mean or, between walls, zero on the wall. */
static void DipoleRowSum(DipoleRows d, PetscInt j) {
  const Grid g = d->grid;
  const PetscInt n = g->n[0];
  const PetscReal mean = d->mean[(j + g->first + g->n[1]) % g->n[1]];
  PetscScalar *row = DipoleRow(d, FIELD_P, j);
  PetscReal b = 0, sum = 0;
  for (PetscInt i = 0; i < n; i++) {
    b += g->h * (mean - row[i]);
    row[i] = b;
    sum += b;
  }
  for (PetscInt i = 0; i < n && !g->wall[0]; i++) row[i] -= sum / (PetscReal)n;
  if (g->wall[0]) row[n - 1] = 0;
}

PetscErrorCode DipoleRowsSet(DipoleRows d, StencilRows list, const PetscReal T[], PetscBool own,
                             const PetscReal profile[], const PetscReal mean[2]) {
  const Grid g = d->grid;
  PetscReal net = 0, v = 0, sum = 0;
  PetscInt j, window[2];
  PetscFunctionBeginUser;
  d->own = own;
  DipoleRowMeans(d, list, T);
  DipoleListWindow(list, window);
  for (j = d->window[0]; j < d->window[1]; j++) /* rows next to the window are added to */
    for (int f = 0; f < 3 && (j < window[0] || j >= window[1]); f++)
      PetscCall(PetscArrayzero(DipoleRow(d, (Field)f, j), g->n[0]));
  PetscCall(PetscArraycpy(d->window, window, 2));
  for (j = d->window[0]; j < d->window[1]; j++)
    for (int f = own ? FIELD_U : FIELD_P; f <= FIELD_P; f++) {
      PetscScalar *row = DipoleRow(d, (Field)f, j);
      for (PetscInt i = 0; i < g->n[0]; i++) row[i] = 0;
      StencilRowSpread(list, (Field)f, j, 1, T, row);
    }
  for (j = d->window[0]; j < d->window[1]; j++) DipoleRowSum(d, j);
  for (j = 0; j < g->n[1]; j++) net += d->mean[j] / (PetscReal)g->n[1];
  for (j = 0; j < g->n[1]; j++) { /* b along y, zero at a wall or else with zero mean */
    v -= g->h * (d->mean[j] - net);
    d->mean[j] = v;
    sum += v;
  }
  for (j = 0; j < g->n[1]; j++) {
    d->flow[j] = mean[0] * (profile ? profile[j] : g->wall[1] ? 0 : 1);
    if (!g->wall[1]) d->mean[j] += mean[1] - sum / (PetscReal)g->n[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* row += factor (five-point sum), over a period of n entries, of the rows low, b, high = rows[], low and high times
   sign[]. The last entry is left out where it is on a wall. */
static void RowAddLaplacian(PetscInt n, PetscBool wall, PetscReal factor, const PetscScalar *const rows[3],
                            const PetscReal sign[2], PetscScalar *restrict row) {
  const PetscScalar *restrict low = rows[0], *restrict b = rows[1], *restrict high = rows[2];
  const PetscReal below = sign[0], above = sign[1];
  row[0] += factor * (b[n - 1] + b[1] + below * low[0] + above * high[0] - 4 * b[0]);
  for (PetscInt i = 1; i + 1 < n; i++)
    row[i] += factor * (b[i - 1] + b[i + 1] + below * low[i] + above * high[i] - 4 * b[i]);
  if (!wall) row[n - 1] += factor * (b[n - 2] + b[0] + below * low[n - 1] + above * high[n - 1] - 4 * b[n - 1]);
}

/* y += x */
static void RowAdd(PetscInt n, const PetscScalar *restrict x, PetscScalar *restrict y) {
  for (PetscInt i = 0; i < n; i++) y[i] += x[i];
}

void DipoleRowsAddForce(DipoleRows d, Field f, PetscInt j, PetscScalar row[]) {
  const PetscInt n = d->grid->n[0];
  if (j < d->window[0] - 1 || j > d->window[1]) return;
  if (d->own) RowAdd(d->grid->columns[f], DipoleRow(d, f, j), row);
  if (f == FIELD_V) return;
  /* beyond a wall b is minus the row next to the wall */
  const PetscBool bottom = d->grid->wall[1] && d->grid->first + j == 0;
  const PetscBool top = d->grid->wall[1] && d->grid->first + j == d->grid->n[1] - 1;
  const PetscScalar *low = DipoleRow(d, FIELD_P, bottom ? j : j - 1), *high = DipoleRow(d, FIELD_P, top ? j : j + 1);
  RowAddLaplacian(n, d->grid->wall[0], d->nu / PetscSqr(d->grid->h),
                  (const PetscScalar *[]){low, DipoleRow(d, FIELD_P, j), high},
                  (PetscReal[]){bottom ? -1 : 1, top ? -1 : 1}, row);
}

void DipoleRowsAddVelocity(DipoleRows d, PetscInt j, PetscScalar row[]) {
  if (j < d->window[0] || j >= d->window[1]) return;
  RowAdd(d->grid->columns[FIELD_U], DipoleRow(d, FIELD_P, j), row);
}
