#include "coupling/nearcells.h"
#include "base/lanes.h"
#include "coupling/cellrow.h"
#include "coupling/layer.h"
#include "coupling/nearblock.h"

/* Distance from a marker up to which a cell is corrected, in cells; and in spacings of markers, whose single forces the
   lattice shows a little farther where they are more than 2 h apart. */
#define CELLS 4
#define SUMMED_CELLS                                                                                                   \
  10 /* from a marker to a cell; beyond, its closed form is right to 1e-5. Less than STENCIL_ROW/2                     \
      */
#define SPACINGS 2

/* Coefficients of the velocity of distant markers, as in nearblock.c, of two ends that differ: a kernel, and a cell's
   two faces. */
typedef struct {
  PetscReal a2, a4, a6, b2, b4, b6;
} FarCell;

/* What all cells need, and one vesicle's kernels: component c of marker k at 2k + c, not wrapped into the grid. */
typedef struct {
  Coupling coupling;
  Layer layer;
  OffsetTable pressure;
  PetscInt vesicle, n;
  FarCell far;
  PetscReal reach;        /* of the correction (length) */
  const PetscReal *X, *F; /* [2n] of the vesicle */
  PaddedStencil *source;  /* [2n] */
  CellRow row;            /* the cells under way */
} NearCells;

/* Second moments along and across are averaged over both ends where one component meets itself; from one to the other
   those of x and of y, p and q, are not the same, which gives b4. The mean of two faces has 1/4 along and none across.
 */
static FarCell FarCoefficients(const Kernel *kernel) {
  const PetscReal along = KernelSecondMoment(kernel->along), across = KernelSecondMoment(kernel->across);
  const PetscReal a = 0.5 * (along + 0.25), c = 0.5 * across + 1. / 12, p = 0.25 + across, q = along;
  return (FarCell){.a2 = -c / 2 + 3.5 / 48,
                   .a4 = -a / 8 + c / 8 - 1. / 48,
                   .a6 = 1. / 96,
                   .b2 = -(p + q) / 8 + 1. / 32,
                   .b4 = -(p - q) / 16,
                   .b6 = 1. / 96};
}

static void SetVesicle(NearCells *s, PetscInt v) {
  const Markers m = s->coupling->markers;
  const Layout l = m->layout;
  s->vesicle = v;
  s->n = LayoutCount(l, v);
  s->reach = PetscMax(CELLS * m->grid->h, SPACINGS * s->coupling->membrane->ds[v]);
  s->X = s->layer->X + 2 * l->start[v];
  s->F = s->layer->F + 2 * l->start[v];
}

static void SetStencils(NearCells *s) {
  const Markers m = s->coupling->markers;
  for (PetscInt k = 0; k < 2 * s->n; k++) {
    Stencil stencil;
    for (int dir = 0; dir < 2; dir++) {
      const PetscBool along = k % 2 == dir ? PETSC_TRUE : PETSC_FALSE;
      const PetscReal r = (s->X[k - k % 2 + dir] - m->grid->lo[dir]) / m->grid->h - (along ? 1.0 : 0.5);
      stencil.n[dir] = (along ? m->kernel->along : m->kernel->across)(r, &stencil.first[dir], stencil.weight[dir]);
    }
    StencilPad(&stencil, &s->source[k]);
  }
}

/* Velocity and pressure of marker k on the lattice, taken off those of `n` cells of a row from cell[0] on. */
static void TakeLattice(NearCells *s, PetscInt k, const PetscInt cell[2], PetscInt n) {
  static const PetscInt none[2] = {0, 0}, turned[2] = {1, -1}; /* u of a force along y: StencilFourSums */
  const OffsetTable *t = &s->coupling->near->lattice;
  const PaddedStencil *source = &s->source[2 * k];
  const PetscReal *F = &s->F[2 * k], h = s->coupling->fluid->grid->h, nu = s->coupling->fluid->nu;
  PetscReal *at[3];
  PaddedStencil weights[3];
  for (int f = 0; f < 3; f++) {
    CellStencil((Field)f, cell, &weights[f]);
    at[f] = s->row.sum[f] + cell[0] - s->row.from;
  }
  StencilRowAdd(t, OFFSET_UU, &weights[0], &source[0], none, -F[0] / nu, n, at[0]);
  StencilRowAdd(t, OFFSET_VU, &weights[0], &source[1], turned, -F[1] / nu, n, at[0]);
  StencilRowAdd(t, OFFSET_VU, &weights[1], &source[0], none, -F[0] / nu, n, at[1]);
  StencilRowAdd(t, OFFSET_VV, &weights[1], &source[1], none, -F[1] / nu, n, at[1]);
  StencilRowAdd(&s->pressure, OFFSET_UU, &weights[2], &source[0], none, -F[0] / h, n, at[2]);
  StencilRowAdd(&s->pressure, OFFSET_VV, &weights[2], &source[1], none, -F[1] / h, n, at[2]);
}

/* The same of four distant markers, (x, y) from them to the cell, with forces (f, g): the Stokeslet, and the closed
   form of its difference. */
static void TakeFar(const NearCells *s, Lanes x, Lanes y, Lanes f, Lanes g, Lanes sum[3]) {
  const FarCell *far = &s->far;
  const PetscReal h = s->coupling->fluid->grid->h, nu = s->coupling->fluid->nu;
  const Lanes r2 = x * x + y * y, over = 1 / r2, along = (x * f + y * g) * over,
              logarithm = 0.5 * LanesLog(r2 * (1 / (h * h)));
  const Lanes c2 = (x * x - y * y) * over, s2 = 2 * x * y * over, c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2,
              c6 = c4 * c2 - s4 * s2, s6 = s4 * c2 + c4 * s2;
  const Lanes factor = h * h / (2 * PETSC_PI * nu) * over, even = 4 * far->a4 * c4,
              odd = 2 * far->a2 * c2 + 6 * far->a6 * c6, both = -2 * far->b2 * s2 - 6 * far->b6 * s6,
              ends = 4 * far->b4 * s4;
  const PetscReal single = 1 / (4 * PETSC_PI * nu);
  sum[0] = factor * ((even - odd) * f + (both + ends) * g) - single * (x * along - logarithm * f);
  sum[1] = factor * ((both - ends) * f + (even + odd) * g) - single * (y * along - logarithm * g);
  sum[2] = along * (-1 / (2 * PETSC_PI)); /* but for h^2/r^3 */
}

/* All markers of the vesicle that are not near cell i of the row. */
static void TakeDistant(const NearCells *s, PetscInt i, const PetscReal at[2], PetscReal u[2], PetscReal *p) {
  Lanes sum[3] = {{0}, {0}, {0}}, four[3];
  for (PetscInt k = 0; k < s->n; k += LANES) {
    Lanes x, y, f, g;
    LanesPairs(s->X + 2 * k, &x, &y);
    LanesPairs(s->F + 2 * k, &f, &g);
    const LanesBits far = CellRowDistant(&s->row, s->n, k, i);
    TakeFar(s, at[0] - x, at[1] - y, f, g, four);
    for (int q = 0; q < 3; q++) sum[q] += LanesWhere(far, four[q]);
  }
  for (int c = 0; c < 2; c++) u[c] += LanesSum(sum[c]);
  *p += LanesSum(sum[2]);
}

/* The exact layer less the lattice's at the centre x of cell i of the row. */
static void Difference(const NearCells *s, PetscInt i, const PetscReal x[2], PetscReal found[3]) {
  for (int f = 0; f < 3; f++) found[f] = s->row.sum[f][i - s->row.from];
  LayerAdd(s->layer, s->vesicle, x, found, &found[2]);
  TakeDistant(s, i, x, found, &found[2]);
}

/* Whether the cells of a box, whose indices are not wrapped into the grid, have any in this rank's rows. */
static PetscBool HasOwnRows(Grid g, PetscInt box[2][2]) {
  for (PetscInt cell = box[1][0]; cell <= box[1][1]; cell++) {
    const PetscInt row = ((cell % g->n[1]) + g->n[1]) % g->n[1] - g->first;
    if (row >= 0 && row < g->rows[FIELD_P]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Row j of the cells from box[0] to box[1]; to the fields from `start` on. */
static void CorrectRow(NearCells *s, const PetscInt box[2], PetscInt j, PetscReal *const field[3], PetscInt start) {
  const Grid g = s->coupling->fluid->grid;
  PetscInt cell[2];
  if (!CellRowPlace(&s->row, g, s->n, s->X, s->reach, box, j)) return;
  for (PetscInt k = 0; k < s->n; k++) {
    const PetscInt n = CellRowNear(&s->row, g, k, s->X + 2 * k, SUMMED_CELLS, j, cell);
    if (n) TakeLattice(s, k, cell, n);
  }
  for (PetscInt i = s->row.from; i <= s->row.to; i++) {
    const PetscInt at = start + ((i % g->n[0]) + g->n[0]) % g->n[0];
    PetscReal x[2], found[3];
    GridPosition(g, FIELD_P, i, j, x);
    if (!CellIsNear(s->n, s->X, s->reach, x)) continue;
    Difference(s, i, x, found);
    for (int f = 0; f < 3; f++)
      if (field[f]) field[f][at] += found[f];
  }
}

static PetscErrorCode CorrectVesicle(NearCells *s, PetscInt v, PetscReal *const field[3]) {
  const Grid g = s->coupling->fluid->grid;
  PetscInt box[2][2];
  PetscFunctionBeginUser;
  SetVesicle(s, v);
  CellBox(g, s->n, s->X, s->reach, box);
  if (!HasOwnRows(g, box)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayerUse(s->layer, v));
  SetStencils(s);
  PetscCall(CellRowCreate(s->n, box[0][1] - box[0][0] + 1, &s->row));
  for (PetscInt j = box[1][0]; j <= box[1][1]; j++) {
    const PetscInt row = ((j % g->n[1]) + g->n[1]) % g->n[1] - g->first;
    if (row >= 0 && row < g->rows[FIELD_P]) CorrectRow(s, box[0], j, field, row * g->n[0]);
  }
  PetscCall(CellRowDestroy(&s->row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NearCellsCorrect(Coupling coupling, Vec sigma, Vec X, PetscReal u[], PetscReal v[], PetscReal p[]) {
  const Layout l = coupling->membrane->layout;
  PetscReal *const field[3] = {u, v, p};
  NearCells s = {.coupling = coupling};
  PetscFunctionBeginUser;
  if (!coupling->near || coupling->near->free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(LayerCreate(coupling, sigma, X, &s.layer));
  s.far = FarCoefficients(coupling->markers->kernel);
  PetscCall(LatticePressure(SUMMED_CELLS + OFFSET_LAGS, &s.pressure));
  PetscCall(PetscMalloc1(2 * l->M, &s.source));
  for (PetscInt b = 0; b < l->bodies; b++) PetscCall(CorrectVesicle(&s, b, field));
  PetscCall(PetscFree(s.source));
  PetscCall(OffsetTableDestroy(&s.pressure));
  PetscCall(LayerDestroy(&s.layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}
