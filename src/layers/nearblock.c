#include "layers/nearblock.h"

#define IMAGE_REACH 300 /* cells between a body and another one's image in a wall: beyond, none without a box part */

/* L of markers i and j, d = X_i - X_j: xx, yy, xy and yx. */
static void LatticePair(SinglePairs f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  const PetscReal *X = f->set->markers->X, cell = 1 / f->set->markers->grid->h, over = 1 / f->set->nu;
  PetscInt periods[2];
  for (int dir = 0; dir < 2; dir++) /* in cells */
    periods[dir] = (PetscInt)rint((d[dir] - (X[2 * i + dir] - X[2 * j + dir])) * cell);
  StencilFourSums(f->lattice, &f->stencil[2 * i], &f->stencil[2 * j], periods, L);
  L[0] -= f->image->logarithm;
  L[1] -= f->image->logarithm;
  for (int c = 0; c < 4; c++) L[c] *= over;
}

static const int respond[4] = {0, 1, 0, 1}, source[4] = {0, 1, 1, 0}; /* components that meet in xx, yy, xy, yx */

/* L of two markers whose S is known: by stencils up to the reach of the closed form of C = S - L. */
static void Pair(SinglePairs f, const NearFar *far, PetscInt i, PetscInt j, const PetscReal d[2], const PetscReal S[3],
                 PetscReal L[4]) {
  const PetscReal cell = 1 / f->set->markers->grid->h, r2 = d[0] * d[0] + d[1] * d[1];
  Lanes fourth[4][2], four[4];
  if (r2 * cell * cell <= PetscSqr(far->reach)) {
    LatticePair(f, i, j, d, L);
    return;
  }
  for (int c = 0; c < 4; c++)
    for (int dir = 0; dir < 2; dir++)
      fourth[c][dir] = f->stencil[2 * i + respond[c]].fourth[dir] + f->stencil[2 * j + source[c]].fourth[dir] -
                       far->fourth[respond[c] != dir] - far->fourth[source[c] != dir] - (Lanes){0};
  NearFarPairs(far, 1 / f->set->nu, cell * d[0] - (Lanes){0}, cell * d[1] - (Lanes){0}, fourth, four);
  for (int c = 0; c < 4; c++) L[c] = S[PetscMin(c, 2)] - four[c][0];
}

void NearLatticePair(SinglePairs f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  PetscReal S[3];
  if (d[0] == 0 && d[1] == 0) {
    LatticePair(f, i, j, d, L);
    return;
  }
  StokesletOne(f->set, d, 0, S);
  Pair(f, &f->far[NEAR_ONE], i, j, d, S, L);
}

/* The diagonal of S in a curve's quadrature, from the derivative T = dX/dk: xx, yy, xy. */
static void SelfPart(SinglePairs f, PetscInt v, const PetscReal T[2], PetscReal S[3]) {
  const PetscReal n = LayoutCount(f->set->bodies->layout, v);
  const PetscReal turn = f->set->bodies->kind[v].type == CURVE_OPEN ? 1 : n; /* SinglePairsCreate */
  const PetscReal slope = turn / (2 * PETSC_PI);
  StokesletOne(f->set, (PetscReal[]){slope * T[0], slope * T[1]}, f->logarithm[v][0], S);
}

/* Some pairs of a row: marker i with markers j .. j + n - 1; from the column's side where its vesicle is the first. All
   arrays have room for whole vectors. */
#define CHUNK 96
typedef struct {
  const NearBlock *block;
  PetscInt i, j, n;
  PetscBool self, back, plain;      /* plain: far from all walls */
  PetscBool walls[2][2], off[2][2]; /* whose images count; from which it is far */
  const NearFar *far;
  PetscReal reach; /* of stencils' sums (length) */
  PetscReal d[2][CHUNK], part[CHUNK], L[4][CHUNK], C[4][CHUNK];
} Chunk;

/* Marker i from the other vesicle's frame. */
static void NearBlockPlace(SinglePairs f, const Chunk *c, PetscReal own[2]) {
  for (int dir = 0; dir < 2; dir++) own[dir] = f->set->markers->X[2 * c->i + dir] - c->block->shift[dir];
}

static void Distances(SinglePairs f, Chunk *c) {
  const PetscReal *X = f->set->markers->X + 2 * c->j, sign = c->back ? -1 : 1;
  PetscReal own[2];
  PetscInt k = 0;
  NearBlockPlace(f, c, own);
  for (; k + LANES <= c->n; k += LANES) {
    Lanes x, y;
    LanesPairs(X + 2 * k, &x, &y);
    *(Lanes *)(c->d[0] + k) = sign * (own[0] - x);
    *(Lanes *)(c->d[1] + k) = sign * (own[1] - y);
    *(Lanes *)(c->part + k) = 1 - (Lanes){0};
  }
  for (; k < c->n; k++) {
    for (int dir = 0; dir < 2; dir++) c->d[dir][k] = sign * (own[dir] - X[2 * k + dir]);
    c->part[k] = 1;
  }
  if (f->set->box) BoxImageRow(f->set->box, c->n, (PetscReal *[2]){c->d[0], c->d[1]}, c->part);
  for (k = c->n; k < CHUNK && k < c->n + LANES; k++) c->d[0][k] = c->d[1][k] = c->part[k] = 1;
}

/* By how much the fourth moments of four pairs' stencils, from the k-th of a chunk on, are above the mean. */
static inline void Fourth(SinglePairs f, const Chunk *c, PetscInt k, Lanes fourth[4][2]) {
  for (int q = 0; q < 4; q++)
    for (int dir = 0; dir < 2; dir++) {
      const int row = c->back ? source[q] : respond[q], column = c->back ? respond[q] : source[q];
      fourth[q][dir] = f->fourth[row][dir][c->i] + LanesAt(f->fourth[column][dir] + c->j + k);
    }
}

/* All pairs as if they were distant. */
static void FillFar(SinglePairs f, Chunk *c) {
  const PetscReal cell = 1 / f->set->markers->grid->h, over = 1 / f->set->nu;
  Lanes C[4], fourth[4][2];
  for (PetscInt k = 0; k < c->n; k += LANES) {
    const Lanes x = cell * LanesAt(c->d[0] + k), y = cell * LanesAt(c->d[1] + k);
    Fourth(f, c, k, fourth);
    NearFarPairs(c->far, over, x, y, fourth, C);
    for (int q = 0; q < 4; q++) LanesPut(C[q], c->C[q] + k);
  }
}

/* No marker of the other vesicle is within the stencils' reach; with a box part images are looked for one by one. */
static PetscBool IsAlone(SinglePairs f, const Chunk *c) {
  const NearBounds *bounds = &f->bounds[c->block->column];
  PetscReal own[2], r2 = 0;
  NearBlockPlace(f, c, own);
  for (int dir = 0; dir < 2; dir++)
    r2 += PetscSqr(PetscMax(0, PetscMax(bounds->low[dir] - own[dir], own[dir] - bounds->high[dir])));
  return !f->set->box && r2 > c->reach * c->reach ? PETSC_TRUE : PETSC_FALSE;
}

/* Pairs one by one; those within the stencils' reach are enough far from walls. */
static void FillNear(SinglePairs f, Chunk *c) {
  const PetscReal farthest2 = c->plain ? c->reach * c->reach : PETSC_MAX_REAL;
  const PetscBool free = f->set->markers->grid->free;
  Lanes S[3] = {{0}};
  for (PetscInt k = 0; k < c->n; k++) {
    if (k % LANES == 0) {
      const Lanes x = LanesAt(c->d[0] + k), y = LanesAt(c->d[1] + k);
      if (!LanesAny((LanesBits)(x * x + y * y <= farthest2))) {
        k += LANES - 1;
        continue;
      }
      StokesletFour(f->set, x, y, S);
    }
    const PetscInt j = c->j + k, from = c->back ? c->i : j, to = c->back ? j : c->i;
    const PetscReal d[2] = {c->d[0][k], c->d[1][k]};
    PetscReal L[4] = {0, 0, 0, 0}, own[3];
    if (d[0] * d[0] + d[1] * d[1] > farthest2) continue;
    const PetscBool same = j == c->i && c->self ? PETSC_TRUE : PETSC_FALSE;
    for (int q = 0; q < 3; q++) own[q] = same ? 0 : S[q][k % LANES];
    if (same) c->part[k] = 0.5; /* whole, as S of the marker itself, which has the same logarithm */
    if (!free && (same || c->plain)) LatticePair(f, to, from, d, L);
    if (!free && !same && !c->plain) Pair(f, c->far, to, from, d, own, L);
    for (int q = 0; q < 4; q++) {
      c->L[q][k] = L[q];
      c->C[q][k] = own[PetscMin(q, 2)] - L[q];
    }
  }
}

/* The images of pairs in walls that are near. */
static void NearBlockAddImages(SinglePairs f, Chunk *c) {
  for (PetscInt k = 0; k < c->n; k++) {
    const PetscInt from = c->back ? c->i : c->j + k, to = c->back ? c->j + k : c->i;
    const PetscReal d[2] = {c->d[0][k], c->d[1][k]}, L[4] = {c->L[0][k], c->L[1][k], c->L[2][k], c->L[3][k]};
    PetscReal C[4] = {0, 0, 0, 0};
    NearImageAdd(f->image, c->off, to, from, d, L, C);
    for (int q = 0; q < 4; q++) c->C[q][k] += C[q];
  }
}

static void FillChunk(SinglePairs f, Chunk *c) {
  Distances(f, c);
  if (c->plain) {
    FillFar(f, c);
    if (!IsAlone(f, c)) FillNear(f, c);
  } else {
    FillNear(f, c);
    if (f->image) NearBlockAddImages(f, c);
  }
  if (!f->image) return;
  PetscBool walls[2][2];
  for (int wall = 0; wall < 4; wall++)
    walls[wall / 2][wall % 2] = c->walls[wall / 2][wall % 2] && c->off[wall / 2][wall % 2] ? PETSC_TRUE : PETSC_FALSE;
  NearImageAddFar(f->image, walls,
                  &(NearImageRow){c->i, c->j, c->n, c->back, {c->d[0], c->d[1]}, {c->C[0], c->C[1], c->C[2], c->C[3]}});
}

/* Four of the chunk's pairs to the marker's x and y row. */
static inline void Interlace(const Chunk *c, PetscInt k, PetscReal x[], PetscReal y[]) {
  const int xy = c->back ? 3 : 2, yx = 5 - xy;
  const Lanes part = LanesAt(c->part + k);
  LanesInterlace(part * LanesAt(c->C[0] + k), part * LanesAt(c->C[xy] + k), x);
  LanesInterlace(part * LanesAt(c->C[yx] + k), part * LanesAt(c->C[1] + k), y);
}

static inline void NearBlockPut(const NearBlock *b, size_t at, PetscReal x, NearStore *s) {
  if (b->single)
    s->single[at] = (float)x;
  else
    s->value[at] = x;
}

/* The chunk's pairs to the block, from `at` on. */
static void Write(const Chunk *c, size_t at, PetscInt stride, NearStore *s) {
  for (PetscInt k = 0; k < c->n; k += LANES, at += 2 * LANES) {
    const PetscInt n = 2 * PetscMin(LANES, c->n - k);
    PetscReal row[2][2 * LANES];
    if (!c->block->single && n == 2 * LANES) {
      Interlace(c, k, s->value + at, s->value + at + stride);
      continue;
    }
    Interlace(c, k, row[0], row[1]);
    for (int dir = 0; dir < 2; dir++)
      for (PetscInt q = 0; q < n; q++) NearBlockPut(c->block, at + dir * stride + q, row[dir][q], s);
  }
}

static void FillRow(SinglePairs f, const NearRow *r, Chunk *c, NearStore *s) {
  const NearBounds *column = &f->bounds[c->block->column];
  c->i = r->row;
  c->plain = f->image && NearImageIsFar(f->image, f->set->markers->X + 2 * r->row, column, c->off) ? PETSC_TRUE
                                                                                                   : PETSC_FALSE;
  for (PetscInt k = 0; k < r->count; k += CHUNK) {
    c->j = r->column + k;
    c->n = PetscMin(CHUNK, r->count - k);
    FillChunk(f, c);
    Write(c, r->at + 2 * k, r->stride, s);
  }
  for (PetscInt k = 2 * r->count; k < r->stride; k++) /* behind the last marker */
    for (int dir = 0; dir < 2; dir++) NearBlockPut(c->block, r->at + dir * r->stride + k, 0, s);
}

/* A body's own quadrature, to its block with itself: what it has besides the plain logarithm for two markers that are k
   apart, and the diagonal. */
static PetscErrorCode AddSelf(SinglePairs f, const NearBlock *b, NearStore *s) {
  const Bodies m = f->set->bodies;
  const PetscInt first = m->layout->start[b->row];
  const PetscReal factor = -0.5 / (4 * PETSC_PI * f->set->nu), *logarithm = f->logarithm[b->row];
  NearRow r = NearBlockBegin(m->layout, b);
  PetscReal *T, S[3];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * r.count, &T));
  PetscCall(CurveTangents(&m->kind[b->row], m->spectral[b->row], r.count, f->set->markers->X + 2 * first, T));
  do {
    PetscReal *x = s->value + r.at, *y = x + r.stride;
    SelfPart(f, b->row, T + 2 * (r.row - first), S);
    x[0] += 0.5 * S[0];
    x[1] += 0.5 * S[2];
    y[0] += 0.5 * S[2];
    y[1] += 0.5 * S[1];
    for (PetscInt k = 1; k < r.count; k++) {
      x[2 * k] += factor * logarithm[k];
      y[2 * k + 1] += factor * logarithm[k];
    }
  } while (NearBlockNext(m->layout, b, &r));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The images of one body in a wall count for the other: with a box part all walls', as it was found with all. */
static PetscBool CountsWall(SinglePairs f, const NearBlock *b, int direction, int side) {
  const Grid g = f->set->markers->grid;
  const PetscReal gap = NearImageGap(g, direction, side, &f->bounds[b->row], &f->bounds[b->column]);
  return g->wall[direction] && (f->set->box || gap < IMAGE_REACH * g->h) ? PETSC_TRUE : PETSC_FALSE;
}

/* Parts xx, yy, xy and, of an image, yx. */
static void NearBlockKernel(const void *context, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                            Lanes K[]) {
  const LayerSetting *set = (const LayerSetting *)context;
  Lanes seen[3], part[IMAGE_PARTS];
  if (wall < 0) {
    StokesletFour(set, x[0] - y[0], x[1] - y[1], K);
    return;
  }
  NearImageSeen(set->markers->grid, wall, x, y, seen);
  NearImageBlake(seen[0], seen[1], -seen[2], part); /* y is mirrored */
  for (int q = 0; q < IMAGE_PARTS; q++)
    K[force_places.place[wall / 2][q]] = (wall % 2 && force_places.odd[q] ? -1 : 1) / set->nu * part[q];
}

/* Of a body with itself a block has one of the two of each pair. */
PetscErrorCode NearBlockRefine(SinglePairs f, const NearBlock *b, const FinePair *pair, NearStore *s) {
  static const int place[4] = {0, 2, 3, 1}; /* xx, xy of the x row, yx, yy of the y row */
  const Layout l = f->set->markers->layout;
  const PetscInt rows = LayoutCount(l, b->row), n = rows * LayoutCount(l, b->column);
  const FineKernel kernel = {pair->wall < 0 ? 3 : IMAGE_PARTS, NearBlockKernel, f->set, NULL};
  NearRow r = NearBlockBegin(l, b);
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(kernel.parts * n, &part));
  PetscCall(FinePairParts(f->set, pair, &kernel, part));
  do
    for (PetscInt k = 0; k < r.count; k++) {
      const PetscInt from = (r.column + k - l->start[b->column]) * rows + r.row - l->start[b->row];
      for (int q = 0; q < 4; q++) {
        const PetscReal *of = part + PetscMin(place[q], kernel.parts - 1) * n;
        const PetscReal more = (NearBlockIsSelf(b) && !k ? 0.5 : 1) * of[from];
        const size_t at = r.at + q / 2 * r.stride + 2 * k + q % 2;
        NearBlockPut(b, at, (b->single ? s->single[at] : s->value[at]) + more, s);
      }
    }
  while (NearBlockNext(l, b, &r));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearBlockFill(SinglePairs f, const NearBlock *b, NearStore *s) {
  const Layout l = f->set->markers->layout;
  Chunk c = {.block = b, .self = NearBlockIsSelf(b), .back = b->row > b->column ? PETSC_TRUE : PETSC_FALSE};
  NearRow r = NearBlockBegin(l, b);
  FinePair atwall[4];
  PetscInt walls;
  PetscFunctionBeginUser;
  for (int wall = 0; wall < 4; wall++) c.walls[wall / 2][wall % 2] = CountsWall(f, b, wall / 2, wall % 2);
  c.far = &f->far[c.self ? NEAR_ONE : NEAR_TWO];
  c.reach = c.far->reach * f->set->markers->grid->h;
  do FillRow(f, &r, &c, s);
  while (NearBlockNext(l, b, &r));
  if (c.self) PetscCall(AddSelf(f, b, s));
  FinePairsAtWalls(f->set, f->bounds, b->row, b->column, b->shift, atwall, &walls);
  for (PetscInt k = 0; k < walls; k++) PetscCall(NearBlockRefine(f, b, &atwall[k], s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
