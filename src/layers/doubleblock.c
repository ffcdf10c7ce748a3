#include "layers/doubleblock.h"
#include "layers/dipolefaces.h"

#define CELLS 16 /* up to which pairs' stencils are summed; farther, a closed form, right to 2e-5 of D */

PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                              PetscReal along[]) {
  PetscReal *T;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &T));
  SpectralDerivative(spectral, 1, 1, X, T);
  for (PetscInt k = 0; k < n; k++) {
    normal[2 * k] = T[2 * k + 1];
    normal[2 * k + 1] = -T[2 * k];
    along[k] = PetscHypotReal(T[2 * k], T[2 * k + 1]);
  }
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D of a curve's markers with themselves, where the curvature kappa takes the place of 2 r.n/r^2:
       D = -(kappa/2 pi) t t w,
   from the label's derivatives: [n][3], xx, yy, xy. */
static PetscErrorCode Diagonals(Spectral spectral, PetscInt n, const PetscReal X[], const PetscReal normal[],
                                PetscReal D[]) {
  PetscReal *TT;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &TT));
  SpectralDerivative(spectral, 2, 1, X, TT);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal T[2] = {-normal[2 * k + 1], normal[2 * k]}, t2 = T[0] * T[0] + T[1] * T[1];
    const PetscReal q = -(T[0] * TT[2 * k + 1] - T[1] * TT[2 * k]) / (2 * PETSC_PI * t2 * t2);
    D[3 * k] = q * T[0] * T[0];
    D[3 * k + 1] = q * T[1] * T[1];
    D[3 * k + 2] = q * T[0] * T[1];
  }
  PetscCall(PetscFree(TT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From marker p of n on, in a source's columns of J_x and of J_y: value[2][2n]. */
static inline void PutFour(const Lanes M[4], PetscInt p, PetscInt n, PetscReal value[]) {
  for (int k = 0; k < 2; k++) {
    PetscReal row[2 * LANES], *to = value + k * 2 * n + 2 * p;
    LanesInterlace(M[2 * k], M[2 * k + 1], p + LANES <= n ? to : row);
    for (PetscInt i = 0; i < 2 * (n - p) && p + LANES > n; i++) to[i] = row[i];
  }
}

PetscErrorCode DoubleSelf(Spectral spectral, PetscInt n, const PetscReal X[], const PetscReal normal[], PetscReal D[]) {
  PetscReal *x, *y, *own;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(n + LANES, &x, n + LANES, &y, 3 * n, &own));
  PetscCall(Diagonals(spectral, n, X, normal, own));
  for (PetscInt k = 0; k < n; k++) {
    x[k] = X[2 * k];
    y[k] = X[2 * k + 1];
  }
  for (PetscInt j = 0; j < n; j++) {
    PetscReal *column = D + 2 * j * 2 * n, *at = column + 2 * j;
    for (PetscInt p = 0; p < n; p += LANES) {
      Lanes M[3];
      StressletFour(LanesAt(x + p) - x[j], LanesAt(y + p) - y[j], normal + 2 * j, M);
      PutFour((Lanes[]){M[0], M[2], M[2], M[1]}, p, n, column);
    }
    at[0] = own[3 * j];
    at[2 * n + 1] = own[3 * j + 1];
    at[1] = at[2 * n] = own[3 * j + 2];
  }
  PetscCall(PetscFree3(x, y, own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lattice's answer to unit tensor parts (which are 2 J_x N_x, 2 J_y N_y and J_x N_y + J_y N_x of a marker) of four
   distant pairs, (x, y) = X_i - X_j: D less h^2/(48 pi r^3) and h^4/(64 pi r^5) times waves of the angle, smoothing by
   the kernels and dispersion by the lattice. */
static inline void FarFour(PetscReal h, Lanes x, Lanes y, Lanes K[2][DIPOLE_COUNT]) {
  const Lanes r2 = x * x + y * y, over = 1 / r2, q = over * over / PETSC_PI, scale = h * h / 48 * q * over;
  const Lanes c2 = (x * x - y * y) * over, s2 = 2 * x * y * over; /* times scale: of 3 phi, 5 phi and 7 phi, over r^3 */
  const Lanes c3 = scale * x * (x * x - 3 * y * y), s3 = scale * y * (3 * x * x - y * y);
  const Lanes c5 = c3 * c2 - s3 * s2, s5 = s3 * c2 + c3 * s2, c7 = c5 * c2 - s5 * s2, s7 = s5 * c2 + c5 * s2;
  const Lanes next = 0.75 * h * h * over, C5 = next * c5, S5 = next * s5, C7 = next * c7, S7 = next * s7;
  const Lanes C9 = C7 * c2 - S7 * s2, S9 = S7 * c2 + C7 * s2, C11 = C9 * c2 - S9 * s2, S11 = S9 * c2 + C9 * s2;
  K[0][DIPOLE_XX] = 0.5 * q * x * x * x - (13 * c3 - 9 * c5 - 6 * c7) - (65 * C5 + 95 * C7 - 45 * C9 - 35 * C11);
  K[0][DIPOLE_YY] = 0.5 * q * x * y * y - (-17 * c3 - 3 * c5 + 6 * c7) - (23 * C5 - 115 * C7 - 15 * C9 + 35 * C11);
  K[0][DIPOLE_XY] = q * x * x * y - (34 * s3 - 6 * s5 - 12 * s7) - (46 * S5 + 230 * S7 - 30 * S9 - 70 * S11);
  K[1][DIPOLE_XX] = 0.5 * q * x * x * y - (17 * s3 - 3 * s5 - 6 * s7) - (23 * S5 + 115 * S7 - 15 * S9 - 35 * S11);
  K[1][DIPOLE_YY] = 0.5 * q * y * y * y - (-13 * s3 - 9 * s5 + 6 * s7) - (65 * S5 - 95 * S7 - 45 * S9 + 35 * S11);
  K[1][DIPOLE_XY] = q * x * y * y - (-34 * c3 - 6 * c5 + 12 * c7) - (46 * C5 - 230 * C7 - 30 * C9 + 70 * C11);
}

void DoubleLatticeParts(const OffsetTable lattice[2], PetscReal reach, const PaddedStencil response[2],
                        const PaddedStencil dipole[DIPOLE_COUNT], const PetscInt cells[2], const PetscReal d[2],
                        PetscReal K[2][DIPOLE_COUNT]) {
  Lanes four[2][DIPOLE_COUNT];
  if (d[0] * d[0] + d[1] * d[1] <= reach * reach) {
    StencilDipoleSums(lattice, response, dipole, cells, K);
    return;
  }
  FarFour(1, d[0] + (Lanes){0}, d[1] + (Lanes){0}, four);
  for (int c = 0; c < 2; c++)
    for (int k = 0; k < DIPOLE_COUNT; k++) K[c][k] = four[c][k][0];
}

/* A block's columns, one at a time: the markers of its row respond to one of its column. */
typedef struct {
  const DoublePairs *pairs;
  const DoubleBlock *block;
  PetscBool self;
  DoubleColumn to;
  PetscReal *part;    /* [n] BoxImageRow */
  PetscReal *flux[2]; /* [n] SUM L n over the columns */
  PetscReal *memory;
  PetscBool by_faces; /* all pairs by stencils, together: */
  DipoleFaces faces;
  PetscInt cells[2]; /* added to their offsets */
} Fill;

/* Whether no pair is farther apart than faces are shared, nor has another image for the nearest one. */
static PetscBool DoubleFillIsNear(Fill *f) {
  const LayerSetting *set = f->pairs->single->set;
  const Grid g = set->markers->grid;
  const NearBounds *row = &f->pairs->single->bounds[f->block->row];
  const NearBounds *column = &f->pairs->single->bounds[f->block->column];
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal shift = f->block->shift[dir], half = 0.49 * (g->hi[dir] - g->lo[dir]);
    const PetscReal most = PetscMax(row->high[dir] - column->low[dir] - shift,
                                    column->high[dir] + shift - row->low[dir]);
    if (most > DOUBLE_FACE_CELLS * g->h || (set->box && !g->wall[dir] && most > half)) return PETSC_FALSE;
    f->cells[dir] = (PetscInt)rint(-shift / g->h);
  }
  return PETSC_TRUE;
}

/* Faces, which way takes less, as a marker's double sums cost as much as some vectors of them; and all arrays, one
   behind the other: those of the walls first. */
static PetscErrorCode DoubleFillCreate(const DoublePairs *s, const DoubleBlock *b, PetscBool lattice, Fill *f) {
  enum { VECTORS_PER_MARKER = 6 };
  const Layout l = s->single->set->markers->layout;
  const PetscInt n = LayoutCount(l, b->row), room = n + LANES;
  DoubleColumn *c = &f->to;
  PetscFunctionBeginUser;
  *f = (Fill){.pairs = s, .block = b, .to = {.i = l->start[b->row], .n = n, .lattice = lattice}};
  f->self = b->row == b->column && b->shift[0] == 0 && b->shift[1] == 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscCalloc1(15 * room, &f->memory));
  PetscReal **const arrays[] = {&c->wall[0], &c->wall[1], &c->wall[2], &c->wall[3], &c->flux[0],
                                &c->flux[1], &c->free[0], &c->free[1], &c->free[2], &c->free[3],
                                &c->d[0],    &c->d[1],    &f->flux[0], &f->flux[1], &f->part};
  for (int k = 0; k < 15; k++) *arrays[k] = f->memory + k * room;
  if (s->image) DoubleImageRange(s->image, c);
  if (!lattice || !DoubleFillIsNear(f)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DipoleFacesCreate(n, s->single->stencil + 2 * c->i, &f->faces));
  f->by_faces = f->faces.vectors <= VECTORS_PER_MARKER * n ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Where the column's marker is from those of the row; nothing of walls. */
static void DoubleFillBegin(Fill *f, PetscInt j) {
  const LayerSetting *set = f->pairs->single->set;
  DoubleColumn *c = &f->to;
  const PetscReal *X = set->markers->X;
  const Lanes from = {X[2 * j] + f->block->shift[0], X[2 * j + 1] + f->block->shift[1]};
  c->j = j;
  c->over = 1 / f->pairs->along[j];
  for (int dir = 0; dir < 2; dir++) c->N[dir] = f->pairs->normal[2 * j + dir];
  for (PetscInt p = 0; p < c->n; p++) {
    c->d[0][p] = X[2 * (c->i + p)] - from[0];
    c->d[1][p] = X[2 * (c->i + p) + 1] - from[1];
    f->part[p] = 1;
  }
  if (c->lattice && set->box) BoxImageRow(set->box, c->n, c->d, f->part);
  (void)PetscArrayzero(c->wall[0], 6 * (c->n + LANES));
}

/* The lattice without walls: all pairs as if they were distant, if any are, then those by stencils. */
static void DoubleFillLattice(Fill *f) {
  const DoublePairs *s = f->pairs;
  const DoubleColumn *c = &f->to;
  const PetscReal *X = s->single->set->markers->X, h = s->single->set->markers->grid->h;
  const PaddedStencil *dipole = &s->dipole[DIPOLE_COUNT * c->j];
  const PetscReal reach2 = PetscSqr(CELLS * h);
  PetscInt distant = 0;
  if (f->by_faces) {
    DipoleFacesAnswer(&f->faces, s->lattice, dipole, f->cells, c->N, 1 / h, c->free);
    return;
  }
  for (PetscInt p = 0; p < c->n; p++) distant += PetscSqr(c->d[0][p]) + PetscSqr(c->d[1][p]) > reach2;
  for (PetscInt p = 0; p < c->n && distant; p += LANES) {
    Lanes K[2][DIPOLE_COUNT], M[4];
    FarFour(h, LanesAt(c->d[0] + p), LanesAt(c->d[1] + p), K);
    DipoleContractFour(K, c->N, M);
    for (int q = 0; q < 4; q++) LanesPut(M[q], c->free[q] + p);
  }
  for (PetscInt p = 0; p < c->n && distant < c->n; p++) {
    const PetscReal d[2] = {c->d[0][p], c->d[1][p]}, *at = X + 2 * (c->i + p);
    PetscReal K[2][DIPOLE_COUNT], M[4];
    PetscInt cells[2];
    if (d[0] * d[0] + d[1] * d[1] > reach2) continue;
    for (int dir = 0; dir < 2; dir++) cells[dir] = (PetscInt)rint((d[dir] - (at[dir] - X[2 * c->j + dir])) / h);
    StencilDipoleSums(s->lattice, &s->single->stencil[2 * (c->i + p)], dipole, cells, K);
    DipoleContract((const PetscReal(*)[DIPOLE_COUNT])K, c->N, 1 / h, M);
    for (int q = 0; q < 4; q++) c->free[q][p] = M[q];
  }
}

/* The column's numbers of C = D - L (or D) to value, columns of J_x and of J_y, and L n added to the flux. D of a
   marker with itself, own[3] in a body's block with itself, is not among the others. */
static void DoubleFillEnd(Fill *f, const PetscReal own[3], PetscReal value[]) {
  const DoubleColumn *c = &f->to;
  const PetscReal *N = c->N, n[2] = {c->over * N[0], c->over * N[1]};
  for (PetscInt p = 0; p < c->n; p += LANES) {
    const Lanes part = LanesAt(f->part + p);
    Lanes D[3], M[4], free[4];
    StressletFour(LanesAt(c->d[0] + p), LanesAt(c->d[1] + p), N, D);
    for (int k = 0; k < 4; k++) {
      free[k] = LanesAt(c->free[k] + p);
      M[k] = part * (D[k == 0 ? 0 : k == 3 ? 1 : 2] + (LanesAt(c->wall[k] + p) - free[k]));
    }
    for (int comp = 0; comp < 2; comp++) {
      const Lanes flux = n[0] * free[comp] + n[1] * free[2 + comp] + LanesAt(c->flux[comp] + p);
      LanesPut(LanesAt(f->flux[comp] + p) + part * flux, f->flux[comp] + p);
    }
    PutFour(M, p, c->n, value);
  }
  if (!own) return;
  const PetscInt k = c->j - c->i;
  PetscReal *x = value + 2 * k, *y = x + 2 * c->n;
  x[0] += f->part[k] * own[0];
  y[1] += f->part[k] * own[1];
  x[1] += f->part[k] * own[2];
  y[0] += f->part[k] * own[2];
}

/* Parts in a block: from J_x to u, v, then from J_y. */
static void DoubleBlockKernel(const void *context, int wall, const Lanes x[2], const PetscReal y[2],
                              const PetscReal N[2], Lanes K[]) {
  const DoublePairs *s = (const DoublePairs *)context;
  Lanes D[3], seen[3];
  if (wall >= 0) {
    NearImageSeen(s->single->set->markers->grid, wall, x, y, seen);
    DoubleImageFourExact(s->image, wall, N, (const Lanes[]){seen[0], seen[1], -seen[2]}, K); /* y is mirrored */
    return;
  }
  StressletFour(x[0] - y[0], x[1] - y[1], N, D);
  K[0] = D[0];
  K[1] = K[2] = D[2];
  K[3] = D[1];
}

PetscErrorCode DoubleBlockRefine(const DoublePairs *s, const FinePair *pair, PetscReal value[]) {
  const Layout l = s->single->set->markers->layout;
  const PetscInt n = LayoutCount(l, pair->row), m = LayoutCount(l, pair->column);
  const FineKernel kernel = {4, DoubleBlockKernel, s, s->normal + 2 * l->start[pair->column]};
  PetscReal *part;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(4 * n * m, &part));
  PetscCall(FinePairParts(s->single->set, pair, &kernel, part));
  for (PetscInt k = 0; k < 4 * n * m; k++) {
    const PetscInt c = k / (n * m), j = k / n % m, i = k % n;
    value[(2 * j + c / 2) * 2 * n + 2 * i + c % 2] += part[k];
  }
  PetscCall(PetscFree(part));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBlockFill(const DoublePairs *s, const DoubleBlock *b, PetscBool lattice, PetscReal value[]) {
  const LayerSetting *set = s->single->set;
  const PetscInt n = LayoutCount(set->markers->layout, b->row), m = LayoutCount(set->markers->layout, b->column);
  const PetscInt first = set->markers->layout->start[b->column];
  const PetscReal reach = set->box ? PETSC_MAX_REAL : DOUBLE_IMAGE_REACH;
  PetscReal *own = NULL;
  FinePair atwall[4];
  PetscInt walls;
  Fill f;
  PetscFunctionBeginUser;
  PetscCall(DoubleFillCreate(s, b, lattice, &f));
  if (f.self) {
    PetscCall(PetscMalloc1(3 * m, &own));
    PetscCall(Diagonals(set->bodies->spectral[b->row], m, set->markers->X + 2 * first, s->normal + 2 * first, own));
  }
  for (PetscInt q = 0; q < m; q++) {
    DoubleFillBegin(&f, first + q);
    if (lattice) DoubleFillLattice(&f);
    if (s->image) DoubleImageAddColumn(s->image, reach, &f.to);
    DoubleFillEnd(&f, own ? own + 3 * q : NULL, value + 2 * q * 2 * n);
  }
  for (PetscInt j = 0; j < 2 * m && lattice; j++) { /* + (L n) (n w)^T/length: L acts on what Q leaves */
    const PetscReal N = s->normal[2 * first + j] / s->length[b->column];
    for (PetscInt i = 0; i < 2 * n; i++) value[j * 2 * n + i] += N * f.flux[i % 2][i / 2];
  }
  FinePairsAtWalls(set, s->single->bounds, b->row, b->column, b->shift, atwall, &walls);
  for (PetscInt k = 0; k < walls; k++) PetscCall(DoubleBlockRefine(s, &atwall[k], value));
  PetscCall(PetscFree(own));
  PetscCall(DipoleFacesDestroy(&f.faces));
  PetscCall(PetscFree(f.memory));
  PetscFunctionReturn(PETSC_SUCCESS);
}
