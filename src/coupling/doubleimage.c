#include "coupling/doubleimage.h"

#define PARTS(K) ((const PetscReal(*)[DIPOLE_COUNT])(K)) /* as what is only read */

PetscErrorCode DoubleImageCreate(NearImage single, const OffsetTable lattice[2], DoubleImage *out) {
  const Markers markers = single->markers;
  DoubleImage m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->single = single;
  DipoleImageFormsMake(single->kernel.moment, &m->forms);
  if (!single->table) PetscFunctionReturn(PETSC_SUCCESS);
  for (int wall = 0; wall < 4; wall++)
    if (single->end[wall / 2][wall % 2]) PetscCall(PetscMalloc1(markers->layout->M, &m->end[wall / 2][wall % 2]));
  PetscCall(PetscNew(&m->table));
  PetscCall(DipoleImageFill(lattice, m->table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleImageDestroy(DoubleImage *image) {
  DoubleImage m = *image;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  for (int wall = 0; wall < 4; wall++) PetscCall(PetscFree(m->end[wall / 2][wall % 2]));
  PetscCall(PetscFree(m->table));
  PetscCall(PetscFree(*image));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of a dipole y cells from a wall; parts seen from it. */
static DipoleEnd MakeEnd(PetscReal y) {
  const Kernel *five = KernelFind("cbs54"), *six = KernelFind("cbs65");
  const KernelWeights weights[DIPOLE_COUNT] = {five->across, six->along, five->along};
  DipoleEnd e;
  for (int part = 0; part < DIPOLE_COUNT; part++) {
    const PetscBool node = part == DIPOLE_XY ? PETSC_TRUE : PETSC_FALSE; /* nodes at j + 1, cells at j + 1/2 */
    e.n[part] = weights[part](y - (node ? 1.0 : 0.5), &e.first[part], e.weight[part]);
    FoldLow(FOLD_SMOOTH, &e.first[part], &e.n[part], e.weight[part]);
    if (node) e.first[part]++; /* rows of the table: 0 on the wall */
  }
  return e;
}

void DoubleImagePlace(DoubleImage m, const PaddedStencil dipole[]) {
  m->dipole = dipole;
  for (int wall = 0; wall < 4; wall++)
    for (PetscInt k = 0; k < m->single->markers->layout->M && m->end[wall / 2][wall % 2]; k++) {
      const PetscReal y = m->single->y[wall / 2][wall % 2][k];
      if (y < IMAGE_CELLS) m->end[wall / 2][wall % 2][k] = MakeEnd(y);
    }
}

/* A part, seen from a wall, in the directions of the grid, or the other way round. */
static int Turned(int direction, int part) {
  return direction || part == DIPOLE_XY ? part : 1 - part;
}

/* K += alpha times a pair's parts, turned from the wall with this normal and side to x and y. */
static void Turn(int direction, int side, PetscReal alpha, const PetscReal part[2][DIPOLE_COUNT],
                 PetscReal K[2][DIPOLE_COUNT]) {
  for (int c = 0; c < 2; c++)
    for (int q = 0; q < DIPOLE_COUNT; q++) {
      const PetscBool odd = (c == 1) != (q == DIPOLE_XY) ? PETSC_TRUE : PETSC_FALSE; /* in the distance from the wall */
      K[c ? direction : 1 - direction][Turned(direction, q)] += side && odd ? -alpha * part[c][q] : alpha * part[c][q];
    }
}

/* The half-space lattice's answer at i to the parts of j near the wall, seen from it. */
static void Half(DoubleImage m, int direction, PetscReal x, PetscInt i, const ImageEnd *e, PetscInt j,
                 const DipoleEnd *f, PetscReal K[2][DIPOLE_COUNT]) {
  const int t = 1 - direction;
  for (int c = 0; c < 2; c++)
    for (int part = 0; part < DIPOLE_COUNT; part++) {
      const PaddedStencil *from = &m->single->stencil[2 * i + (c ? direction : t)];
      const PaddedStencil *to = &m->dipole[DIPOLE_COUNT * j + Turned(direction, part)];
      const ImageRows row = {e->first[c], e->n[c], e->weight[c]};
      const ImageRows source = {f->first[part], f->n[part], f->weight[part]};
      K[c][part] = ImageSum(m->table->value[part][c], m->single->markers->grid, t, x, from, &row, to, &source);
    }
}

static void AddParts(PetscReal alpha, const PetscReal from[2][DIPOLE_COUNT], PetscReal to[2][DIPOLE_COUNT]) {
  for (int c = 0; c < 2; c++)
    for (int k = 0; k < DIPOLE_COUNT; k++) to[c][k] += alpha * from[c][k];
}

/* What the lattice has of one wall for a pair, whose image in exact fluid is blake, and how much of each component of
   its answer without walls is to be taken off. Responses that are scaled near the wall take s of the half space's free
   + exact - far only. */
static void OnLattice(DoubleImage m, int direction, int side, PetscInt i, PetscInt j, const ImagePair *p,
                      const PetscReal blake[2][DIPOLE_COUNT], PetscReal grid[2][DIPOLE_COUNT], PetscReal less[2]) {
  const PetscReal over = 1 / m->single->markers->grid->h;
  const ImageEnd *e = &m->single->end[direction][side][i];
  PetscReal part[2][DIPOLE_COUNT];
  less[0] = less[1] = 1;
  if (NearImageIsNear(p)) {
    Half(m, direction, p->x, i, e, j, &m->end[direction][side][j], part);
    Turn(direction, side, over, PARTS(part), grid);
    return;
  }
  DipoleImageFar(&m->forms, p, part);
  Turn(direction, side, -over, PARTS(part), grid);
  for (int c = 0; c < 2; c++) {
    const PetscReal scale = c == direction ? e->scale : 1;
    less[c] = 1 - scale;
    for (int k = 0; k < DIPOLE_COUNT; k++) grid[c][k] = scale * (grid[c][k] + blake[c][k]);
  }
}

/* One wall's parts, pair by pair. */
static void AddPairs(DoubleImage m, int direction, int side, PetscReal reach, const DoubleColumn *c) {
  const PetscReal *y = m->single->y[direction][side];
  for (PetscInt k = 0; k < c->n; k++) {
    const ImagePair p = {c->d[1 - direction][k] / m->single->markers->grid->h, y[c->i + k], y[c->j]};
    PetscReal blake[2][DIPOLE_COUNT] = {{0}}, grid[2][DIPOLE_COUNT] = {{0}}, less[2], exact[4], L[4];
    if (p.a + p.b >= reach) continue;
    DoubleImageExact(m, direction, side, &p, blake);
    DipoleContract(PARTS(blake), c->N, 1, exact);
    for (int q = 0; q < 4; q++) c->wall[q][k] += exact[q];
    if (!c->lattice) continue;
    OnLattice(m, direction, side, c->i + k, c->j, &p, PARTS(blake), grid, less);
    DipoleContract(PARTS(grid), c->N, 1, L);
    for (int q = 0; q < 4; q++) {
      L[q] -= less[q % 2] * c->free[q][k];
      c->wall[q][k] -= L[q];
      c->flux[q % 2][k] += c->over * c->N[q / 2] * L[q];
    }
  }
}

/* x += a, or -a. */
static inline void AddFour(PetscBool turned, Lanes a, PetscReal x[]) {
  LanesPut(turned ? LanesAt(x) - a : LanesAt(x) + a, x);
}

/* One wall's parts in closed form, of markers that are off the wall, seen from which x is along it; none of images
   beyond the reach. */
static inline void AddFar(DoubleImage m, const int direction, const int side, PetscReal reach, const DoubleColumn *c) {
  const PetscReal cell = 1 / m->single->markers->grid->h, *y = m->single->y[direction][side];
  const PetscReal N[2] = {c->N[1 - direction], side ? -c->N[direction] : c->N[direction]};
  const Lanes b = y[c->j] + (Lanes){0};
  DipoleImageSource source;
  DipoleImageSourceMake(&m->forms, N, cell, c->over, &source);
  for (PetscInt k = 0; k < c->n; k += LANES) {
    const Lanes x = cell * LanesAt(c->d[1 - direction] + k), a = LanesAt(y + c->i + k);
    Lanes M[4], L[2];
    if (c->lattice)
      DipoleImageFour(&source, x, a, b, M, L);
    else
      DipoleImageFourExact(&source, x, a, b, M);
    const LanesBits meant = (LanesBits)(a + b < reach);
    for (int to = 0; to < 2; to++) {
      const int comp = to ? direction : 1 - direction;
      for (int from = 0; from < 2; from++)
        AddFour(side && to != from, LanesWhere(meant, M[2 * from + to]),
                c->wall[2 * (from ? direction : 1 - direction) + comp] + k);
      if (c->lattice) AddFour(side && to, LanesWhere(meant, L[to]), c->flux[comp] + k);
    }
  }
}

static void AddFarLeft(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  AddFar(m, 0, 0, reach, c);
}
static void AddFarRight(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  AddFar(m, 0, 1, reach, c);
}
static void AddFarBottom(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  AddFar(m, 1, 0, reach, c);
}
static void AddFarTop(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  AddFar(m, 1, 1, reach, c);
}
static void (*const AddFarFrom[4])(DoubleImage, PetscReal, const DoubleColumn *) = {AddFarLeft, AddFarRight,
                                                                                    AddFarBottom, AddFarTop};

void DoubleImageAdd(DoubleImage m, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach,
                    PetscReal exact[2][DIPOLE_COUNT], PetscReal lattice[2][DIPOLE_COUNT]) {
  PetscReal free[2][DIPOLE_COUNT] = {{0}};
  AddParts(1, PARTS(lattice), free);
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2, side = wall % 2;
    const PetscReal *y = m->single->y[direction][side];
    PetscReal blake[2][DIPOLE_COUNT] = {{0}}, grid[2][DIPOLE_COUNT] = {{0}}, less[2];
    if (!m->end[direction][side] || y[i] + y[j] >= reach) continue;
    const ImagePair p = {d[1 - direction] / m->single->markers->grid->h, y[i], y[j]};
    DoubleImageExact(m, direction, side, &p, blake);
    OnLattice(m, direction, side, i, j, &p, PARTS(blake), grid, less);
    AddParts(1, PARTS(blake), exact);
    AddParts(1, PARTS(grid), lattice);
    for (int q = 0; q < 2 * DIPOLE_COUNT; q++)
      lattice[q / DIPOLE_COUNT][q % DIPOLE_COUNT] -= less[q / DIPOLE_COUNT] * free[q / DIPOLE_COUNT][q % DIPOLE_COUNT];
  }
}

void DoubleImageAddColumn(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2, side = wall % 2;
    const PetscReal *y = m->single->y[direction][side], low = c->near[wall];
    if (!m->end[direction][side] || low + y[c->j] >= reach) continue;
    if (!c->lattice || (low + y[c->j] >= IMAGE_OFF && PetscMin(low, y[c->j]) >= FOLD_SCALED))
      AddFarFrom[wall](m, reach, c);
    else
      AddPairs(m, direction, side, reach, c);
  }
}

void DoubleImageRange(DoubleImage m, DoubleColumn *c) {
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal *y = m->single->y[wall / 2][wall % 2];
    c->near[wall] = PETSC_MAX_REAL;
    for (PetscInt k = c->i; k < c->i + c->n && m->end[wall / 2][wall % 2]; k++)
      c->near[wall] = PetscMin(c->near[wall], y[k]);
  }
}

void DoubleImageExact(DoubleImage m, int direction, int side, const ImagePair *p, PetscReal exact[2][DIPOLE_COUNT]) {
  PetscReal part[2][DIPOLE_COUNT];
  DipoleImageExact(&m->forms, p, part);
  Turn(direction, side, 1 / m->single->markers->grid->h, PARTS(part), exact);
}

void DoubleImageFar(const void *image, PetscInt n, const PetscReal X[], const PetscReal Y[2], PetscReal V[]) {
  const struct _p_DoubleImage *m = image;
  const Grid g = m->single->markers->grid;
  (void)PetscArrayzero(V, 2 * DIPOLE_COUNT * n);
  for (int wall = 0; wall < 4; wall++) {
    const int direction = wall / 2, side = wall % 2, t = 1 - direction;
    if (!g->wall[direction]) continue;
    for (PetscInt k = 0; k < n; k += LANES) {
      const Lanes b = NearImageOff(g, direction, side, Y) + (Lanes){0};
      Lanes x, a, K[2][DIPOLE_COUNT];
      for (int q = 0; q < LANES; q++) {
        x[q] = (X[2 * (k + q) + t] - Y[t]) / g->h;
        a[q] = NearImageOff(g, direction, side, X + 2 * (k + q));
      }
      DipoleImageFarFour(&m->forms, x, a, b, K);
      for (int q = 0; q < LANES; q++) {
        PetscReal part[2][DIPOLE_COUNT], turned[2][DIPOLE_COUNT] = {{0}};
        for (int c = 0; c < 2 * DIPOLE_COUNT; c++)
          part[c / DIPOLE_COUNT][c % DIPOLE_COUNT] = K[c / DIPOLE_COUNT][c % DIPOLE_COUNT][q];
        Turn(direction, side, 1 / g->h, PARTS(part), turned);
        for (int c = 0; c < 2 * DIPOLE_COUNT; c++) V[c * n + k + q] += turned[c / DIPOLE_COUNT][c % DIPOLE_COUNT];
      }
    }
  }
}
