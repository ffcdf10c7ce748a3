#include "layers/doublecells.h"
#include "layers/cellrow.h"
#include "layers/doubleblock.h"
#include "layers/doublecurve.h"
#include "layers/latticegreen.h"

#define CELLS 4         /* distance from a marker up to which a cell is corrected, */
#define SPACINGS 2      /* and the same in spacings of the markers */
#define SUMMED_CELLS 20 /* from a marker to a cell: beyond it what the lattice lacks is left out, 5e-4 of h^2/r^2 J */

/* One vesicle, and what all cells need. */
typedef struct {
  const LayerSetting *set;
  OffsetTable table[3]; /* the lattice's dipoles: u, v and p */
  DoubleCurve curve;
  PetscReal ratio;
  const PetscReal *X;    /* [2n] */
  PetscReal *tensor;     /* [DIPOLE_COUNT n]; whole vectors, as X */
  PaddedStencil *dipole; /* [DIPOLE_COUNT n], not wrapped into the grid */
  PetscReal *over;       /* [cells] 1/ratio inside vesicles, else 1 */
} DoubleCells;

/* The lattice's pressure at a cell of a dipole's force -DIV T and of its source, which is 1/2 in the own cell of xx and
   yy. Entry (i, j) of a face is right of (u) or above (v) cell (i, j). */
static PetscErrorCode PressureTable(PetscInt reach, OffsetTable *t) {
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

static void TakeLattice(void *context, PetscInt k, const PetscInt cell[2], PetscInt n, PetscReal *const sum[3]) {
  static const PetscInt none[2] = {0, 0};
  const DoubleCells *s = (const DoubleCells *)context;
  const PetscReal h = s->set->markers->grid->h, scale[3] = {1 / h, 1 / h, s->set->nu / (h * h)};
  for (int c = 0; c < 3; c++) {
    PaddedStencil weights;
    CellStencil((Field)c, cell, &weights);
    for (PetscInt q = DIPOLE_COUNT * k; q < DIPOLE_COUNT * (k + 1); q++)
      StencilRowAdd(&s->table[c], (OffsetBlock)(q % DIPOLE_COUNT), &weights, &s->dipole[q], none,
                    -scale[c] * s->tensor[q], n, sum[c]);
  }
}

/* The double layer, less the lattice's of distant markers, which is the double layer itself; and which cells are
 * inside.
 */
static void Exact(void *context, const CellRow *row, PetscInt i, const PetscReal at[2], PetscBool corrected,
                  PetscInt cell, PetscReal found[3]) {
  const DoubleCells *s = (const DoubleCells *)context;
  PetscBool inside;
  Lanes sum[3] = {{0}, {0}, {0}};
  if (corrected)
    DoubleCurveAdd(s->curve, at, found, &found[2], &inside);
  else
    inside = DoubleCurveContains(s->curve, at);
  if (inside) s->over[cell] = 1 / s->ratio;
  for (PetscInt k = 0; k < row->n && corrected && !row->grid->free; k += LANES) {
    const LanesBits far = CellRowDistant(row, k, i);
    const PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    Lanes x, y, part[DIPOLE_COUNT];
    LanesPairs(s->X + 2 * k, &x, &y);
    for (int c = 0; c < DIPOLE_COUNT; c++)
      part[c] = (Lanes){T[c], T[DIPOLE_COUNT + c], T[2 * DIPOLE_COUNT + c], T[3 * DIPOLE_COUNT + c]};
    x -= at[0];
    y -= at[1];
    const Lanes over = 1 / (x * x + y * y);
    const Lanes through = 0.5 * (part[DIPOLE_XX] * x * x + part[DIPOLE_YY] * y * y) + part[DIPOLE_XY] * x * y;
    const Lanes factor = through * over * over;
    sum[0] += LanesWhere(far, factor * x);
    sum[1] += LanesWhere(far, factor * y);
    sum[2] += LanesWhere(far, 0.5 * (part[DIPOLE_XX] + part[DIPOLE_YY]) * over - 2 * factor);
  }
  for (int c = 0; c < 3; c++) found[c] += (c == 2 ? s->set->nu : 1) / PETSC_PI * LanesSum(sum[c]);
}

/* The curve and the dipoles of vesicle v, of n markers that move with U[2n]. */
static PetscErrorCode SetVesicle(DoubleCells *s, PetscInt v, PetscInt n, const PetscReal U[]) {
  PetscReal *normal, *along, *J;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(2 * n, &normal, n, &along, 2 * n, &J));
  PetscCall(DoubleGeometry(s->set->bodies->spectral[v], n, s->X, normal, along));
  for (PetscInt k = 0; k < 2 * n; k++) J[k] = (1 - s->ratio) * U[k];
  PetscCall(DoubleCurveCreate(n, s->set->nu, s->X, J, &s->curve));
  for (PetscInt k = 0; k < n; k++) {
    PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    Stencil part[DIPOLE_COUNT];
    T[DIPOLE_XX] = 2 * J[2 * k] * normal[2 * k];
    T[DIPOLE_YY] = 2 * J[2 * k + 1] * normal[2 * k + 1];
    T[DIPOLE_XY] = J[2 * k] * normal[2 * k + 1] + J[2 * k + 1] * normal[2 * k];
    DipoleStencilsUnwrapped(s->set->markers->grid, s->X + 2 * k, part);
    for (int c = 0; c < DIPOLE_COUNT; c++) StencilPad(&part[c], &s->dipole[DIPOLE_COUNT * k + c]);
  }
  PetscCall(PetscFree3(normal, along, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCellsCorrect(const LayerSetting *set, const OffsetTable lattice[2], const PetscReal ratio[], Vec U,
                                  Vec X, PetscReal *const field[3]) {
  const Membrane m = set->bodies->membrane;
  const Layout l = m->layout;
  const Grid g = set->markers->grid;
  const PetscInt cells = g->n[0] * g->rows[FIELD_P];
  PetscReal *x, *velocity;
  DoubleCells s = {.set = set, .table = {lattice[0], lattice[1]}};
  const CellLayer of = {&s, SUMMED_CELLS, TakeLattice, Exact};
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(2 * (l->M + LANES), &x, 2 * l->M, &velocity, cells, &s.over));
  PetscCall(PetscCalloc2(DIPOLE_COUNT * (l->M + LANES), &s.tensor, DIPOLE_COUNT * l->M, &s.dipole));
  PetscCall(LayoutGatherVec(l, X, x));
  PetscCall(LayoutGatherVec(l, U, velocity));
  if (!g->free) PetscCall(PressureTable(SUMMED_CELLS + OFFSET_LAGS, &s.table[2]));
  for (PetscInt k = 0; k < cells; k++) s.over[k] = 1;
  for (PetscInt v = 0; v < l->bodies; v++) {
    CellRow row;
    s.ratio = ratio[v];
    s.X = x + 2 * l->start[v];
    if (ratio[v] == 1) continue;
    if (!CellRowBegin(g, LayoutCount(l, v), s.X, PetscMax(CELLS * g->h, SPACINGS * m->ds[v]), &row)) continue;
    PetscCall(SetVesicle(&s, v, row.n, velocity + 2 * l->start[v]));
    PetscCall(CellRowCorrect(&row, &of, field));
    PetscCall(DoubleCurveDestroy(&s.curve));
  }
  for (int f = 0; f < 2; f++)
    for (PetscInt k = 0; k < cells && field[f]; k++) field[f][k] *= s.over[k];
  PetscCall(OffsetTableDestroy(&s.table[2]));
  PetscCall(PetscFree2(s.tensor, s.dipole));
  PetscCall(PetscFree3(x, velocity, s.over));
  PetscFunctionReturn(PETSC_SUCCESS);
}
