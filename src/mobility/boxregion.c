#include "mobility/boxregion.h"
#include "numerics/blas.h"
#include "layers/imagetable.h"
#include "base/lanes.h"

#define MARGIN 1.15   /* of a square's side over the diameter of the markers' circle, which turns with them */
#define RATIO 1.26    /* of one side to the next, */
#define FINER 1.1225  /* and of dipoles, whose D is less smooth */
#define CENTRES 8     /* in a side: what a centre is off by goes into the margin */
#define LARGEST 0.5   /* side, of the box's */
#define SMALLEST 1e-4 /* of the largest: eigenvalues below it are dropped */
#define CHECKS 3      /* points in a direction where a square is compared with the whole */

/* The square about the markers. */
static void Around(const BoxRegion *r, PetscInt M, const PetscReal X[], PetscReal centre[2], PetscReal *side) {
  PetscReal low[2] = {X[0], X[1]}, high[2] = {X[0], X[1]}, radius2 = 0;
  for (PetscInt k = 1; k < M; k++)
    for (int d = 0; d < 2; d++) {
      low[d] = PetscMin(low[d], X[2 * k + d]);
      high[d] = PetscMax(high[d], X[2 * k + d]);
    }
  const PetscReal middle[2] = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])}, h = r->grid->h;
  for (PetscInt k = 0; k < M; k++)
    radius2 = PetscMax(radius2, PetscSqr(X[2 * k] - middle[0]) + PetscSqr(X[2 * k + 1] - middle[1]));
  const PetscReal least = MARGIN * 2 * PetscSqrtReal(radius2);
  const PetscReal ratio = BoxParts(r->whole) == 2 ? RATIO : FINER;
  *side = h * PetscPowReal(ratio, PetscCeilReal(PetscLogReal(PetscMax(least / h, 1)) / PetscLogReal(ratio)));
  for (int d = 0; d < 2; d++) {
    const PetscReal spacing = *side / CENTRES,
                    from = 0.5 * (r->grid->lo[d] + r->grid->hi[d]); /* which keeps symmetry */
    centre[d] = from + spacing * rint((middle[d] - from) / spacing);
  }
}

PetscBool BoxRegionMayBeAll(const BoxRegion *r, PetscInt M, const PetscReal X[]) {
  PetscReal centre[2], side;
  if (!M) return PETSC_FALSE;
  Around(r, M, X, centre, &side);
  for (int d = 0; d < 2; d++) {
    const PetscReal low = r->grid->lo[d], high = r->grid->hi[d], quarter = 0.25 * (high - low);
    if (!r->grid->wall[d] && side > BOX_ALL_OFFSET * (high - low)) return PETSC_FALSE;
    if (r->grid->wall[d] && (centre[d] - 0.5 * side < low + quarter || centre[d] + 0.5 * side > high - quarter))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Whether the whole table, which must reach all of the square, may be made smaller there. */
static PetscBool IsWithin(const BoxRegion *r, const PetscReal centre[2], PetscReal side) {
  for (int d = 0; d < 2; d++) {
    const BoxAxis *a = &r->whole->axis[d];
    const PetscReal most = r->all && !a->wall ? BOX_ALL_OFFSET : LARGEST;
    if (side > most * (r->grid->hi[d] - r->grid->lo[d])) return PETSC_FALSE;
    if (a->wall && (centre[d] - 0.5 * side < a->low || centre[d] + 0.5 * side > a->high)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* What the square's functions [BOX_REGION_PLACES] have of those of the whole table in a direction, [functions][n]: sums
   over places. */
static void OnFunctions(const BoxRegion *r, const BoxTable *t, int d, PetscReal part[]) {
  const PetscInt n = BOX_REGION_PLACES, functions = r->whole->functions[d];
  PetscReal whole[BOX_FUNCTIONS], own[BOX_REGION_PLACES];
  (void)PetscArrayzero(part, functions * n);
  for (PetscInt k = 0; k < n; k++) {
    BoxTableFunctions(r->whole, d, t->axis[d].place[k], whole);
    BoxTableFunctions(t, d, t->axis[d].place[k], own);
    for (PetscInt f = 0; f < functions * n; f++) part[f] += whole[f / n] * own[f % n];
  }
}

/* to[n][width] = SUM part[k][n] from[k][width] of `count` k. */
static void ToSquare(PetscInt count, const PetscReal part[], PetscInt width, const PetscReal from[], PetscReal to[]) {
  (void)PetscArrayzero(to, BOX_REGION_PLACES * width);
  for (PetscInt f = 0; f < BOX_REGION_PLACES; f++, to += width)
    for (PetscInt k = 0; k < count; k++)
      for (PetscInt m = 0; m < width; m++) to[m] += part[k * BOX_REGION_PLACES + f] * from[k * width + m];
}

/* Rows [n n][modes] of the square's functions, of a component of a block: first in y, then in x. line: [n0][n][modes],
   work. */
static void BlockRows(const BoxBlock *b, int component, const PetscReal *const part[2], PetscReal line[],
                      PetscReal rows[]) {
  const PetscInt n = BOX_REGION_PLACES, *from = b->first[component], modes = b->modes;
  for (PetscInt i = 0; i < b->n[0]; i++)
    ToSquare(b->n[1], part[1] + from[1] * n, modes, b->Q + (component * b->n[0] + i) * b->n[1] * modes,
             line + i * n * modes);
  ToSquare(b->n[0], part[0] + from[0] * n, n * modes, line, rows);
}

/* Rows [count][n n][rank of the whole] of the square's functions, of the components from `first` on. */
static PetscErrorCode FunctionRows(const BoxRegion *r, const PetscReal *const part[2], int first, int count,
                                   PetscReal A[]) {
  const PetscInt n = BOX_REGION_PLACES, rank = r->whole->rank;
  PetscReal *line, *rows;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(BOX_FUNCTIONS * n * rank, &line, n * n * rank, &rows));
  for (PetscInt q = 0; q < r->whole->blocks * count; q++) {
    const BoxBlock *b = &r->whole->block[q / count];
    const PetscInt c = q % count;
    BlockRows(b, first + (int)c, part, line, rows);
    for (PetscInt f = 0; f < n * n; f++)
      PetscCall(PetscArraycpy(A + (c * n * n + f) * rank + b->start, rows + f * b->modes, b->modes));
  }
  PetscCall(PetscFree2(line, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* to[n n] += what the square's functions have of velocity component c = row[n0][n1] in a block's. */
static void AddVelocity(const BoxBlock *b, int c, const PetscReal *const part[2], const PetscReal row[],
                        PetscReal to[]) {
  enum { n = BOX_REGION_PLACES, vectors = n / LANES };
  const PetscReal *x = part[0] + b->first[c][0] * n;
  for (PetscInt i = 0; i < b->n[0]; i++, x += n) {
    const PetscReal *y = part[1] + b->first[c][1] * n;
    Lanes sum[vectors] = {{0}};
    for (PetscInt j = 0; j < b->n[1]; j++, y += n)
      for (int v = 0; v < vectors; v++) sum[v] += row[i * b->n[1] + j] * LanesAt(y + v * LANES);
    for (int f = 0; f < n; f++)
      for (int v = 0; v < vectors; v++)
        LanesPut(LanesAt(to + f * n + v * LANES) + x[f] * sum[v], to + f * n + v * LANES);
  }
}

/* The same of a table that keeps D between its functions: a mode is a velocity's function. */
static PetscErrorCode BetweenKept(const BoxRegion *r, const PetscReal *const part[2], BoxTable *t) {
  const PetscInt n = t->functions[0] * t->functions[1], parts = BoxParts(t);
  PetscInt most = 0;
  PetscReal *line, *rows;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < r->whole->blocks; k++) most = PetscMax(most, r->whole->block[k].modes);
  PetscCall(PetscMalloc2(BOX_FUNCTIONS * BOX_REGION_PLACES * most, &line, n * most, &rows));
  PetscCall(PetscArrayzero(t->block->Q, 2 * n * parts * n));
  for (PetscInt k = 0; k < r->whole->blocks * parts; k++) {
    const BoxBlock *b = &r->whole->block[k / parts];
    const PetscInt part_of = k % parts, half = b->modes / 2;
    BlockRows(b, BoxFirstPart(t) + (int)part_of, part, line, rows);
    for (PetscInt q = 0; q < 2 * n; q++)
      AddVelocity(b, (int)(q % 2), part, rows + q * half, t->block->Q + (part_of * 2 * n + q) * n);
  }
  PetscCall(PetscFree2(line, rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* D = A l B^T from the square's functions of a source to those of a velocity, into Q of its one block. */
static PetscErrorCode BetweenFunctions(const BoxRegion *r, BoxTable *t) {
  const PetscInt n = t->functions[0] * t->functions[1], rank = r->whole->rank, parts = BoxParts(t);
  PetscReal own[2][BOX_FUNCTIONS * BOX_REGION_PLACES], *A, *B;
  const PetscReal *const part[2] = {own[0], own[1]};
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) OnFunctions(r, t, d, own[d]);
  if (r->all) {
    PetscCall(BetweenKept(r, part, t));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc2(2 * n * rank, &A, parts * n * rank, &B));
  PetscCall(FunctionRows(r, part, 0, 2, A));
  PetscCall(FunctionRows(r, part, BoxFirstPart(t), (int)parts, B));
  for (PetscInt k = 0; k < parts * n * rank; k++) B[k] *= r->whole->l[k % rank];
  PetscCall(DenseProduct(PETSC_TRUE, 2 * n, parts * n, rank, A, B, t->block->Q));
  PetscCall(PetscFree2(A, B));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether all pairs in the square are so far from one another's images in walls that these have a closed form. */
static PetscBool HasFarImages(const BoxRegion *r, const BoxSquare *s) {
  if (r->all) return PETSC_TRUE;
  if (!r->images) return PETSC_FALSE;
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal low = s->centre[dir] - 0.5 * s->side - r->grid->lo[dir];
    const PetscReal high = r->grid->hi[dir] - s->centre[dir] - 0.5 * s->side;
    if (r->grid->wall[dir] && 2 * PetscMin(low, high) < IMAGE_OFF * r->grid->h) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* The images as the near field has them: over a period, of the nearest ones and fading. Or less what has faded of the
   unbounded double layer, which is taken whole. */
static void Images(const BoxRegion *r, int parts, PetscInt n, const PetscReal X[], const PetscReal Y[2],
                   PetscReal V[]) {
  PetscReal d[2][BOX_IMAGE_ROW], part[BOX_IMAGE_ROW];
  for (PetscInt k = 0; k < 2 * n; k++) d[k % 2][k / 2] = X[k] - Y[k % 2];
  if (r->all) {
    BoxFaded(r->whole->axis, n, (PetscReal *[]){d[0], d[1]}, V);
    for (PetscInt k = 0; k < 2 * parts * n; k++) V[k] = -V[k];
    return;
  }
  BoxImageRow(r->whole->axis, n, (PetscReal *[]){d[0], d[1]}, part);
  r->images(r->image, n, X, Y, V);
  for (PetscInt k = 0; k < 2 * parts * n; k++) V[k] *= part[k % n];
}

/* A place's functions of the square that are not zero there. */
enum { AT_PLACE = 4 };
typedef struct {
  PetscInt count, f[AT_PLACE];
  PetscReal weight[AT_PLACE];
} AtPlace;

static void MakeAtPlaces(const BoxTable *t, PetscReal X[], AtPlace at[]) {
  const PetscInt n = BOX_REGION_PLACES;
  PetscReal value[2][BOX_REGION_PLACES];
  for (PetscInt k = 0; k < n * n; k++) {
    at[k].count = 0;
    for (int d = 0; d < 2; d++) {
      X[2 * k + d] = t->axis[d].place[d ? k % n : k / n];
      BoxTableFunctions(t, d, X[2 * k + d], value[d]);
    }
    for (PetscInt f = 0; f < n * n; f++) {
      const PetscReal weight = value[0][f / n] * value[1][f % n];
      if (weight == 0 || at[k].count == AT_PLACE) continue;
      at[k].f[at[k].count] = f;
      at[k].weight[at[k].count++] = weight;
    }
  }
}

/* The walls' images between places, to the square's D between functions. */
static void AddFarImages(const BoxRegion *r, BoxTable *t) {
  const PetscInt n = BOX_IMAGE_ROW, parts = BoxParts(t);
  PetscReal X[2 * BOX_IMAGE_ROW], V[2 * DIPOLE_COUNT * BOX_IMAGE_ROW], sum[BOX_IMAGE_ROW];
  AtPlace at[BOX_IMAGE_ROW];
  MakeAtPlaces(t, X, at);
  for (PetscInt l = 0; l < n; l++) {
    Images(r, (int)parts, n, X, X + 2 * l, V);
    for (PetscInt q = 0; q < 2 * parts; q++) {
      (void)PetscArrayzero(sum, n);
      for (PetscInt k = 0; k < n; k++)
        for (PetscInt m = 0; m < at[k].count; m++) sum[at[k].f[m]] += at[k].weight[m] * V[q * n + k];
      for (PetscInt m = 0; m < at[l].count; m++) {
        PetscReal *to = t->block->Q + (q % parts * n + at[l].f[m]) * 2 * n + q / parts * n;
        for (PetscInt f = 0; f < n; f++) to[f] += at[l].weight[m] * sum[f];
      }
    }
  }
}

/* Point k of CHECKS x CHECKS of the square where interpolation is worst. */
static void Check(const BoxTable *t, PetscInt k, PetscReal X[2]) {
  for (int d = 0; d < 2; d++) {
    const PetscReal part = (PetscReal)(d ? k % CHECKS : k / CHECKS) / (CHECKS - 1);
    X[d] = t->axis[d].low + part * (t->axis[d].high - t->axis[d].low);
  }
}

/* Largest D_whole - D_square between the points, over the largest D_whole, images in either if they are in the
   square's, which is between functions, in Q. */
static PetscErrorCode OffBy(const BoxRegion *r, const BoxTable *t, PetscReal *off) {
  const PetscInt n = t->functions[0] * t->functions[1], rank = r->whole->rank, parts = BoxParts(t);
  const PetscInt points = (CHECKS * CHECKS + LANES - 1) / LANES * LANES;
  PetscReal *row[CHECKS * CHECKS], *value[CHECKS * CHECKS], *column, most = 0, largest = 0;
  PetscReal at[2 * BOX_IMAGE_ROW] = {0}, V[2 * DIPOLE_COUNT * BOX_IMAGE_ROW] = {0};
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &column));
  for (PetscInt k = 0; k < CHECKS * CHECKS; k++) {
    PetscReal *X = at + 2 * k, v[2][BOX_REGION_PLACES];
    PetscCall(PetscMalloc2(r->whole->components * rank, &row[k], n, &value[k]));
    Check(t, k, X);
    BoxTableRows(r->whole, X, 1, 0, r->whole->components, row[k]);
    for (int d = 0; d < 2; d++) BoxTableFunctions(t, d, X[d], v[d]);
    for (PetscInt f = 0; f < n; f++) value[k][f] = v[0][f / BOX_REGION_PLACES] * v[1][f % BOX_REGION_PLACES];
  }
  for (PetscInt j = 0; j < CHECKS * CHECKS * parts; j++) {
    if (t->images && j % parts == 0) Images(r, (int)parts, points, at, at + 2 * (j / parts), V);
    const PetscReal *source = row[j / parts] + (BoxFirstPart(t) + j % parts) * rank;
    PetscCall(PetscArrayzero(column, 2 * n));
    PetscCall(DenseMultAdd(PETSC_FALSE, 2 * n, n, 1, t->block->Q + j % parts * n * 2 * n, value[j / parts], column));
    for (PetscInt i = 0; i < 2 * CHECKS * CHECKS; i++) {
      const PetscReal D = BoxProduct(rank, r->whole->l, row[i / 2] + i % 2 * rank, source) +
                          V[(i % 2 * parts + j % parts) * points + i / 2];
      most = PetscMax(most, PetscAbsReal(D - LanesDot(n, column + i % 2 * n, value[i / 2])));
      largest = PetscMax(largest, PetscAbsReal(D));
    }
  }
  for (PetscInt k = 0; k < CHECKS * CHECKS; k++) PetscCall(PetscFree2(row[k], value[k]));
  PetscCall(PetscFree(column));
  *off = most / largest;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The square's axes about its centre. */
static void MakeAxes(const PetscReal centre[2], PetscReal side, BoxTable *t) {
  for (int d = 0; d < 2; d++)
    BoxAxisChebyshev(BOX_REGION_PLACES, centre[d] - 0.5 * side, centre[d] + 0.5 * side, &t->axis[d]);
}

/* Whether a product with the square's table is cheaper than one with the whole one. */
static PetscBool IsCheaper(const BoxTable *whole, const BoxTable *t) {
  const PetscInt n = t->functions[0] * t->functions[1];
  PetscInt entries = 0;
  if (BoxParts(t) == 2) return t->rank < whole->rank ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < whole->blocks; k++) {
    const BoxBlock *b = &whole->block[k];
    entries += whole->components * b->n[0] * b->n[1] * b->modes;
  }
  return 2 * n * BoxParts(t) * n < entries ? PETSC_TRUE : PETSC_FALSE;
}

/* The square's table; of dipoles D itself stays in Q, a matrix without eigenvalues. D depends on offsets along a period
   alone, so there it is made about the same place always. */
static PetscErrorCode MakeTable(const BoxRegion *r, BoxSquare *s) {
  const PetscInt n = BOX_REGION_PLACES;
  BoxTable *t = &s->table;
  PetscReal fixed[2], off = 0;
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) fixed[d] = r->whole->axis[d].wall ? s->centre[d] : r->grid->lo[d];
  *t = (BoxTable){.components = r->whole->components, .functions = {n, n}, .blocks = 1, .H = r->whole->H};
  MakeAxes(fixed, s->side, t);
  PetscCall(PetscCalloc1(1, &t->block));
  t->block->n[0] = t->block->n[1] = n;
  PetscCall(PetscMalloc1(2 * n * n * BoxParts(t) * n * n, &t->block->Q));
  PetscCall(BetweenFunctions(r, t));
  t->images = HasFarImages(r, s);
  if (t->images) AddFarImages(r, t);
  PetscCall(OffBy(r, t, &off));
  if (BoxParts(t) == 2) PetscCall(BoxTableDecompose(r->comm, SMALLEST, t));
  s->right = off < r->off && (r->all || IsCheaper(r->whole, t)) ? PETSC_TRUE : PETSC_FALSE;
  MakeAxes(s->centre, s->side, t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the square is where it should be; along a period it goes there, and has moved. */
static PetscBool IsThere(const BoxRegion *r, const PetscReal centre[2], PetscReal side, BoxSquare *s,
                         PetscBool *moved) {
  if (s->side != side) return PETSC_FALSE;
  for (int d = 0; d < 2; d++)
    if (r->whole->axis[d].wall && s->centre[d] != centre[d]) return PETSC_FALSE;
  if (s->centre[0] == centre[0] && s->centre[1] == centre[1]) return PETSC_TRUE;
  *moved = PETSC_TRUE;
  for (int d = 0; d < 2; d++) s->centre[d] = centre[d];
  MakeAxes(centre, side, &s->table);
  return PETSC_TRUE;
}

/* The square that is there becomes the first; if it is new, in the place of the one that was not used for longest. */
static PetscErrorCode Take(BoxRegion *r, const PetscReal centre[2], PetscReal side, PetscBool *moved) {
  BoxSquare *s = r->square;
  PetscInt k = 0;
  PetscFunctionBeginUser;
  while (k < BOX_REGION_SQUARES && !IsThere(r, centre, side, &s[k], moved)) k++;
  if (!k) PetscFunctionReturn(PETSC_SUCCESS);
  *moved = PETSC_TRUE;
  const PetscBool found = k < BOX_REGION_SQUARES ? PETSC_TRUE : PETSC_FALSE;
  BoxSquare taken = s[found ? k : BOX_REGION_SQUARES - 1];
  if (!found) {
    PetscCall(BoxTableDestroy(&taken.table));
    taken = (BoxSquare){.centre = {centre[0], centre[1]}, .side = side};
    PetscCall(MakeTable(r, &taken));
  }
  for (k = found ? k : BOX_REGION_SQUARES - 1; k > 0; k--) s[k] = s[k - 1];
  s[0] = taken;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxRegionAt(BoxRegion *r, PetscInt M, const PetscReal X[], const BoxTable **table, PetscBool *moved) {
  const BoxTable *before = *table;
  PetscReal centre[2], side;
  PetscFunctionBeginUser;
  *moved = PETSC_FALSE;
  *table = r->whole;
  if (M) {
    Around(r, M, X, centre, &side);
    if (IsWithin(r, centre, side)) {
      PetscCall(Take(r, centre, side, moved));
      if (r->square[0].right) *table = &r->square[0].table;
    }
  }
  if (*table != before) *moved = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxRegionDestroy(BoxRegion *r) {
  PetscFunctionBeginUser;
  for (int k = 0; k < BOX_REGION_SQUARES; k++) PetscCall(BoxTableDestroy(&r->square[k].table));
  PetscFunctionReturn(PETSC_SUCCESS);
}
