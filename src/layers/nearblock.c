#include "layers/nearblock.h"
#include "layers/dipolefaces.h"
#include "layers/pairchunk.h"

#define IMAGE_REACH 300 /* cells between a body and another one's image in a wall: beyond, none without a box part */

/* Marker i from the other body's frame. */
static void ChunkPlace(LayerPairs f, const PairChunk *c, PetscReal own[2]) {
  for (int dir = 0; dir < 2; dir++) own[dir] = f->set->markers->X[2 * c->i + dir] - c->shift[dir];
}

static void ChunkDistances(LayerPairs f, PairChunk *c) {
  const PetscReal *X = f->set->markers->X + 2 * c->j, sign = c->back ? -1 : 1;
  PetscReal own[2];
  ChunkPlace(f, c, own);
  for (PetscInt k = 0; k < c->n; k += LANES) { /* whole vectors */
    Lanes x, y;
    LanesPairs(X + 2 * k, &x, &y);
    *(Lanes *)(c->d[0] + k) = sign * (own[0] - x);
    *(Lanes *)(c->d[1] + k) = sign * (own[1] - y);
    *(Lanes *)(c->part + k) = 1 - (Lanes){0};
  }
  if (f->set->box && !c->exact) BoxImageRow(f->set->box, c->n, (PetscReal *[2]){c->d[0], c->d[1]}, c->part);
  for (PetscInt k = c->n; k < CHUNK && k < c->n + LANES; k++) c->d[0][k] = c->d[1][k] = c->part[k] = 1;
  if (c->half && c->i == c->j) c->part[0] = 0.5; /* whole, as K of the marker itself, which has the same logarithm */
}

/* Four of the chunk's pairs to the marker's x and y row. */
static inline void Interlace(const PairChunk *c, PetscInt k, PetscReal x[], PetscReal y[]) {
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
static void ChunkWrite(const PairChunk *c, const NearBlock *b, size_t at, PetscInt stride, NearStore *s) {
  for (PetscInt k = 0; k < c->n; k += LANES, at += 2 * LANES) {
    const PetscInt n = 2 * PetscMin(LANES, c->n - k);
    PetscReal row[2][2 * LANES];
    if (!b->single && n == 2 * LANES) {
      Interlace(c, k, s->value + at, s->value + at + stride);
      continue;
    }
    Interlace(c, k, row[0], row[1]);
    for (int dir = 0; dir < 2; dir++)
      for (PetscInt q = 0; q < n; q++) NearBlockPut(b, at + dir * stride + q, row[dir][q], s);
  }
}

static void FillRow(LayerPairs f, const NearBlock *b, const NearRow *r, const DipoleFaces *faces, PairChunk *c,
                    NearStore *s) {
  const NearBounds *box = &f->bounds[b->column];
  PetscReal own[2], off2 = 0;
  c->i = r->row;
  c->plain = f->image && WallsAreFar(f->set->markers->grid, f->set->markers->X + 2 * r->row, box, c->off);
  ChunkPlace(f, c, own);
  for (int dir = 0; dir < 2; dir++)
    off2 += PetscSqr(PetscMax(0, PetscMax(box->low[dir] - own[dir], own[dir] - box->high[dir])));
  c->alone = !f->set->box && off2 > c->reach * c->reach; /* with a box part images are looked for one by one */
  for (int dir = 0; dir < 2 && f->from.normal; dir++) c->N[dir] = f->from.normal[2 * r->row + dir] - (Lanes){0};
  if (c->plain && c->shared[0]) {
    const PetscReal over = 1 / f->set->markers->grid->h;
    const PetscInt cells[2] = {(PetscInt)rint(over * b->shift[0]), (PetscInt)rint(over * b->shift[1])};
    DipoleFacesAnswer(faces, f->lattice, f->from.stencil + DIPOLE_COUNT * r->row, cells, f->from.normal + 2 * r->row,
                      over, c->shared);
  }
  for (PetscInt k = 0; k < r->count; k += CHUNK) {
    c->j = r->column + k;
    c->n = PetscMin(CHUNK, r->count - k);
    ChunkDistances(f, c);
    f->kernel->fill(f, c);
    ChunkWrite(c, b, r->at + 2 * k, r->stride, s);
  }
  for (PetscInt k = 2 * r->count; k < r->stride; k++) /* behind the last marker */
    for (int dir = 0; dir < 2; dir++) NearBlockPut(b, r->at + dir * r->stride + k, 0, s);
}

/* A body's own quadrature, to its block with itself: K of a marker with itself, which fades as other pairs do, and what
   its rule adds to two markers that are k apart. */
static PetscErrorCode AddSelf(LayerPairs f, const NearBlock *b, PetscBool exact, NearStore *s) {
  const Bodies m = f->set->bodies;
  const PetscInt first = m->layout->start[b->row], n = LayoutCount(m->layout, b->row);
  const PetscReal *logarithm = f->logarithm ? f->logarithm[b->row] : NULL;
  NearRow r = NearBlockBegin(m->layout, b);
  PetscReal *K, part = 0.5;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n, &K));
  PetscCall(f->kernel->diagonal(f->set, &m->kind[b->row], m->spectral[b->row], n, f->set->markers->X + 2 * first,
                                logarithm, K));
  if (!NearBlockIsHalf(b)) part = f->set->box && !exact ? BoxImage(f->set->box, (PetscReal[2]){0, 0}) : 1;
  do {
    const PetscReal *own = K + 3 * (r.row - first);
    PetscReal *x = s->value + r.at + 2 * (r.row - r.column), *y = x + r.stride;
    x[0] += part * own[0];
    x[1] += part * own[2];
    y[0] += part * own[2];
    y[1] += part * own[1];
    for (PetscInt k = 1; k < r.count && logarithm; k++) {
      x[2 * k] += logarithm[k] / f->set->nu;
      y[2 * k + 1] += logarithm[k] / f->set->nu;
    }
  } while (NearBlockNext(m->layout, b, &r));
  PetscCall(PetscFree(K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Faces that the markers of a dipoles' block share, where no pair is farther apart than the lattice's tables reach, nor
   has another image for the nearest one, and where they take less: a marker's double sums cost as much as some vectors
   of faces. */
static PetscErrorCode ShareFaces(LayerPairs f, const NearBlock *b, PairChunk *c, DipoleFaces *faces) {
  enum { FACES_PER_MARKER = 12 };
  const Grid g = f->set->markers->grid;
  const NearBounds *row = &f->bounds[b->row], *column = &f->bounds[b->column];
  const PetscInt n = LayoutCount(f->set->markers->layout, b->column);
  PetscFunctionBeginUser;
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal most = PetscMax(row->high[dir] - column->low[dir] - b->shift[dir],
                                    column->high[dir] + b->shift[dir] - row->low[dir]);
    if (most > DIPOLE_FACE_CELLS * g->h) PetscFunctionReturn(PETSC_SUCCESS);
    if (f->set->box && !g->wall[dir] && most > 0.49 * (g->hi[dir] - g->lo[dir])) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(DipoleFacesCreate(n, f->stencil + 2 * f->set->markers->layout->start[b->column], faces));
  if (faces->rows[0] * faces->columns[0] > FACES_PER_MARKER * n) PetscFunctionReturn(PETSC_SUCCESS);
  for (int q = 0; q < 4; q++) PetscCall(PetscCalloc1(n + LANES, &c->shared[q]));
  c->reach = PETSC_MAX_REAL; /* where walls are near */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Parts xx, yy, xy and, of an image, yx. */
static void NearBlockKernel(const void *context, int wall, const Lanes x[2], const PetscReal y[2], const PetscReal N[2],
                            Lanes K[]) {
  const LayerPairs f = (LayerPairs)context;
  const Lanes normal[2] = {N[0] - (Lanes){0}, N[1] - (Lanes){0}};
  Lanes seen[3], part[PAIR_PARTS];
  if (wall < 0) {
    PairFree(f->kernel, f->set, x[0] - y[0], x[1] - y[1], normal, K);
    return;
  }
  WallImageSeen(f->set->markers->grid, wall, x, y, seen);
  seen[2] = -seen[2]; /* y is mirrored */
  WallImageFour(f->kernel, f->image, wall, PETSC_TRUE, seen, part);
  f->kernel->contract(part, normal, K);
}

/* Of half a block one of the two of each pair. */
PetscErrorCode NearBlockRefine(LayerPairs f, const NearBlock *b, const FinePair *pair, NearStore *s) {
  static const int place[2][4] = {{0, 3, 2, 1}, {0, 2, 3, 1}}; /* of the row's x with the column's x and y, of its y */
  const Layout l = f->set->markers->layout;
  const PetscInt rows = LayoutCount(l, b->row), columns = LayoutCount(l, b->column), n = rows * columns;
  const PetscReal *normal = f->from.normal ? f->from.normal + 2 * l->start[pair->column] : NULL;
  const FineKernel kernel = {pair->wall < 0 ? 3 : 4, NearBlockKernel, f, normal};
  NearRow r = NearBlockBegin(l, b);
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(kernel.parts * n, &part));
  PetscCall(FinePairParts(f->set, pair, &kernel, part));
  do
    for (PetscInt k = 0; k < r.count; k++) {
      const PetscInt i = r.row - l->start[b->row], j = r.column + k - l->start[b->column];
      const PetscInt from = b->symmetric ? j * rows + i : i * columns + j;
      for (int q = 0; q < 4; q++) {
        const PetscReal *of = part + PetscMin(place[b->symmetric][q], kernel.parts - 1) * n;
        const PetscReal more = (NearBlockIsHalf(b) && !k ? 0.5 : 1) * of[from];
        const size_t at = r.at + q / 2 * r.stride + 2 * k + q % 2;
        NearBlockPut(b, at, (b->single ? s->single[at] : s->value[at]) + more, s);
      }
    }
  while (NearBlockNext(l, b, &r));
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* + (L n) (n w)^T/length: L acts on what Q leaves. */
static void AddFlux(LayerPairs f, const NearBlock *b, PetscReal *const flux[2], NearStore *s) {
  const Layout l = f->set->markers->layout;
  NearRow r = NearBlockBegin(l, b);
  do
    for (PetscInt k = 0; k < 2 * r.count; k++)
      for (int c = 0; c < 2; c++)
        s->value[r.at + c * r.stride + k] += f->from.normal[2 * r.row + c] / f->from.length[b->row] *
                                             flux[k % 2][k / 2];
  while (NearBlockNext(l, b, &r));
}

size_t NearBlockValues(Layout l, const NearBlock *b) {
  NearRow r = NearBlockBegin(l, b);
  while (NearBlockNext(l, b, &r)) continue;
  return r.at - b->at;
}

PetscErrorCode NearBlockFill(LayerPairs f, const NearBlock *b, PetscBool exact, NearStore *s) {
  const Grid g = f->set->markers->grid;
  const Layout l = f->set->markers->layout;
  const PetscInt shown[2] = {b->symmetric ? b->row : b->column, b->symmetric ? b->column : b->row};
  const PetscReal sign = b->symmetric ? 1 : -1, shift[2] = {sign * b->shift[0], sign * b->shift[1]};
  PairChunk c = {.column = b->column,
                 .shift = {b->shift[0], b->shift[1]},
                 .half = NearBlockIsHalf(b),
                 .exact = exact || f->set->markers->grid->free};
  NearRow r = NearBlockBegin(l, b);
  DipoleFaces faces = {0};
  FinePair atwall[4];
  PetscInt walls;
  PetscFunctionBeginUser;
  c.back = !b->symmetric || b->row > b->column;
  c.reach = f->kernel->reach[NearBlockIsSelf(b) ? NEAR_ONE : NEAR_TWO] * f->set->markers->grid->h;
  if (f->from.stencil && !c.exact) PetscCall(ShareFaces(f, b, &c, &faces));
  for (int wall = 0; wall < 4; wall++) { /* with a box part all walls' images count, as it was found with all */
    const PetscReal gap = WallGap(g, wall, &f->bounds[b->row], &f->bounds[b->column]);
    c.walls[wall] = f->image && g->wall[wall / 2] && (f->set->box || gap < IMAGE_REACH * g->h);
  }
  for (int dir = 0; dir < 2 && !b->symmetric && !c.exact; dir++) PetscCall(PetscCalloc1(r.count + LANES, &c.flux[dir]));
  do FillRow(f, b, &r, &faces, &c, s);
  while (NearBlockNext(l, b, &r));
  if (c.flux[0]) AddFlux(f, b, c.flux, s);
  if (NearBlockIsSelf(b)) PetscCall(AddSelf(f, b, c.exact, s));
  FinePairsAtWalls(f->set, f->bounds, shown[0], shown[1], shift, atwall, &walls);
  for (PetscInt k = 0; k < walls; k++) PetscCall(NearBlockRefine(f, b, &atwall[k], s));
  for (int dir = 0; dir < 2; dir++) PetscCall(PetscFree(c.flux[dir]));
  for (int q = 0; q < 4; q++) PetscCall(PetscFree(c.shared[q]));
  PetscCall(DipoleFacesDestroy(&faces));
  PetscFunctionReturn(PETSC_SUCCESS);
}
