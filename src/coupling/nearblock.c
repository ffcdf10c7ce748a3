#include "coupling/nearblock.h"
#include "base/lanes.h"

/* Smoothing by the kernel and dispersion by the lattice, to the order h^2/r^2: transforms of e^{i n phi} waves, the
   first three from the moments (docs/method.md, Near field). */
void NearFarCoefficients(const Kernel *kernel, PetscReal far[5]) {
  const PetscReal along = KernelSecondMoment(kernel->along), across = KernelSecondMoment(kernel->across);
  far[0] = -(across + 1. / 12) / 2 + 3.5 / 48;            /* a2 */
  far[1] = -along / 8 + (across + 1. / 12) / 8 - 1. / 48; /* a4 */
  far[2] = 1. / 96;                                       /* a6 */
  far[3] = -(along + across) / 4 + 1. / 32;               /* b2 */
  far[4] = 1. / 96;                                       /* b6 */
}

/* C of four pairs of distant markers, (x, y) apart: xx, yy, xy. */
static inline void FarPairs(const PetscReal far[5], PetscReal scale, Lanes x, Lanes y, Lanes C[3]) {
  const Lanes factor = 1 / (x * x + y * y), c2 = (x * x - y * y) * factor, s2 = 2 * x * y * factor,
              c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2, c6 = c4 * c2 - s4 * s2, s6 = s4 * c2 + c4 * s2;
  const Lanes even = 4 * far[1] * c4, odd = 2 * far[0] * c2 + 6 * far[2] * c6;
  C[0] = scale * factor * (even - odd);
  C[1] = scale * factor * (even + odd);
  C[2] = scale * factor * (-2 * far[3] * s2 - 6 * far[4] * s6);
}

static void FarPair(const PetscReal far[5], PetscReal scale, const PetscReal d[2], PetscReal C[3]) {
  Lanes four[3];
  FarPairs(far, scale, d[0] - (Lanes){0}, d[1] - (Lanes){0}, four);
  for (int c = 0; c < 3; c++) C[c] = four[c][0];
}

/* The free-space Stokeslet: xx, yy, xy. */
static void Stokeslet(PetscReal nu, const PetscReal d[2], PetscReal S[3]) {
  const PetscReal r2 = d[0] * d[0] + d[1] * d[1], logarithm = -0.5 * PetscLogReal(r2), factor = 1 / (4 * PETSC_PI * nu);
  S[0] = factor * (logarithm + d[0] * d[0] / r2);
  S[1] = factor * (logarithm + d[1] * d[1] / r2);
  S[2] = factor * d[0] * d[1] / r2;
}

/* L of markers i and j, d = X_i - X_j: xx, yy, xy and yx. */
static void LatticePair(NearField f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  const PetscReal *X = f->markers->X, cell = 1 / f->markers->grid->h, over = 1 / f->nu;
  const PetscReal constant = PetscLogReal(f->markers->grid->h) / (4 * PETSC_PI);
  PetscInt periods[2];
  for (int dir = 0; dir < 2; dir++) /* in cells */
    periods[dir] = (PetscInt)rint((d[dir] - (X[2 * i + dir] - X[2 * j + dir])) * cell);
  StencilFourSums(&f->lattice, &f->stencil[2 * i], &f->stencil[2 * j], periods, L);
  L[0] -= constant;
  L[1] -= constant;
  for (int c = 0; c < 4; c++) L[c] *= over;
}

/* L and C = S - L of two markers; by stencils up to `reach` (length). */
static void Pair(NearField f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal reach, PetscReal L[4],
                 PetscReal C[4]) {
  const PetscReal h = f->markers->grid->h, r2 = d[0] * d[0] + d[1] * d[1];
  PetscReal S[3], far[3];
  Stokeslet(f->nu, d, S);
  if (f->free || r2 <= reach * reach) {
    if (!f->free) LatticePair(f, i, j, d, L);
    for (int c = 0; c < 4; c++) C[c] = S[PetscMin(c, 2)] - L[c];
    return;
  }
  FarPair(f->far, h * h / (2 * PETSC_PI * f->nu), d, far);
  for (int c = 0; c < 4; c++) {
    C[c] = far[PetscMin(c, 2)];
    L[c] = S[PetscMin(c, 2)] - C[c];
  }
}

void NearLatticePair(NearField f, PetscInt i, PetscInt j, const PetscReal d[2], PetscReal L[4]) {
  PetscReal C[4];
  if (d[0] == 0 && d[1] == 0)
    LatticePair(f, i, j, d, L);
  else
    Pair(f, i, j, d, NEAR_CELLS * f->markers->grid->h, L, C);
}

/* What Kress' quadrature has besides the plain logarithm, for two markers of one curve of n that are k apart; on the
   diagonal the whole of S, from the derivative T = dX/dk: xx, yy, xy. */
static void SelfPart(NearField f, PetscInt v, PetscInt k, const PetscReal T[2], PetscReal S[3]) {
  const PetscReal factor = 1 / (4 * PETSC_PI * f->nu);
  if (k) {
    S[0] = S[1] = factor * f->kress[v][k];
    S[2] = 0;
    return;
  }
  const PetscReal t2 = T[0] * T[0] + T[1] * T[1], n = LayoutCount(f->membrane->layout, v);
  const PetscReal logarithm = -0.5 * (f->kress[v][0] + PetscLogReal(t2 * PetscSqr(n / (2 * PETSC_PI))));
  S[0] = factor * (logarithm + T[0] * T[0] / t2);
  S[1] = factor * (logarithm + T[1] * T[1] / t2);
  S[2] = factor * T[0] * T[1] / t2;
}

/* Some pairs of a row: marker i with markers j .. j + n - 1; from the column's side where its vesicle is the first. All
   arrays have room for whole vectors. */
#define CHUNK IMAGE_ROW
typedef struct {
  PetscInt i, j, n;
  PetscBool back, plain; /* plain: far from all walls */
  PetscReal reach;       /* of stencils' sums (length) */
  PetscReal d[2][CHUNK], part[CHUNK], L[4][CHUNK], C[4][CHUNK];
} Chunk;

static void Distances(NearField f, const NearBlock *b, Chunk *c) {
  const PetscReal *X = f->markers->X, *x = X + 2 * c->i, sign = c->back ? -1 : 1;
  const PetscReal own[2] = {x[0] - b->shift[0], x[1] - b->shift[1]};
  for (PetscInt k = 0; k < c->n; k++)
    for (int dir = 0; dir < 2; dir++) c->d[dir][k] = sign * (own[dir] - X[2 * (c->j + k) + dir]);
  for (PetscInt k = 0; k < c->n; k++) c->part[k] = 1;
  for (PetscInt k = 0; k < c->n && f->box; k++) {
    PetscReal d[2] = {c->d[0][k], c->d[1][k]};
    c->part[k] = BoxPartImage(f->box, d);
    for (int dir = 0; dir < 2; dir++) c->d[dir][k] = d[dir];
  }
  for (PetscInt k = c->n; k < CHUNK && k < c->n + LANES; k++) c->d[0][k] = c->d[1][k] = 1;
}

/* All pairs as if they were distant. */
static void FillFar(NearField f, Chunk *c) {
  const PetscReal scale = PetscSqr(f->markers->grid->h) / (2 * PETSC_PI * f->nu);
  Lanes C[3];
  for (PetscInt k = 0; k < c->n; k += LANES) {
    FarPairs(f->far, scale, LanesAt(c->d[0] + k), LanesAt(c->d[1] + k), C);
    for (int q = 0; q < 4; q++) *(Lanes *)(c->C[q] + k) = C[PetscMin(q, 2)];
  }
}

/* All but the walls' images. */
static void FillChunk(NearField f, const NearBlock *b, Chunk *c) {
  const PetscReal reach2 = c->plain ? c->reach * c->reach : PETSC_MAX_REAL;
  Distances(f, b, c);
  if (c->plain) FillFar(f, c);
  for (PetscInt k = 0; k < c->n; k++) {
    const PetscInt j = c->j + k, from = c->back ? c->i : j, to = c->back ? j : c->i;
    const PetscReal d[2] = {c->d[0][k], c->d[1][k]};
    PetscReal L[4] = {0, 0, 0, 0}, C[4];
    if (d[0] * d[0] + d[1] * d[1] > reach2) continue;
    if (j == c->i && NearBlockIsSelf(b)) {
      if (!f->free) LatticePair(f, to, from, d, L);
      for (int q = 0; q < 4; q++) C[q] = -L[q];
      c->part[k] *= 0.5;
    } else
      Pair(f, to, from, d, c->reach, L, C);
    for (int q = 0; q < 4; q++) {
      c->L[q][k] = L[q];
      c->C[q][k] = C[q];
    }
  }
}

/* The walls' images. */
static void AddImages(NearField f, Chunk *c) {
  if (c->plain) {
    NearImageAddFar(f->image, c->i, c->j, c->n, c->back, c->d[0], c->d[1],
                    (PetscReal *[]){c->C[0], c->C[1], c->C[2], c->C[3]});
    return;
  }
  for (PetscInt k = 0; k < c->n; k++) {
    const PetscInt from = c->back ? c->i : c->j + k, to = c->back ? c->j + k : c->i;
    const PetscReal d[2] = {c->d[0][k], c->d[1][k]}, L[4] = {c->L[0][k], c->L[1][k], c->L[2][k], c->L[3][k]};
    PetscReal C[4] = {0, 0, 0, 0};
    NearImageAdd(f->image, to, from, d, L, C);
    for (int q = 0; q < 4; q++) c->C[q][k] += C[q];
  }
}

/* The chunk's pairs, from the k-th of the row on. */
static void Write(const Chunk *c, PetscInt k, PetscInt stride, PetscReal row[]) {
  PetscReal *x = row + 2 * k, *y = x + stride;
  const int xy = c->back ? 3 : 2, yx = 5 - xy;
  for (PetscInt q = 0; q < c->n; q++) {
    const PetscReal part = c->part[q];
    x[2 * q] = part * c->C[0][q];
    x[2 * q + 1] = part * c->C[xy][q];
    y[2 * q] = part * c->C[yx][q];
    y[2 * q + 1] = part * c->C[1][q];
  }
}

static void FillRow(NearField f, const NearBlock *b, const NearRow *r) {
  const PetscReal cells = NearBlockIsSelf(b) ? NEAR_CELLS : NEAR_CROSS_CELLS;
  const NearBounds *bounds = &f->bounds[b->column];
  PetscReal *x = f->value + r->at, *y = x + r->stride;
  Chunk c;
  c.i = r->row;
  c.back = b->row > b->column ? PETSC_TRUE : PETSC_FALSE;
  c.reach = cells * f->markers->grid->h;
  c.plain = f->image && NearImageIsFar(f->image, f->markers->X + 2 * r->row, bounds->low, bounds->high) ? PETSC_TRUE
                                                                                                        : PETSC_FALSE;
  for (PetscInt k = 2 * r->count; k < r->stride; k++) x[k] = y[k] = 0;
  for (PetscInt k = 0; k < r->count; k += CHUNK) {
    c.j = r->column + k;
    c.n = PetscMin(CHUNK, r->count - k);
    FillChunk(f, b, &c);
    if (f->image) AddImages(f, &c);
    Write(&c, k, r->stride, x);
  }
}

/* A vesicle's own quadrature, to its block with itself. */
static PetscErrorCode AddSelf(NearField f, const NearBlock *b) {
  const Membrane m = f->membrane;
  const PetscInt first = m->layout->start[b->row];
  NearRow r = NearBlockBegin(m->layout, b);
  PetscReal *T, S[3];
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * r.count, &T));
  SpectralDerivative(m->spectral[b->row], 1, 1, f->markers->X + 2 * first, T);
  do {
    PetscReal *x = f->value + r.at, *y = x + r.stride;
    for (PetscInt k = 0; k < r.count; k++) {
      const PetscReal part = k ? 1 : 0.5;
      SelfPart(f, b->row, k, T + 2 * (r.row - first), S);
      x[2 * k] += part * S[0];
      x[2 * k + 1] += part * S[2];
      y[2 * k] += part * S[2];
      y[2 * k + 1] += part * S[1];
    }
  } while (NearBlockNext(m->layout, b, &r));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void NearBlockAdd(NearField f, const NearBlock *b, PetscReal scale, PetscReal *const part[4]) {
  const Layout l = f->membrane->layout;
  const PetscInt rows = LayoutCount(l, b->row);
  NearRow r = NearBlockBegin(l, b);
  do {
    PetscReal *x = f->value + r.at, *y = x + r.stride;
    for (PetscInt k = 0; k < r.count; k++) {
      const PetscInt at = (r.column + k - l->start[b->column]) * rows + r.row - l->start[b->row];
      const PetscReal alpha = NearBlockIsSelf(b) && !k ? 0.5 * scale : scale;
      x[2 * k] += alpha * part[0][at];
      x[2 * k + 1] += alpha * part[2][at];
      y[2 * k] += alpha * part[3][at];
      y[2 * k + 1] += alpha * part[1][at];
    }
  } while (NearBlockNext(l, b, &r));
}

PetscErrorCode NearBlockFill(NearField f, const NearBlock *b) {
  NearRow r = NearBlockBegin(f->membrane->layout, b);
  PetscFunctionBeginUser;
  do FillRow(f, b, &r);
  while (NearBlockNext(f->membrane->layout, b, &r));
  if (NearBlockIsSelf(b)) PetscCall(AddSelf(f, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
