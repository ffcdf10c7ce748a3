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

/* SUM w_i (i - SUM w_j j)^4 of the weights a, b. */
static inline PetscReal FourthMoment(Lanes a, Lanes b) {
  const Lanes low = {0, 1, 2, 3}, high = low + LANES;
  const PetscReal place = LanesSum(a * low + b * high);
  const Lanes x = (low - place) * (low - place), y = (high - place) * (high - place);
  return LanesSum(a * x * x + b * y * y);
}

/* Six weights between six zeros on either side. */
void StencilPad(const Stencil *s, PaddedStencil *p) {
  for (int dir = 0; dir < 2; dir++) {
    PetscReal *w = p->weight[dir];
    Lanes weight[2] = {{0}, {0}};
    for (int i = 0; i < KERNEL_MAX_POINTS; i++) weight[i / LANES][i % LANES] = i < s->n[dir] ? s->weight[dir][i] : 0;
    for (int i = 0; i < 3 * KERNEL_MAX_POINTS - LANES; i += LANES) LanesPut((Lanes){0}, w + i);
    LanesPut((Lanes){0}, w + 3 * KERNEL_MAX_POINTS - LANES);
    for (int q = 0; q < 2; q++) LanesPut(weight[q], w + KERNEL_MAX_POINTS + LANES * q);
    p->fourth[dir] = FourthMoment(weight[0], weight[1]);
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

/* Weights of the lags that two stencils have, from the least one on, which is returned; zeros up to the last vector's
   end. */
static inline PetscInt Lags(const int vectors, int dir, const PaddedStencil *response, const PaddedStencil *source,
                            Lanes weight[]) {
  const PetscInt n = source->n[dir];
  const PetscReal *a = response->weight[dir] + KERNEL_MAX_POINTS + 1 - n, *b = source->weight[dir] + KERNEL_MAX_POINTS;
  for (int q = 0; q < vectors; q++) weight[q] = b[0] * LanesAt(a + q * LANES);
  for (PetscInt j = 1; j < n; j++)
    for (int q = 0; q < vectors; q++) weight[q] += b[j] * LanesAt(a + j + q * LANES);
  return response->first[dir] - source->first[dir] - (n - 1);
}

/* The double sum of a table whose middle is at `value`, with a row's lags in so many vectors. */
static inline PetscReal RowSum(const int vectors, const PetscReal *value, PetscInt width, const PaddedStencil *response,
                               const PaddedStencil *source, const PetscInt cells[2]) {
  Lanes wx[3], line[3];
  union {
    Lanes lanes[3];
    PetscReal weight[3 * LANES];
  } wy;
  const PetscInt rows = response->n[1] + source->n[1] - 1, i0 = Lags(vectors, 0, response, source, wx) + cells[0];
  const PetscInt j0 = cells[1] + (rows <= 2 * LANES ? Lags(2, 1, response, source, wy.lanes)
                                                    : Lags(3, 1, response, source, wy.lanes));
  const PetscReal *row = value + j0 * width + i0;
  for (int q = 0; q < vectors; q++) line[q] = wy.weight[0] * LanesAt(row + q * LANES);
  for (PetscInt j = 1; j < rows; j++) {
    row += width;
    for (int q = 0; q < vectors; q++) line[q] += wy.weight[j] * LanesAt(row + q * LANES);
  }
  line[0] *= wx[0];
  for (int q = 1; q < vectors; q++) line[0] += wx[q] * line[q];
  return LanesSum(line[0]);
}

/* Of one component of a to one of b. */
static inline PetscReal TableSum(const PetscReal *value, PetscInt width, const PaddedStencil *a, const PaddedStencil *b,
                                 const PetscInt cells[2]) {
  return a->n[0] + b->n[0] - 1 <= 2 * LANES ? RowSum(2, value, width, a, b, cells)
                                            : RowSum(3, value, width, a, b, cells);
}

/* The double sum of stencils whose numbers of points are known to the compiler: r and s along x and y. */
static inline PetscReal FixedSum(const int rx, const int ry, const int sx, const int sy, const PetscReal *value,
                                 PetscInt width, const PaddedStencil *response, const PaddedStencil *source,
                                 const PetscInt cells[2]) {
  const int vectors = (rx + sx - 1 + LANES - 1) / LANES, rows = ry + sy - 1;
  const PetscReal *ax = response->weight[0] + KERNEL_MAX_POINTS + 1 - sx, *bx = source->weight[0] + KERNEL_MAX_POINTS;
  const PetscReal *ay = response->weight[1] + KERNEL_MAX_POINTS + 1 - sy, *by = source->weight[1] + KERNEL_MAX_POINTS;
  const PetscInt i0 = response->first[0] - source->first[0] - (sx - 1) + cells[0];
  const PetscInt j0 = response->first[1] - source->first[1] - (sy - 1) + cells[1];
  const PetscReal *row = value + j0 * width + i0;
  Lanes line[3] = {{0}, {0}, {0}}, sum = {0};
  union {
    Lanes lanes[3];
    PetscReal weight[3 * LANES];
  } wy;
  for (int q = 0; q < (rows + LANES - 1) / LANES; q++) {
    wy.lanes[q] = by[0] * LanesAt(ay + q * LANES);
    for (int j = 1; j < sy; j++) wy.lanes[q] += by[j] * LanesAt(ay + j + q * LANES);
  }
  for (int j = 0; j < rows; j++, row += width)
    for (int q = 0; q < vectors; q++) line[q] += wy.weight[j] * LanesAt(row + q * LANES);
  for (int q = 0; q < vectors; q++) {
    Lanes wx = bx[0] * LanesAt(ax + q * LANES);
    for (int j = 1; j < sx; j++) wx += bx[j] * LanesAt(ax + j + q * LANES);
    sum += wx * line[q];
  }
  return LanesSum(sum);
}

void StencilDipoleSums(const OffsetTable table[2], const PaddedStencil response[2], const PaddedStencil dipole[3],
                       const PetscInt cells[2], PetscReal sum[2][3]) {
  const PetscInt width = 2 * table[0].size[0] + 1, middle = table[0].size[1] * width + table[0].size[0];
  const PetscReal *t[2][3];
  for (int c = 0; c < 2; c++)
    for (int k = 0; k < 3; k++) t[c][k] = table[c].value[k] + middle;
  sum[0][0] = FixedSum(5, 4, 6, 4, t[0][0], width, &response[0], &dipole[0], cells);
  sum[0][1] = FixedSum(5, 4, 4, 6, t[0][1], width, &response[0], &dipole[1], cells);
  sum[0][2] = FixedSum(5, 4, 5, 5, t[0][2], width, &response[0], &dipole[2], cells);
  sum[1][0] = FixedSum(4, 5, 6, 4, t[1][0], width, &response[1], &dipole[0], cells);
  sum[1][1] = FixedSum(4, 5, 4, 6, t[1][1], width, &response[1], &dipole[1], cells);
  sum[1][2] = FixedSum(4, 5, 5, 5, t[1][2], width, &response[1], &dipole[2], cells);
}

void StencilRowAdd(const OffsetTable *t, OffsetBlock b, const PaddedStencil *response, const PaddedStencil *source,
                   const PetscInt cells[2], PetscReal factor, PetscInt n, PetscReal sum[]) {
  const PetscInt width = 2 * t->size[0] + 1, rows = response->n[1] + source->n[1] - 1;
  const PetscInt lags = response->n[0] + source->n[0] - 1;
  PetscReal line[STENCIL_ROW + 4 * LANES];
  union {
    Lanes lanes[3];
    PetscReal weight[3 * LANES];
  } wx, wy;
  const PetscInt i0 = Lags(3, 0, response, source, wx.lanes) + cells[0];
  const PetscInt j0 = Lags(3, 1, response, source, wy.lanes) + cells[1];
  const PetscReal *value = t->value[b] + (t->size[1] + j0) * width + t->size[0] + i0;
  for (PetscInt q = 0; q < n + lags - 1; q += LANES) {
    Lanes all = {0};
    for (PetscInt j = 0; j < rows; j++) all += wy.weight[j] * LanesAt(value + j * width + q);
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
  return s[0].n[0] == 5 && s[0].n[1] == 4 && s[1].n[0] == 4 && s[1].n[1] == 5 ? PETSC_TRUE : PETSC_FALSE;
}

/* u from v at an offset is v from u the other way round, which is even in the distance of the two: the table of v from
   u one entry to the right and one below. */
void StencilFourSums(const OffsetTable *t, const PaddedStencil a[2], const PaddedStencil b[2], const PetscInt cells[2],
                     PetscReal sum[4]) {
  const PetscInt width = 2 * t->size[0] + 1, middle = t->size[1] * width + t->size[0];
  if (HasFixed(a) && HasFixed(b)) {
    sum[0] = FixedSum(5, 4, 5, 4, t->value[OFFSET_UU] + middle, width, &a[0], &b[0], cells);
    sum[1] = FixedSum(4, 5, 4, 5, t->value[OFFSET_VV] + middle, width, &a[1], &b[1], cells);
    sum[2] = FixedSum(5, 4, 4, 5, t->value[OFFSET_VU] + middle + 1 - width, width, &a[0], &b[1], cells);
    sum[3] = FixedSum(4, 5, 5, 4, t->value[OFFSET_VU] + middle, width, &a[1], &b[0], cells);
    return;
  }
  sum[0] = TableSum(t->value[OFFSET_UU] + middle, width, &a[0], &b[0], cells);
  sum[1] = TableSum(t->value[OFFSET_VV] + middle, width, &a[1], &b[1], cells);
  sum[2] = TableSum(t->value[OFFSET_VU] + middle + 1 - width, width, &a[0], &b[1], cells);
  sum[3] = TableSum(t->value[OFFSET_VU] + middle, width, &a[1], &b[0], cells);
}
