#include "layers/wallimage.h"

/* The half-space lattice's mobility of markers i and j near a wall, x cells apart along it. */
static void WallImageHalf(WallImage m, int wall, PetscInt i, PetscInt j, PetscReal x, PetscReal part[]) {
  const ImagePlaces *p = &m->kernel->places;
  const int t = 1 - wall / 2, turned[3] = {t, 1 - t, 2}; /* components and parts in x and y */
  const int sources = m->source ? m->kernel->sources : 2;
  const PaddedStencil *from = m->source ? m->source : m->velocity;
  for (int q = 0; q < p->parts; q++) {
    const int to = p->response[q], of = p->source[q];
    const WallRows *a = &m->end[wall][i].row[to];
    const WallRows *b = m->source ? &m->row[wall][sources * j + of] : &m->end[wall][j].row[of];
    part[q] = ImageSum(m->table->value[q], m->markers->grid, t, x,
                       &(ImageRows){a->first, a->n, a->weight, &m->velocity[2 * i + turned[to]]},
                       &(ImageRows){b->first, b->n, b->weight, &from[sources * j + turned[of]]});
  }
}

/* One wall's part, added. Stencils that are scaled near the wall take s s' of the half-space's mobility K + image -
   C_free - C_image only: the rest comes on top. */
static void WallImageAddOne(WallImage m, int wall, PetscInt i, PetscInt j, const PetscReal d[2], const PetscReal L[],
                            PetscReal C[]) {
  const ImagePlaces *p = &m->kernel->places;
  const ImageEnd *e = &m->end[wall][i], *f = &m->end[wall][j];
  const PetscReal at[3] = {d[1 - wall / 2] / m->markers->grid->h, m->y[wall][i], m->y[wall][j]};
  const Lanes x = at[0] - (Lanes){0}, a = at[1] - (Lanes){0}, b = at[2] - (Lanes){0};
  const PetscReal scale[2] = {e->scale, m->source ? 1 : f->scale}, across = m->form.moment[1].second;
  const PetscReal reach = PetscMin(at[1], at[2]) < FOLD_SCALED ? IMAGE_CELLS : IMAGE_OFF; /* stencils are summed */
  const PetscBool near = at[0] * at[0] + PetscSqr(at[1] + at[2]) < reach * reach;
  const PetscBool scaled = scale[0] < 1 || scale[1] < 1;
  Lanes exact[PAIR_PARTS] = {{0}}, far[PAIR_PARTS] = {{0}};
  PetscReal free[PAIR_PARTS] = {0}, part[PAIR_PARTS];
  if (near || scaled) { /* free: the lattice's mobility without walls, seen from the wall, in cells, of viscosity 1 */
    for (int q = 0; q < p->parts; q++)
      free[q] = (wall % 2 && p->odd[q] ? -1 : 1) * L[p->place[wall / 2][q]] / m->scale + (q < 2 ? m->logarithm : 0);
    m->kernel->image_exact(&m->form, x, a, b, exact);
  }
  if (near)
    WallImageHalf(m, wall, i, j, at[0], part);
  else
    m->kernel->image_far(&m->form, x, a, b, (const PetscReal[2]){e->moment - across, f->moment - across}, far);
  for (int q = 0; q < p->parts; q++) {
    const PetscReal s = (p->response[q] ? scale[0] : 1) * (p->source[q] ? scale[1] : 1);
    part[q] = near ? exact[q][0] + free[q] - part[q] : far[q][0];
    if (!near && scaled) part[q] += (1 - s) * (free[q] + exact[q][0] - part[q]);
  }
  ImageTurn(p, wall, m->scale, part, C);
}

void WallImageAdd(WallImage m, const PetscBool without[4], PetscInt i, PetscInt j, const PetscReal d[2],
                  const PetscReal L[], PetscReal C[]) {
  for (int wall = 0; wall < 4; wall++)
    if (m->end[wall] && !(without && without[wall])) WallImageAddOne(m, wall, i, j, d, L, C);
}

void WallImageAddExact(WallImage m, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal alpha, PetscReal C[]) {
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal *y = m->y[wall];
    Lanes K[PAIR_PARTS];
    if (!y) continue;
    const Lanes x = d[1 - wall / 2] / m->markers->grid->h - (Lanes){0};
    WallImageFour(m->kernel, m, wall, PETSC_TRUE, (const Lanes[]){x, y[i] - (Lanes){0}, y[j] - (Lanes){0}}, K);
    for (int q = 0; q < m->kernel->places.parts; q++) C[q] += alpha * K[q][0];
  }
}

NearBounds NearBoundsOf(PetscInt n, const PetscReal X[]) {
  NearBounds b = {{PETSC_MAX_REAL, PETSC_MAX_REAL}, {PETSC_MIN_REAL, PETSC_MIN_REAL}};
  for (PetscInt k = 0; k < 2 * n; k++) {
    b.low[k % 2] = PetscMin(b.low[k % 2], X[k]);
    b.high[k % 2] = PetscMax(b.high[k % 2], X[k]);
  }
  return b;
}

PetscReal WallGap(Grid g, int wall, const NearBounds *a, const NearBounds *b) {
  const int direction = wall / 2;
  if (wall % 2) return 2 * g->hi[direction] - a->high[direction] - b->high[direction];
  return a->low[direction] + b->low[direction] - 2 * g->lo[direction];
}

PetscBool WallsAreFar(Grid g, const PetscReal X[2], const NearBounds *box, PetscBool far[4]) {
  const NearBounds at = {{X[0], X[1]}, {X[0], X[1]}};
  PetscBool all = PETSC_TRUE;
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal off = PetscMin(WallGap(g, wall, &at, &at), WallGap(g, wall, box, box));
    const PetscBool near = g->wall[wall / 2] &&
                           (off < 2 * FOLD_SCALED * g->h || WallGap(g, wall, &at, box) < IMAGE_OFF * g->h);
    if (near) all = PETSC_FALSE;
    if (far) far[wall] = near ? PETSC_FALSE : PETSC_TRUE;
  }
  return all;
}

/* SUM w [c|c| - sgn(c)/4] - y^2 + 1/4 over the tangential stencil's rows at c from the wall, before it is folded. */
static PetscReal OddMoment(PetscReal y, const WallRows *row) {
  PetscReal sum = 0.25 - y * y;
  for (PetscInt k = 0; k < row->n; k++) {
    const PetscReal c = row->first + k + 0.5;
    sum += row->weight[k] * (c > 0 ? c * c - 0.25 : 0.25 - c * c);
  }
  return sum;
}

/* Rows of a stencil y cells from a wall, on entries half or whole cells from it; row 0 of the latter is on the wall. */
static WallRows WallRowsOf(KernelWeights weights, PetscReal y, PetscBool whole) {
  WallRows row;
  row.n = weights(y - (whole ? 1 : 0.5), &row.first, row.weight);
  return row;
}
static void WallRowsFold(FoldKind kind, PetscBool whole, WallRows *row) {
  FoldLow(kind, &row->first, &row->n, row->weight);
  if (whole) row->first++;
}

/* Where a marker, y cells away, sees a wall; without weights where it is far. */
static void PlaceEnd(Markers m, PetscReal y, PetscReal across, ImageEnd *e) {
  e->scale = m->scaled ? WallScale(m->kernel, y) : 1;
  e->moment = across;
  e->row[0].n = e->row[1].n = 0;
  if (y >= IMAGE_CELLS) return;
  e->row[0] = WallRowsOf(m->kernel->across, y, PETSC_FALSE);
  e->row[1] = WallRowsOf(m->kernel->along, y, PETSC_TRUE);
  if (e->row[0].first < 0) e->moment = OddMoment(y, &e->row[0]);
  WallRowsFold(FOLD_ODD, PETSC_FALSE, &e->row[0]);
  WallRowsFold(FOLD_EVEN, PETSC_TRUE, &e->row[1]);
  for (PetscInt k = 0; k < e->row[1].n; k++) e->row[1].weight[k] *= e->scale;
}

PetscErrorCode WallImagePlace(WallImage m, const PaddedStencil velocity[], const PaddedStencil source[]) {
  static const KernelWeights weights[DIPOLE_COUNT] = {KernelSpline4, KernelSpline6,
                                                      KernelSpline5}; /* across the wall */
  const Grid g = m->markers->grid;
  PetscFunctionBeginUser;
  m->velocity = velocity;
  m->source = source;
  for (int wall = 0; wall < 4; wall++) {
    if (!m->end[wall]) continue;
    if (source && !m->row[wall]) PetscCall(PetscMalloc1(m->kernel->sources * m->markers->layout->M, &m->row[wall]));
    for (PetscInt k = 0; k < m->markers->layout->M; k++) {
      const PetscReal X = m->markers->X[2 * k + wall / 2];
      const PetscReal y = (wall % 2 ? g->hi[wall / 2] - X : X - g->lo[wall / 2]) / g->h;
      if (m->owner) m->y[wall][k] = y;
      if (m->owner) PlaceEnd(m->markers, y, m->form.moment[1].second, &m->end[wall][k]);
      for (int part = 0; part < DIPOLE_COUNT && m->row[wall] && y < IMAGE_CELLS; part++) {
        WallRows *row = &m->row[wall][DIPOLE_COUNT * k + part];
        *row = WallRowsOf(weights[part], y, part == DIPOLE_XY);
        WallRowsFold(FOLD_SMOOTH, part == DIPOLE_XY, row);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallImageCreate(const PairKernel *kernel, const LayerSetting *set, const OffsetTable *lattice,
                               const ImageTable *half, WallImage velocities, WallImage *out) {
  const Grid g = set->markers->grid;
  const PetscInt M = set->markers->layout->M;
  WallImage m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->kernel = kernel;
  m->markers = set->markers;
  m->scale = PetscPowRealInt(set->nu, kernel->viscosity) * PetscPowRealInt(g->h, kernel->length);
  m->logarithm = kernel->level * PetscLogReal(g->h / set->unit);
  m->table = half;
  m->owner = velocities ? PETSC_FALSE : PETSC_TRUE;
  kernel->image_make(set->markers->kernel, &m->form);
  if (!half && (g->wall[0] || g->wall[1])) {
    PetscCall(PetscNew(&m->made));
    PetscCall(kernel->image_fill(lattice, m->made));
    m->table = m->made;
  }
  for (int wall = 0; wall < 4; wall++) {
    if (!g->wall[wall / 2]) continue;
    if (m->owner)
      PetscCall(PetscCalloc2(M, &m->end[wall], M + LANES, &m->y[wall]));
    else {
      m->end[wall] = velocities->end[wall];
      m->y[wall] = velocities->y[wall];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallImageDestroy(WallImage *image) {
  WallImage m = *image;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  for (int wall = 0; wall < 4; wall++) {
    if (m->owner) PetscCall(PetscFree2(m->end[wall], m->y[wall]));
    PetscCall(PetscFree(m->row[wall]));
  }
  PetscCall(PetscFree(m->made));
  PetscCall(PetscFree(*image));
  PetscFunctionReturn(PETSC_SUCCESS);
}
