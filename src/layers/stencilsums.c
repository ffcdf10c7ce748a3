#include "layers/stencilsums.h"
#include "base/lanes.h"

PetscErrorCode OffsetTableCreate(const PetscInt size[2], OffsetTable *t) {
  PetscFunctionBeginUser;
  for (int d = 0; d < 2; d++) t->size[d] = size[d];
  for (int b = 0; b < OFFSET_COUNT; b++) PetscCall(PetscCalloc1((2 * size[0] + 1) * (2 * size[1] + 1), &t->value[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OffsetTableDestroy(OffsetTable *t) {
  PetscFunctionBeginUser;
  for (int b = 0; b < OFFSET_COUNT; b++) PetscCall(PetscFree(t->value[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void OffsetTableTurn(OffsetTable *t) {
  const PetscInt n = 2 * t->size[0] + 1;
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) t->value[OFFSET_VV][j * n + i] = t->value[OFFSET_UU][i * n + j];
}

/* Six weights between six zeros on either side. */
void StencilPad(const Stencil *s, PaddedStencil *p) {
  const Lanes low = {0, 1, 2, 3}, high = low + LANES;
  for (int dir = 0; dir < 2; dir++) {
    PetscReal *w = p->weight[dir];
    Lanes weight[2] = {{0}, {0}};
    for (int i = 0; i < KERNEL_MAX_POINTS; i++) weight[i / LANES][i % LANES] = i < s->n[dir] ? s->weight[dir][i] : 0;
    for (int i = 0; i < 3 * KERNEL_MAX_POINTS - LANES; i += LANES) LanesPut((Lanes){0}, w + i);
    LanesPut((Lanes){0}, w + 3 * KERNEL_MAX_POINTS - LANES);
    for (int q = 0; q < 2; q++) LanesPut(weight[q], w + KERNEL_MAX_POINTS + LANES * q);
    const PetscReal place = LanesSum(weight[0] * low + weight[1] * high);
    const Lanes x = (low - place) * (low - place), y = (high - place) * (high - place);
    p->fourth[dir] = LanesSum(weight[0] * x * x + weight[1] * y * y);
    p->first[dir] = s->first[dir];
    p->n[dir] = s->n[dir];
  }
}

PetscInt StencilLagWeights(int dir, const PaddedStencil *response, const PaddedStencil *source,
                           PetscReal weight[restrict OFFSET_LAGS]) {
  const PetscReal *restrict a = response->weight[dir] + 1, *restrict b = source->weight[dir] + KERNEL_MAX_POINTS;
  for (int q = 0; q < OFFSET_LAGS; q++) {
    PetscReal sum = 0;
    for (int j = 0; j < KERNEL_MAX_POINTS; j++) sum += a[q + j] * b[j];
    weight[q] = sum;
  }
  return response->first[dir] - source->first[dir] - (KERNEL_MAX_POINTS - 1);
}

void StencilUnwrap(Grid g, const PetscReal X[2], PaddedStencil s[2]) {
  for (int comp = 0; comp < 2; comp++)
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal off = (X[dir] - g->lo[dir]) / g->h - (PetscReal)s[comp].first[dir];
      if (!g->wall[dir]) s[comp].first[dir] += g->n[dir] * (PetscInt)PetscFloorReal(off / g->n[dir] + 0.5);
    }
}

/* Three vectors of numbers. */
typedef union {
  Lanes lanes[3];
  PetscReal weight[3 * LANES];
} StencilLags;

/* Weights of the lags of two stencils, the source's of n points, from the least one on, which is returned; zeros up to
   the last vector's end. */
static inline PetscInt StencilLagsOf(const int vectors, const PetscInt n, int dir, const PaddedStencil *response,
                                     const PaddedStencil *source, StencilLags *lags) {
  const PetscReal *a = response->weight[dir] + KERNEL_MAX_POINTS + 1 - n, *b = source->weight[dir] + KERNEL_MAX_POINTS;
  for (int q = 0; q < vectors; q++) lags->lanes[q] = b[0] * LanesAt(a + q * LANES);
  for (PetscInt j = 1; j < n; j++)
    for (int q = 0; q < vectors; q++) lags->lanes[q] += b[j] * LanesAt(a + j + q * LANES);
  return response->first[dir] - source->first[dir] - (n - 1);
}

/* A table's numbers from the offset (0, 0) on. */
typedef struct {
  const PetscReal *value;
  PetscInt width;
} TableMiddle;

static inline TableMiddle TableMiddleOf(const OffsetTable *t, int block) {
  const PetscInt width = 2 * t->size[0] + 1;
  return (TableMiddle){t->value[block] + t->size[1] * width + t->size[0], width};
}

/* Points of a response and a source along x and y, and the vectors of a row's lags. */
typedef struct {
  int vectors;
  PetscInt response[2], source[2];
} StencilPoints;

/* The double sum of two stencils with these points. */
static inline PetscReal StencilSum(const StencilPoints p, TableMiddle t, const PaddedStencil *response,
                                   const PaddedStencil *source, const PetscInt cells[2]) {
  const PetscInt rows = p.response[1] + p.source[1] - 1;
  StencilLags wx, wy;
  const PetscInt i0 = StencilLagsOf(p.vectors, p.source[0], 0, response, source, &wx) + cells[0];
  const PetscInt j0 = cells[1] + (rows <= 2 * LANES ? StencilLagsOf(2, p.source[1], 1, response, source, &wy)
                                                    : StencilLagsOf(3, p.source[1], 1, response, source, &wy));
  const PetscReal *row = t.value + j0 * t.width + i0;
  Lanes line[3] = {{0}, {0}, {0}}, sum = {0};
  for (PetscInt j = 0; j < rows; j++, row += t.width)
    for (int q = 0; q < p.vectors; q++) line[q] += wy.weight[j] * LanesAt(row + q * LANES);
  for (int q = 0; q < p.vectors; q++) sum += wx.lanes[q] * line[q];
  return LanesSum(sum);
}

/* A double sum of stencils whose numbers of points the compiler knows. */
#define FIXED_SUM(rx, ry, sx, sy, ...)                                                                                 \
  StencilSum((StencilPoints){((rx) + (sx) + LANES - 2) / LANES, {rx, ry}, {sx, sy}}, __VA_ARGS__)

/* The double sum of stencils of any points. */
static inline PetscReal AnySum(TableMiddle t, const PaddedStencil *a, const PaddedStencil *b, const PetscInt cells[2]) {
  const StencilPoints p = {2, {a->n[0], a->n[1]}, {b->n[0], b->n[1]}};
  const StencilPoints wide = {3, {a->n[0], a->n[1]}, {b->n[0], b->n[1]}};
  return a->n[0] + b->n[0] - 1 <= 2 * LANES ? StencilSum(p, t, a, b, cells) : StencilSum(wide, t, a, b, cells);
}

void StencilDipoleSums(const OffsetTable table[2], const PaddedStencil response[2], const PaddedStencil dipole[3],
                       const PetscInt cells[2], PetscReal sum[2][3]) {
  const PaddedStencil *u = &response[0], *v = &response[1];
  sum[0][0] = FIXED_SUM(5, 4, 6, 4, TableMiddleOf(&table[0], 0), u, &dipole[0], cells);
  sum[0][1] = FIXED_SUM(5, 4, 4, 6, TableMiddleOf(&table[0], 1), u, &dipole[1], cells);
  sum[0][2] = FIXED_SUM(5, 4, 5, 5, TableMiddleOf(&table[0], 2), u, &dipole[2], cells);
  sum[1][0] = FIXED_SUM(4, 5, 6, 4, TableMiddleOf(&table[1], 0), v, &dipole[0], cells);
  sum[1][1] = FIXED_SUM(4, 5, 4, 6, TableMiddleOf(&table[1], 1), v, &dipole[1], cells);
  sum[1][2] = FIXED_SUM(4, 5, 5, 5, TableMiddleOf(&table[1], 2), v, &dipole[2], cells);
}

void StencilRowAdd(const OffsetEntry *t, const PaddedStencil *response, const PaddedStencil *source, PetscReal factor,
                   PetscInt n, PetscReal sum[]) {
  const TableMiddle middle = TableMiddleOf(t->table, t->block);
  const PetscInt rows = response->n[1] + source->n[1] - 1, lags = response->n[0] + source->n[0] - 1;
  PetscReal line[STENCIL_ROW + 4 * LANES];
  StencilLags wx, wy;
  const PetscInt i0 = StencilLagsOf(3, source->n[0], 0, response, source, &wx) + t->cells[0];
  const PetscInt j0 = StencilLagsOf(3, source->n[1], 1, response, source, &wy) + t->cells[1];
  const PetscReal *value = middle.value + j0 * middle.width + i0;
  for (PetscInt q = 0; q < n + lags - 1; q += LANES) {
    Lanes all = {0};
    for (PetscInt j = 0; j < rows; j++) all += wy.weight[j] * LanesAt(value + j * middle.width + q);
    LanesPut(factor * all, line + q);
  }
  for (PetscInt i = 0; i < n; i += LANES) {
    Lanes all = {0};
    for (PetscInt q = 0; q < lags; q++) all += wx.weight[q] * LanesAt(line + i + q);
    for (PetscInt k = 0; k < PetscMin(LANES, n - i); k++) sum[i + k] += all[k];
  }
}

/* Whether a marker's u and v have the points of cbs54. */
static inline PetscBool HasFixed(const PaddedStencil s[2]) {
  return s[0].n[0] == 5 && s[0].n[1] == 4 && s[1].n[0] == 4 && s[1].n[1] == 5;
}

/* u from v at an offset is v from u the other way round, which is even in the distance of the two: the table of v from
   u one entry to the right and one below. */
void StencilFourSums(const OffsetTable *t, const PaddedStencil a[2], const PaddedStencil b[2], const PetscInt cells[2],
                     PetscReal sum[4]) {
  const TableMiddle uu = TableMiddleOf(t, OFFSET_UU), vv = TableMiddleOf(t, OFFSET_VV),
                    vu = TableMiddleOf(t, OFFSET_VU), uv = {vu.value + 1 - vu.width, vu.width};
  if (HasFixed(a) && HasFixed(b)) {
    sum[0] = FIXED_SUM(5, 4, 5, 4, uu, &a[0], &b[0], cells);
    sum[1] = FIXED_SUM(4, 5, 4, 5, vv, &a[1], &b[1], cells);
    sum[2] = FIXED_SUM(5, 4, 4, 5, uv, &a[0], &b[1], cells);
    sum[3] = FIXED_SUM(4, 5, 5, 4, vu, &a[1], &b[0], cells);
    return;
  }
  sum[0] = AnySum(uu, &a[0], &b[0], cells);
  sum[1] = AnySum(vv, &a[1], &b[1], cells);
  sum[2] = AnySum(uv, &a[0], &b[1], cells);
  sum[3] = AnySum(vu, &a[1], &b[0], cells);
}
