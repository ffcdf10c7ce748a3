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

/* Put stencils on the grid: first entries into the period, weights folded at walls. */
static void DipoleWrap(Grid g, Stencil s[DIPOLE_COUNT]) {
  for (int k = 0; k < DIPOLE_COUNT; k++)
    for (int dir = 0; dir < 2; dir++) {
      PetscInt *first = &s[k].first[dir];
      if (g->wall[dir]) {
        FoldLow(FOLD_SMOOTH, first, &s[k].n[dir], s[k].weight[dir]);
        FoldHigh(FOLD_SMOOTH, g->n[dir] - (k == DIPOLE_XY ? 2 : 1), first, &s[k].n[dir], s[k].weight[dir]);
      } else
        *first = ((*first % g->n[dir]) + g->n[dir]) % g->n[dir];
    }
}

/* Keep the entries of a line that are unknowns of the field: faces on walls are not. */
static void LineClip(Grid g, Field field, int dir, DipoleLine *line) {
  const PetscInt end = (int)field == dir ? g->n[dir] - 1 : g->n[dir];
  PetscInt skip = 0;
  if (!g->wall[dir] || (line->first >= 0 && line->first + line->n <= end)) return;
  while (skip < line->n && line->first + skip < 0) skip++;
  while (line->n > skip && line->first + line->n > end) line->n--;
  line->n -= skip;
  line->first += skip;
  for (PetscInt k = 0; k < DIPOLE_POINTS; k++) line->weight[k] = k < line->n ? line->weight[k + skip] : 0;
}

/* A line of a stencil's weights along dir (before < 0), or a line of the differences of neighbouring weights. The first
   difference belongs to the stencil's first entry (before = 0) or to the entry before it (before = 1). */
static void LineMake(Grid g, Field field, const Stencil *s, int dir, PetscInt before, DipoleLine *line) {
  const PetscInt difference = before >= 0 ? 1 : 0;
  PetscReal w[DIPOLE_POINTS + 1] = {0};
  for (PetscInt k = 0; k < s->n[dir]; k++) w[k + 1] = s->weight[dir][k];
  line->first = s->first[dir] - (before > 0);
  line->n = s->n[dir] + difference;
  for (PetscInt k = 0; k < DIPOLE_POINTS; k++) line->weight[k] = w[k + 1] - difference * w[k];
  LineClip(g, field, dir, line);
}

void DipoleSpotsOf(Grid g, PetscReal nu, Stencil s[DIPOLE_COUNT], DipoleSpot spot[DIPOLE_SPOTS]) {
  const PetscReal force = -nu / PetscPowRealInt(g->h, 3), half = -0.5 / PetscSqr(g->h);
  enum { PLAIN = -1 };
  static const struct {
    Field field;
    DipolePart part;
    PetscInt before[2]; /* argument `before` of LineMake along x and y */
  } form[DIPOLE_SPOTS] = {{FIELD_U, DIPOLE_XX, {1, PLAIN}},     {FIELD_U, DIPOLE_XY, {PLAIN, 0}},
                          {FIELD_V, DIPOLE_XY, {0, PLAIN}},     {FIELD_V, DIPOLE_YY, {PLAIN, 1}},
                          {FIELD_P, DIPOLE_XX, {PLAIN, PLAIN}}, {FIELD_P, DIPOLE_YY, {PLAIN, PLAIN}}};
  DipoleWrap(g, s);
  for (int q = 0; q < DIPOLE_SPOTS; q++) {
    spot[q].field = form[q].field;
    spot[q].part = form[q].part;
    spot[q].value = form[q].field == FIELD_P ? half : force;
    for (int dir = 0; dir < 2; dir++)
      LineMake(g, form[q].field, &s[form[q].part], dir, form[q].before[dir], &spot[q].line[dir]);
  }
}

void DipoleSpots(Grid g, PetscReal nu, const PetscReal X[2], DipoleSpot spot[DIPOLE_SPOTS]) {
  Stencil s[DIPOLE_COUNT];
  DipoleStencilsUnwrapped(g, X, s);
  DipoleSpotsOf(g, nu, s, spot);
}

/* First moment of a line's weights along dir about the middle of the box (length), and the sum of the weights. */
static PetscReal LineMoment(Grid g, const DipoleSpot *s, int dir, PetscReal *sum) {
  const DipoleLine *line = &s->line[dir];
  const PetscReal half = (int)s->field == dir ? 1 : 0.5;
  PetscReal moment = 0;
  *sum = 0;
  for (PetscInt k = 0; k < line->n; k++) {
    *sum += line->weight[k];
    moment += line->weight[k] * (line->first + k + half - 0.5 * g->n[dir]) * g->h;
  }
  return moment;
}

/* Sum of the weights of a line in the rows next to the walls along dir. */
static PetscReal LineEnds(Grid g, const DipoleLine *line, int dir) {
  PetscReal sum = 0;
  for (PetscInt k = 0; k < line->n; k++)
    if (line->first + k == 0 || line->first + k == g->n[dir] - 1) sum += line->weight[k];
  return sum;
}

void DipoleShortfall(Grid g, PetscReal nu, const PetscReal X[2], const PetscReal T[DIPOLE_COUNT], int dir,
                     PetscReal shortfall[2]) {
  const PetscReal cell = PetscSqr(g->h);
  DipoleSpot spot[DIPOLE_SPOTS];
  shortfall[0] = shortfall[1] = 0;
  if (!g->wall[dir] || PetscMin(X[dir] - g->lo[dir], g->hi[dir] - X[dir]) >= (KERNEL_WALL_CELLS + 1) * g->h) return;
  shortfall[1 - dir] = nu * T[DIPOLE_XY];
  shortfall[dir] = nu * T[dir ? DIPOLE_YY : DIPOLE_XX];
  DipoleSpots(g, nu, X, spot);
  for (int q = 0; q < DIPOLE_SPOTS; q++) {
    PetscReal along, sum;
    (void)LineMoment(g, &spot[q], 1 - dir, &along);
    const PetscReal value = T[spot[q].part] * spot[q].value, part = cell * value * along;
    const PetscReal moment = LineMoment(g, &spot[q], dir, &sum);
    if (spot[q].field == FIELD_P)
      shortfall[dir] += 0.5 * nu * part * LineEnds(g, &spot[q].line[dir], dir) * g->n[dir];
    else
      shortfall[spot[q].field] -= part * moment;
  }
}
