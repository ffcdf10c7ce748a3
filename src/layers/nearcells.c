#include "layers/nearcells.h"
#include "layers/cellrow.h"
#include "layers/latticegreen.h"

/* Distance from a marker up to which a cell is corrected, in cells; and in spacings of markers, whose single forces the
   lattice shows a little farther where they are more than 2 h apart. */
#define CELLS 4
#define SUMMED_CELLS 10 /* from a marker to a cell; beyond, its closed form is right to 1e-5 */
#define SPACINGS 2

/* Coefficients of the velocity of distant markers, as in nearblock.c, of two ends that differ: a kernel, and a cell's
   two faces. */
typedef struct {
  PetscReal a2, a4, a6, b2, b4, b6;
} FarCell;

/* What all cells need, and one vesicle's kernels: component c of marker k at 2k + c, not wrapped into the grid. */
typedef struct {
  const LayerSetting *set;
  const OffsetTable *stokeslet;
  OffsetTable pressure;
  Layer layer;
  PetscInt vesicle;
  FarCell far;
  const PetscReal *X, *F; /* [2n] of the vesicle */
  PaddedStencil *source;  /* [2n] */
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

static void SetStencils(NearCells *s, PetscInt n) {
  const Markers m = s->set->markers;
  for (PetscInt k = 0; k < 2 * n; k++) {
    Stencil stencil;
    for (int dir = 0; dir < 2; dir++) {
      const PetscBool along = k % 2 == dir ? PETSC_TRUE : PETSC_FALSE;
      const PetscReal r = (s->X[k - k % 2 + dir] - m->grid->lo[dir]) / m->grid->h - (along ? 1.0 : 0.5);
      stencil.n[dir] = (along ? m->kernel->along : m->kernel->across)(r, &stencil.first[dir], stencil.weight[dir]);
    }
    StencilPad(&stencil, &s->source[k]);
  }
}

static void TakeLattice(void *context, PetscInt k, const PetscInt cell[2], PetscInt n, PetscReal *const sum[3]) {
  static const PetscInt none[2] = {0, 0}, turned[2] = {1, -1}; /* u of a force along y: StencilFourSums */
  const NearCells *s = (const NearCells *)context;
  const PaddedStencil *source = &s->source[2 * k];
  const PetscReal *F = &s->F[2 * k], h = s->set->markers->grid->h, nu = s->set->nu;
  PaddedStencil weights[3];
  for (int f = 0; f < 3; f++) CellStencil((Field)f, cell, &weights[f]);
  StencilRowAdd(s->stokeslet, OFFSET_UU, &weights[0], &source[0], none, -F[0] / nu, n, sum[0]);
  StencilRowAdd(s->stokeslet, OFFSET_VU, &weights[0], &source[1], turned, -F[1] / nu, n, sum[0]);
  StencilRowAdd(s->stokeslet, OFFSET_VU, &weights[1], &source[0], none, -F[0] / nu, n, sum[1]);
  StencilRowAdd(s->stokeslet, OFFSET_VV, &weights[1], &source[1], none, -F[1] / nu, n, sum[1]);
  StencilRowAdd(&s->pressure, OFFSET_UU, &weights[2], &source[0], none, -F[0] / h, n, sum[2]);
  StencilRowAdd(&s->pressure, OFFSET_VV, &weights[2], &source[1], none, -F[1] / h, n, sum[2]);
}

/* What the lattice has of four distant markers, (x, y) from them to the cell, with forces (f, g): the Stokeslet, and
   the closed form of its difference. */
static void TakeFar(const NearCells *s, Lanes x, Lanes y, Lanes f, Lanes g, Lanes sum[3]) {
  const FarCell *far = &s->far;
  const PetscReal h = s->set->markers->grid->h, nu = s->set->nu;
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

/* The exact layer, less the lattice's of all markers that are not near the cell. */
static void Exact(void *context, const CellRow *row, PetscInt i, const PetscReal at[2], PetscBool corrected,
                  PetscInt cell, PetscReal found[3]) {
  const NearCells *s = (const NearCells *)context;
  Lanes sum[3] = {{0}, {0}, {0}}, four[3];
  if (!corrected) return;
  LayerAdd(s->layer, s->vesicle, at, found, &found[2]);
  for (PetscInt k = 0; k < row->n && !row->grid->free; k += LANES) {
    Lanes x, y, f, g;
    LanesPairs(s->X + 2 * k, &x, &y);
    LanesPairs(s->F + 2 * k, &f, &g);
    const LanesBits far = CellRowDistant(row, k, i);
    TakeFar(s, at[0] - x, at[1] - y, f, g, four);
    for (int q = 0; q < 3; q++) sum[q] += LanesWhere(far, four[q]);
  }
  for (int q = 0; q < 3; q++) found[q] += LanesSum(sum[q]);
}

PetscErrorCode NearCellsCorrect(const LayerSetting *set, const OffsetTable *lattice, Layer layer,
                                PetscReal *const field[3]) {
  const Layout l = layer->layout;
  const Grid g = set->markers->grid;
  NearCells s = {.set = set, .stokeslet = lattice, .layer = layer, .far = FarCoefficients(set->markers->kernel)};
  const CellLayer of = {&s, SUMMED_CELLS, TakeLattice, Exact};
  PetscFunctionBeginUser;
  if (!g->free) PetscCall(LatticePressure(SUMMED_CELLS + OFFSET_LAGS, &s.pressure));
  PetscCall(PetscMalloc1(2 * l->M, &s.source));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscReal reach = PetscMax(CELLS * g->h, SPACINGS * set->bodies->membrane->ds[v]);
    CellRow row;
    s.vesicle = v;
    s.X = layer->X + 2 * l->start[v];
    s.F = layer->F + 2 * l->start[v];
    if (!CellRowBegin(g, LayoutCount(l, v), s.X, reach, &row)) continue;
    PetscCall(LayerUse(layer, v));
    SetStencils(&s, row.n);
    PetscCall(CellRowCorrect(&row, &of, field));
  }
  PetscCall(PetscFree(s.source));
  PetscCall(OffsetTableDestroy(&s.pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
