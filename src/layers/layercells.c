#include "layers/layercells.h"
#include "layers/cellrow.h"
#include "layers/curvelayer.h"
#include "layers/layerpairs.h"
#include "layers/latticegreen.h"

/* Distance from a marker up to which a cell is corrected, in cells; and in spacings of markers, whose single forces the
   lattice shows a little farther where they are more than 2 h apart. */
#define CELLS 4
#define SPACINGS 2
#define SUMMED_SINGLE 10 /* cells from a marker to a cell; beyond, the closed form is right to 1e-5 */
#define SUMMED_DOUBLE 20 /* beyond, what the lattice lacks is left out, 5e-4 of h^2/r^2 J */

/* Coefficients of the velocity of distant markers, as in farform.h, of two ends that differ: a kernel, and a cell's two
   faces. */
typedef struct {
  PetscReal a2, a4, a6, b2, b4, b6;
} FarCell;

/* What all cells need, and one vesicle's sources, of which each marker has as many as the kernel: components of a force
   or parts of a dipole. */
typedef struct _LayerCells {
  const LayerSetting *set;
  const PairKernel *kernel;
  OffsetEntry answer[3][DIPOLE_COUNT]; /* of the lattice's u, v and p by source */
  PetscReal scale[3];                  /* of u, v, p in the tables */
  PetscInt summed;                     /* cells from a marker to a cell up to which stencils are summed */
  const FarCell *far;                  /* the closed form beyond; NULL: the kernel itself */
  PetscErrorCode (*find)(struct _LayerCells *cells, PetscInt v, PetscInt n); /* the sources of n markers of vesicle v */
  CurveLayer curve;
  PetscReal ratio, level[2]; /* level: what the unit of lengths adds to the velocity of all sources */
  const PetscReal *X;        /* [2n] and whole vectors, as the next two */
  PetscReal *density;        /* [2n] forces, or jumps */
  PetscReal *normal;         /* [2n] n w, zero of forces */
  PetscReal *strength;       /* [sources n] */
  PaddedStencil *stencil;    /* [sources n], not wrapped into the grid */
  PetscReal *over;           /* [cells] 1/ratio inside vesicles, else 1; NULL: no contrast */
} LayerCells;

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

/* The lattice's pressure at a cell of a dipole's force -DIV T and of its source, which is 1/2 in the own cell of xx and
   yy. Entry (i, j) of a face is right of (u) or above (v) cell (i, j). */
static PetscErrorCode DipolePressure(PetscInt reach, OffsetTable *t) {
  const PetscInt size[2] = {reach, reach};
  OffsetTable p;
  PetscFunctionBeginUser;
  PetscCall(LatticePressure(reach + 2, &p));
  PetscCall(OffsetTableCreate(size, t));
  for (PetscInt j = -reach; j <= reach; j++)
    for (PetscInt i = -reach; i <= reach; i++) {
      const PetscInt at = (j + reach) * (2 * reach + 1) + i + reach;
      const PetscReal own = !i && !j ? 0.5 : 0;
      t->value[DIPOLE_XX][at] = OffsetAt(&p, OFFSET_UU, i, j) - OffsetAt(&p, OFFSET_UU, i + 1, j) + own;
      t->value[DIPOLE_YY][at] = OffsetAt(&p, OFFSET_VV, i, j) - OffsetAt(&p, OFFSET_VV, i, j + 1) + own;
      t->value[DIPOLE_XY][at] = OffsetAt(&p, OFFSET_UU, i, j - 1) - OffsetAt(&p, OFFSET_UU, i, j) +
                                OffsetAt(&p, OFFSET_VV, i - 1, j) - OffsetAt(&p, OFFSET_VV, i, j);
    }
  PetscCall(OffsetTableDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void LayerCellsLattice(void *context, PetscInt k, const PetscInt cell[2], PetscInt n, PetscReal *const sum[3]) {
  const LayerCells *s = (const LayerCells *)context;
  for (int c = 0; c < 3; c++) {
    PaddedStencil weights;
    CellStencil((Field)c, cell, &weights);
    for (int q = 0; q < s->kernel->sources; q++) {
      const PetscInt source = s->kernel->sources * k + q;
      StencilRowAdd(&s->answer[c][q], &weights, &s->stencil[source], -s->scale[c] * s->strength[source], n, sum[c]);
    }
  }
}

/* Minus what the lattice has of four distant markers, (x, y) from them to the cell, with densities F: the kernel
   itself, and the closed form of its difference, but for h^2/r^3 of the pressure. */
static void LayerCellsFar(const LayerCells *s, Lanes x, Lanes y, const Lanes N[2], const Lanes F[2], Lanes sum[3]) {
  const FarCell *far = s->far;
  const PetscReal h = s->set->markers->grid->h, nu = s->set->nu;
  Lanes K[3], P[2];
  PairFree(s->kernel, s->set, x, y, N, K);
  s->kernel->pressure(x, y, N, P);
  sum[0] = -K[0] * F[0] - K[2] * F[1];
  sum[1] = -K[2] * F[0] - K[1] * F[1];
  sum[2] = -PetscPowRealInt(nu, s->kernel->viscosity + 1) * (P[0] * F[0] + P[1] * F[1]);
  if (!far) return;
  const Lanes over = 1 / (x * x + y * y), c2 = (x * x - y * y) * over, s2 = 2 * x * y * over;
  const Lanes c4 = c2 * c2 - s2 * s2, s4 = 2 * c2 * s2, c6 = c4 * c2 - s4 * s2, s6 = s4 * c2 + c4 * s2;
  const Lanes factor = h * h / (2 * PETSC_PI * nu) * over, even = 4 * far->a4 * c4,
              odd = 2 * far->a2 * c2 + 6 * far->a6 * c6, both = -2 * far->b2 * s2 - 6 * far->b6 * s6,
              ends = 4 * far->b4 * s4;
  sum[0] += factor * ((even - odd) * F[0] + (both + ends) * F[1]);
  sum[1] += factor * ((both - ends) * F[0] + (even + odd) * F[1]);
}

/* The exact layer, less the lattice's of all markers that are not near the cell; and which cells are inside. */
static void LayerCellsExact(void *context, const CellRow *row, PetscInt i, const PetscReal at[2], PetscBool corrected,
                            PetscInt cell, PetscReal found[3]) {
  const LayerCells *s = (const LayerCells *)context;
  PetscBool inside = PETSC_FALSE;
  Lanes sum[3] = {{0}, {0}, {0}};
  if (corrected) {
    CurveLayerAdd(s->curve, at, found, &found[2], &inside);
    for (int c = 0; c < 2; c++) found[c] += s->level[c];
  } else if (s->over)
    inside = CurveLayerContains(s->curve, at);
  if (inside && s->over) s->over[cell] = 1 / s->ratio;
  for (PetscInt k = 0; k < row->n && corrected && !row->grid->free; k += LANES) {
    const LanesBits far = CellRowDistant(row, k, i);
    Lanes x, y, N[2], F[2], four[3];
    LanesPairs(s->X + 2 * k, &x, &y);
    LanesPairs(s->normal + 2 * k, &N[0], &N[1]);
    LanesPairs(s->density + 2 * k, &F[0], &F[1]);
    LayerCellsFar(s, at[0] - x, at[1] - y, N, F, four);
    for (int c = 0; c < 3; c++) sum[c] += LanesWhere(far, four[c]);
  }
  for (int c = 0; c < 3; c++) found[c] += LanesSum(sum[c]);
}

/* The forces on the markers. */
static PetscErrorCode SingleSources(LayerCells *s, PetscInt v, PetscInt n) {
  const Markers m = s->set->markers;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * n; k++) {
    Stencil stencil;
    for (int dir = 0; dir < 2; dir++) {
      const PetscBool along = k % 2 == dir;
      const PetscReal r = (s->X[k - k % 2 + dir] - m->grid->lo[dir]) / m->grid->h - (along ? 1.0 : 0.5);
      stencil.n[dir] = (along ? m->kernel->along : m->kernel->across)(r, &stencil.first[dir], stencil.weight[dir]);
    }
    StencilPad(&stencil, &s->stencil[k]);
    s->strength[k] = s->density[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The dipoles of the jumps at the markers. */
static PetscErrorCode DoubleSources(LayerCells *s, PetscInt v, PetscInt n) {
  const PetscReal *J = s->density, *normal = s->normal;
  PetscReal *along;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &along));
  PetscCall(DoubleGeometry(s->set->bodies->spectral[v], n, s->X, s->normal, along));
  for (PetscInt k = 0; k < n; k++) {
    PetscReal *T = s->strength + DIPOLE_COUNT * k;
    Stencil part[DIPOLE_COUNT];
    T[DIPOLE_XX] = 2 * J[2 * k] * normal[2 * k];
    T[DIPOLE_YY] = 2 * J[2 * k + 1] * normal[2 * k + 1];
    T[DIPOLE_XY] = J[2 * k] * normal[2 * k + 1] + J[2 * k + 1] * normal[2 * k];
    DipoleStencilsUnwrapped(s->set->markers->grid, s->X + 2 * k, part);
    for (int c = 0; c < DIPOLE_COUNT; c++) StencilPad(&part[c], &s->stencil[DIPOLE_COUNT * k + c]);
  }
  PetscCall(PetscFree(along));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All bodies of a layout, but for vesicles of ratio 1 where there are ratios: density[2n] forces, or velocities of the
   markers. */
static PetscErrorCode LayerCellsCorrect(LayerCells *s, Layout l, const PetscReal ratio[], Vec density, Vec X,
                                        PetscReal *const field[3]) {
  const Grid g = s->set->markers->grid;
  const CellLayer of = {s, s->summed, LayerCellsLattice, LayerCellsExact};
  const int sources = s->kernel->sources;
  PetscReal *x, *all;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(2 * (l->M + LANES), &x, 2 * (l->M + LANES), &all, 2 * (l->M + LANES), &s->normal));
  PetscCall(PetscCalloc2(sources * l->M, &s->strength, sources * l->M, &s->stencil));
  PetscCall(LayoutGatherVec(l, X, x));
  PetscCall(LayoutGatherVec(l, density, all));
  for (PetscInt v = 0; v < l->bodies; v++) {
    CellRow row;
    s->X = x + 2 * l->start[v];
    s->density = all + 2 * l->start[v];
    if (ratio && ratio[v] == 1) continue;
    if (!CellRowBegin(g, LayoutCount(l, v), s->X, PetscMax(CELLS * g->h, SPACINGS * s->set->bodies->ds[v]), &row))
      continue;
    s->ratio = ratio ? ratio[v] : 1;
    for (PetscInt k = 0; k < 2 * row.n && ratio; k++) s->density[k] *= 1 - ratio[v];
    s->level[0] = s->level[1] = 0; /* CurveLayer has lengths as they are, pairs and lattice in the unit */
    for (PetscInt k = 0; k < 2 * row.n && !g->free; k++)
      s->level[k % 2] += s->kernel->level * PetscLogReal(s->set->unit) / s->set->nu * s->density[k];
    PetscCall(s->find(s, v, row.n));
    PetscCall(CurveLayerCreate(s->kernel, row.n, s->set->nu, s->X, s->density, &s->curve));
    PetscCall(CellRowCorrect(&row, &of, field));
    PetscCall(CurveLayerDestroy(&s->curve));
  }
  PetscCall(PetscFree2(s->strength, s->stencil));
  PetscCall(PetscFree3(x, all, s->normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SingleCellsCorrect(const LayerSetting *set, const OffsetTable *lattice, Layout layout, Vec F, Vec X,
                                  PetscReal *const field[3]) {
  const Grid g = set->markers->grid;
  const FarCell far = FarCoefficients(set->markers->kernel);
  OffsetTable pressure = {0};
  LayerCells s = {.set = set,
                  .kernel = &stokeslet,
                  .summed = SUMMED_SINGLE,
                  .far = &far,
                  .find = SingleSources,
                  .answer = {{{lattice, OFFSET_UU, {0, 0}}, {lattice, OFFSET_VU, {1, -1}}}, /* StencilFourSums */
                             {{lattice, OFFSET_VU, {0, 0}}, {lattice, OFFSET_VV, {0, 0}}},
                             {{&pressure, OFFSET_UU, {0, 0}}, {&pressure, OFFSET_VV, {0, 0}}}},
                  .scale = {1 / set->nu, 1 / set->nu, 1 / g->h}};
  PetscFunctionBeginUser;
  if (!g->free) PetscCall(LatticePressure(SUMMED_SINGLE + OFFSET_LAGS, &pressure));
  PetscCall(LayerCellsCorrect(&s, layout, NULL, F, X, field));
  PetscCall(OffsetTableDestroy(&pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCellsCorrect(const LayerSetting *set, const OffsetTable lattice[2], const PetscReal ratio[], Vec U,
                                  Vec X, PetscReal *const field[3]) {
  const Grid g = set->markers->grid;
  const PetscInt cells = g->n[0] * g->rows[FIELD_P];
  OffsetTable pressure = {0};
  LayerCells s = {.set = set,
                  .kernel = &stresslet,
                  .summed = SUMMED_DOUBLE,
                  .find = DoubleSources,
                  .scale = {1 / g->h, 1 / g->h, set->nu / (g->h * g->h)}};
  PetscFunctionBeginUser;
  for (int c = 0; c < 3; c++)
    for (int q = 0; q < DIPOLE_COUNT; q++) {
      s.answer[c][q].table = c < 2 ? &lattice[c] : &pressure;
      s.answer[c][q].block = (OffsetBlock)q;
    }
  if (!g->free) PetscCall(DipolePressure(SUMMED_DOUBLE + OFFSET_LAGS, &pressure));
  PetscCall(PetscMalloc1(cells, &s.over));
  for (PetscInt k = 0; k < cells; k++) s.over[k] = 1;
  PetscCall(LayerCellsCorrect(&s, set->bodies->membrane->layout, ratio, U, X, field));
  for (int f = 0; f < 2; f++)
    for (PetscInt k = 0; k < cells && field[f]; k++) field[f][k] *= s.over[k];
  PetscCall(PetscFree(s.over));
  PetscCall(OffsetTableDestroy(&pressure));
  PetscFunctionReturn(PETSC_SUCCESS);
}
