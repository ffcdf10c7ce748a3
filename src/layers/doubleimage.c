#include "layers/doubleimage.h"

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
static DipoleEnd DoubleImageEnd(PetscReal y) {
  static const KernelWeights weights[DIPOLE_COUNT] = {KernelSpline4, KernelSpline6, KernelSpline5};
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
      if (y < IMAGE_CELLS) m->end[wall / 2][wall % 2][k] = DoubleImageEnd(y);
    }
}

/* By component and part. */
static const ImagePlaces dipole_places = {
    2 * DIPOLE_COUNT, {{4, 3, 5, 1, 0, 2}, {0, 1, 2, 3, 4, 5}}, {[2] = PETSC_TRUE, [3] = PETSC_TRUE, [4] = PETSC_TRUE}};

/* The half-space lattice's answer at i to the parts of j near a wall, x cells apart along it and seen from it. */
static void DoubleImageHalf(DoubleImage m, int wall, PetscInt i, PetscInt j, PetscReal x,
                            PetscReal K[2][DIPOLE_COUNT]) {
  const int direction = wall / 2, t = 1 - direction;
  const ImageEnd *e = &m->single->end[direction][wall % 2][i];
  const DipoleEnd *f = &m->end[direction][wall % 2][j];
  for (int c = 0; c < 2; c++)
    for (int part = 0; part < DIPOLE_COUNT; part++) {
      const ImageRows row = {e->first[c], e->n[c], e->weight[c], &m->single->stencil[2 * i + (c ? direction : t)]};
      const ImageRows source = {f->first[part], f->n[part], f->weight[part],
                                &m->dipole[DIPOLE_COUNT * j + dipole_places.place[direction][part] % DIPOLE_COUNT]};
      K[c][part] = ImageSum(m->table->value[part][c], m->single->markers->grid, t, x, &row, &source);
    }
}

/* What a wall adds for a pair: to exact fluid, to the lattice, and how much of each component of the lattice's answer
   without walls is to be taken off. */
typedef struct {
  PetscReal exact[2][DIPOLE_COUNT], lattice[2][DIPOLE_COUNT], less[2];
} AtWall;

/* Responses that are scaled near the wall take s of the half space's free + exact - far only. */
static AtWall AtWallOf(DoubleImage m, int wall, PetscInt i, PetscInt j, const PetscReal d[2], PetscBool lattice) {
  const PetscReal over = 1 / m->single->markers->grid->h, *y = m->single->y[wall / 2][wall % 2];
  const ImagePair p = {d[1 - wall / 2] * over, y[i], y[j]};
  AtWall a = {.less = {1, 1}};
  PetscReal part[2][DIPOLE_COUNT];
  DipoleImageExact(&m->forms, &p, part);
  ImageTurn(&dipole_places, wall, over, (const PetscReal *)part, (PetscReal *)a.exact);
  if (!lattice) return a;
  if (NearImageIsNear(&p)) {
    DoubleImageHalf(m, wall, i, j, p.x, part);
    ImageTurn(&dipole_places, wall, over, (const PetscReal *)part, (PetscReal *)a.lattice);
    return a;
  }
  DipoleImageFar(&m->forms, &p, part);
  ImageTurn(&dipole_places, wall, -over, (const PetscReal *)part, (PetscReal *)a.lattice);
  for (int c = 0; c < 2; c++) {
    const PetscReal scale = c == wall / 2 ? m->single->end[wall / 2][wall % 2][i].scale : 1;
    a.less[c] = 1 - scale;
    for (int k = 0; k < DIPOLE_COUNT; k++) a.lattice[c][k] = scale * (a.lattice[c][k] + a.exact[c][k]);
  }
  return a;
}

void DoubleImageAdd(DoubleImage m, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach,
                    PetscReal exact[2][DIPOLE_COUNT], PetscReal lattice[2][DIPOLE_COUNT]) {
  PetscReal free[2][DIPOLE_COUNT];
  (void)PetscMemcpy(free, lattice, sizeof(free));
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal *y = m->single->y[wall / 2][wall % 2];
    if (!m->end[wall / 2][wall % 2] || y[i] + y[j] >= reach) continue;
    const AtWall a = AtWallOf(m, wall, i, j, d, PETSC_TRUE);
    for (int c = 0; c < 2; c++)
      for (int k = 0; k < DIPOLE_COUNT; k++) {
        exact[c][k] += a.exact[c][k];
        lattice[c][k] += a.lattice[c][k] - a.less[c] * free[c][k];
      }
  }
}

/* One wall's parts, pair by pair. */
static void DoubleImageAddPairs(DoubleImage m, int wall, PetscReal reach, const DoubleColumn *c) {
  const PetscReal *y = m->single->y[wall / 2][wall % 2];
  for (PetscInt k = 0; k < c->n; k++) {
    PetscReal exact[4], L[4];
    if (y[c->i + k] + y[c->j] >= reach) continue;
    const AtWall a = AtWallOf(m, wall, c->i + k, c->j, (PetscReal[]){c->d[0][k], c->d[1][k]}, c->lattice);
    DipoleContract(a.exact, c->N, 1, exact);
    for (int q = 0; q < 4; q++) c->wall[q][k] += exact[q];
    if (!c->lattice) continue;
    DipoleContract(a.lattice, c->N, 1, L);
    for (int q = 0; q < 4; q++) {
      L[q] -= a.less[q % 2] * c->free[q][k];
      c->wall[q][k] -= L[q];
      c->flux[q % 2][k] += c->over * c->N[q / 2] * L[q];
    }
  }
}

/* One marker's dipoles seen from a wall: scale: 1 over the length that N has. */
static void DoubleImageSourceMake(DoubleImage m, int wall, const PetscReal N[2], PetscReal over, DipoleImageSource *s) {
  const PetscReal seen[2] = {N[1 - wall / 2], wall % 2 ? -N[wall / 2] : N[wall / 2]};
  DipoleImageSourceMake(&m->forms, seen, 1 / m->single->markers->grid->h, over, s);
}

/* M[4] (DipoleContract) turned from a wall to x and y. */
static inline void TurnFour(int wall, Lanes M[4]) {
  if (wall % 2)
    for (int q = 1; q < 3; q++) M[q] = -M[q];
  if (wall / 2) return;
  for (int q = 0; q < 2; q++) {
    const Lanes kept = M[q];
    M[q] = M[3 - q];
    M[3 - q] = kept;
  }
}

void DoubleImageFourExact(DoubleImage m, int wall, const PetscReal N[2], const Lanes seen[3], Lanes M[4]) {
  DipoleImageSource source;
  DoubleImageSourceMake(m, wall, N, 1, &source);
  DipoleImageFourExact(&source, seen[0], seen[1], seen[2], M);
  TurnFour(wall, M);
}

/* One wall's parts in closed form, of markers that are off the wall, seen from which x is along it; none of images
   beyond the reach. */
static void DoubleImageAddFar(DoubleImage m, int wall, PetscReal reach, const DoubleColumn *c) {
  const int direction = wall / 2;
  const PetscReal cell = 1 / m->single->markers->grid->h, *y = m->single->y[direction][wall % 2];
  const Lanes b = y[c->j] + (Lanes){0};
  DipoleImageSource source;
  DoubleImageSourceMake(m, wall, c->N, c->over, &source);
  for (PetscInt k = 0; k < c->n; k += LANES) {
    const Lanes x = cell * LanesAt(c->d[1 - direction] + k), a = LanesAt(y + c->i + k);
    const LanesBits meant = (LanesBits)(a + b < reach);
    Lanes M[4], L[2];
    if (c->lattice)
      DipoleImageFour(&source, x, a, b, M, L);
    else
      DipoleImageFourExact(&source, x, a, b, M);
    TurnFour(wall, M);
    for (int q = 0; q < 4; q++) LanesPut(LanesAt(c->wall[q] + k) + LanesWhere(meant, M[q]), c->wall[q] + k);
    for (int to = 0; to < 2 && c->lattice; to++) {
      PetscReal *flux = c->flux[to ? direction : 1 - direction] + k;
      LanesPut(LanesAt(flux) + LanesWhere(meant, wall % 2 && to ? -L[to] : L[to]), flux);
    }
  }
}

void DoubleImageAddColumn(DoubleImage m, PetscReal reach, const DoubleColumn *c) {
  for (int wall = 0; wall < 4; wall++) {
    const PetscReal *y = m->single->y[wall / 2][wall % 2], low = c->near[wall];
    if (!m->end[wall / 2][wall % 2] || low + y[c->j] >= reach) continue;
    if (!c->lattice || (low + y[c->j] >= IMAGE_OFF && PetscMin(low, y[c->j]) >= FOLD_SCALED))
      DoubleImageAddFar(m, wall, reach, c);
    else
      DoubleImageAddPairs(m, wall, reach, c);
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
