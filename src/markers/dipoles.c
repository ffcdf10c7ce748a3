#include "markers/dipoles.h"
#include "markers/wallfold.h"

void DipoleStencilsUnwrapped(Grid g, const PetscReal X[2], Stencil s[DIPOLE_COUNT]) {
  static const KernelWeights weights[DIPOLE_COUNT][2] = {
      {KernelSpline6, KernelSpline4}, {KernelSpline4, KernelSpline6}, {KernelSpline5, KernelSpline5}};
  for (int k = 0; k < DIPOLE_COUNT; k++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal r = (X[dir] - g->lo[dir]) / g->h - (k == DIPOLE_XY ? 1.0 : 0.5);
      s[k].n[dir] = weights[k][dir](r, &s[k].first[dir], s[k].weight[dir]);
    }
}

/* Keep the entries along dir that are unknowns of the field: faces on walls are not. */
static void SpotClip(Grid g, Field field, int dir, Stencil *spot) {
  const PetscInt end = (int)field == dir ? g->n[dir] - 1 : g->n[dir];
  PetscInt *first = &spot->first[dir], *n = &spot->n[dir], skip = 0;
  if (!g->wall[dir] || (*first >= 0 && *first + *n <= end)) return;
  while (skip < *n && *first + skip < 0) skip++;
  while (*n > skip && *first + *n > end) --*n;
  *n -= skip;
  *first += skip;
  for (PetscInt k = 0; k < STENCIL_POINTS; k++) spot->weight[dir][k] = k < *n ? spot->weight[dir][k + skip] : 0;
}

enum { PLAIN = -1 };

/* `factor` times a stencil's weights along dir (before PLAIN), or times the differences of neighbouring weights. The
   first difference belongs to the stencil's first entry (before = 0) or to the entry before it (before = 1). */
static void SpotMake(Grid g, Field field, const Stencil *s, int dir, PetscInt before, PetscReal factor, Stencil *spot) {
  const PetscInt difference = before == PLAIN ? 0 : 1;
  PetscReal w[STENCIL_POINTS + 1] = {0};
  for (PetscInt k = 0; k < s->n[dir]; k++) w[k + 1] = factor * s->weight[dir][k];
  spot->first[dir] = s->first[dir] - (before == 1);
  spot->n[dir] = s->n[dir] + difference;
  for (PetscInt k = 0; k < STENCIL_POINTS; k++) spot->weight[dir][k] = w[k + 1] - difference * w[k];
  SpotClip(g, field, dir, spot);
}

const StencilForm dipole_form = {.stencils = DIPOLE_SPOTS,
                                 .parts = DIPOLE_COUNT,
                                 .of = {{FIELD_U, DIPOLE_XX},
                                        {FIELD_U, DIPOLE_XY},
                                        {FIELD_V, DIPOLE_XY},
                                        {FIELD_V, DIPOLE_YY},
                                        {FIELD_P, DIPOLE_XX},
                                        {FIELD_P, DIPOLE_YY}}};

void DipoleSpotsOf(Grid g, PetscReal nu, Stencil s[DIPOLE_COUNT], Stencil spot[DIPOLE_SPOTS]) {
  const PetscReal force = -nu / PetscPowRealInt(g->h, 3), half = -0.5 / PetscSqr(g->h);
  static const PetscInt before[DIPOLE_SPOTS][2] = {{1, PLAIN}, {PLAIN, 0},     {0, PLAIN},
                                                   {PLAIN, 1}, {PLAIN, PLAIN}, {PLAIN, PLAIN}};
  for (int k = 0; k < DIPOLE_COUNT; k++) /* onto the grid: first entries into the period, weights folded at walls */
    for (int dir = 0; dir < 2; dir++) {
      PetscInt *first = &s[k].first[dir];
      if (g->wall[dir]) {
        FoldLow(FOLD_SMOOTH, first, &s[k].n[dir], s[k].weight[dir]);
        FoldHigh(FOLD_SMOOTH, g->n[dir] - (k == DIPOLE_XY ? 2 : 1), first, &s[k].n[dir], s[k].weight[dir]);
      } else
        *first = ((*first % g->n[dir]) + g->n[dir]) % g->n[dir];
    }
  for (int q = 0; q < DIPOLE_SPOTS; q++) {
    const Field field = dipole_form.of[q].field;
    const Stencil *part = &s[dipole_form.of[q].part];
    SpotMake(g, field, part, 0, before[q][0], 1, &spot[q]);
    SpotMake(g, field, part, 1, before[q][1], field == FIELD_P ? half : force, &spot[q]);
  }
}

void DipoleSpots(Grid g, PetscReal nu, const PetscReal X[2], Stencil spot[DIPOLE_SPOTS]) {
  Stencil s[DIPOLE_COUNT];
  DipoleStencilsUnwrapped(g, X, s);
  DipoleSpotsOf(g, nu, s, spot);
}

/* First moment of a spot's weights along dir about the middle of the box (length), and the sum of the weights. */
static PetscReal SpotMoment(Grid g, Field field, const Stencil *s, int dir, PetscReal *sum) {
  const PetscReal half = (int)field == dir ? 1 : 0.5;
  PetscReal moment = 0;
  *sum = 0;
  for (PetscInt k = 0; k < s->n[dir]; k++) {
    *sum += s->weight[dir][k];
    moment += s->weight[dir][k] * (s->first[dir] + k + half - 0.5 * g->n[dir]) * g->h;
  }
  return moment;
}

void DipoleShortfall(Grid g, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT], int dir,
                     PetscReal shortfall[2]) {
  const PetscReal cell = PetscSqr(g->h);
  Stencil spot[DIPOLE_SPOTS];
  shortfall[0] = shortfall[1] = 0;
  if (!g->wall[dir] || PetscMin(X[dir] - g->lo[dir], g->hi[dir] - X[dir]) >= (KERNEL_WALL_CELLS + 1) * g->h) return;
  shortfall[1 - dir] = nu * T[DIPOLE_XY];
  shortfall[dir] = nu * T[dir ? DIPOLE_YY : DIPOLE_XX];
  DipoleSpots(g, nu, X, spot);
  for (int q = 0; q < DIPOLE_SPOTS; q++) {
    const Field field = dipole_form.of[q].field;
    PetscReal along, sum;
    (void)SpotMoment(g, field, &spot[q], 1 - dir, &along);
    const PetscReal part = cell * T[dipole_form.of[q].part] * along, moment = SpotMoment(g, field, &spot[q], dir, &sum);
    PetscReal ends = 0; /* weights in the rows next to the walls */
    for (PetscInt k = 0; k < spot[q].n[dir]; k++)
      if (spot[q].first[dir] + k == 0 || spot[q].first[dir] + k == g->n[dir] - 1) ends += spot[q].weight[dir][k];
    if (field == FIELD_P)
      shortfall[dir] += 0.5 * nu * part * ends * g->n[dir];
    else
      shortfall[field] -= part * moment;
  }
}

/* With a period a row may be in the list more than once, and `window` may reach beyond this rank's rows. */
void DipoleListWindow(StencilRows list, PetscInt window[2]) {
  const PetscInt end = list->grid->rows[FIELD_U] + list->above;
  window[0] = end;
  window[1] = -list->below;
  for (int f = 0; f < 3; f++)
    for (PetscInt j = -list->below; j < end; j++) {
      const PetscInt *start = list->start[f] + j + list->below;
      if (start[0] == start[1]) continue;
      window[0] = PetscMin(window[0], j);
      window[1] = PetscMax(window[1], j + 1);
    }
}

PetscErrorCode DipoleListSpread(StencilRows list, const PetscReal T[], Vec w, Vec source) {
  const Grid g = list->grid;
  PetscScalar *a[3];
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(w, &a[FIELD_U]));
  PetscCall(VecGetArray(source, &a[FIELD_P]));
  a[FIELD_V] = a[FIELD_U] + GridLocalU(g);
  for (int f = 0; f < 3; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++) StencilRowSpread(list, (Field)f, j, 1, T, a[f] + j * g->columns[f]);
  PetscCall(VecRestoreArray(source, &a[FIELD_P]));
  PetscCall(VecRestoreArray(w, &a[FIELD_U]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
