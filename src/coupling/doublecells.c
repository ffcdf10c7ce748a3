#include "coupling/doublecells.h"
#include "coupling/cellrow.h"
#include "coupling/doubleblock.h"
#include "coupling/doublecurve.h"
#include "coupling/lattice.h"

#define CELLS 4         /* distance from a marker up to which a cell is corrected, */
#define SPACINGS 2      /* and the same in spacings of the markers */
#define SUMMED_CELLS 20 /* from a marker to a cell: beyond it what the lattice lacks is left out, 5e-4 of h^2/r^2 J */

/* One vesicle, and what all cells need. */
typedef struct {
  Coupling coupling;
  DoubleCurve curve;
  PetscInt n;
  PetscReal reach; /* of the correction (length); everywhere in unbounded fluid */
  PetscReal ratio;
  const PetscReal *X;    /* [2n] */
  PetscReal *tensor;     /* [DIPOLE_COUNT n]; whole vectors, as X */
  PaddedStencil *dipole; /* [DIPOLE_COUNT n], not wrapped into the grid */
  CellRow row;           /* the cells under way; none in unbounded fluid */
} DoubleCells;

static PetscReal At(const OffsetTable *t, OffsetBlock b, PetscInt i, PetscInt j) {
  return t->value[b][(j + t->size[1]) * (2 * t->size[0] + 1) + i + t->size[0]];
}

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
      t->value[DIPOLE_XX][at] = At(&p, OFFSET_UU, i, j) - At(&p, OFFSET_UU, i + 1, j) + own;
      t->value[DIPOLE_YY][at] = At(&p, OFFSET_VV, i, j) - At(&p, OFFSET_VV, i, j + 1) + own;
      t->value[DIPOLE_XY][at] = At(&p, OFFSET_UU, i, j - 1) - At(&p, OFFSET_UU, i, j) + At(&p, OFFSET_VV, i - 1, j) -
                                At(&p, OFFSET_VV, i, j);
    }
  PetscCall(OffsetTableDestroy(&p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the lattice has of the dipoles of marker k at `n` cells of a row from cell[0] on, taken off. */
static void TakeLattice(DoubleCells *s, PetscInt k, const PetscInt cell[2], PetscInt n) {
  static const PetscInt none[2] = {0, 0};
  const DoubleLayer d = s->coupling->contrast;
  const PetscReal h = s->coupling->fluid->grid->h, nu = s->coupling->fluid->nu;
  const OffsetTable *table[3] = {&d->lattice[0], &d->lattice[1], &d->pressure};
  const PetscReal scale[3] = {1 / h, 1 / h, nu / (h * h)};
  for (int c = 0; c < 3; c++) {
    PaddedStencil weights;
    CellStencil((Field)c, cell, &weights);
    for (PetscInt q = DIPOLE_COUNT * k; q < DIPOLE_COUNT * (k + 1); q++)
      StencilRowAdd(table[c], (OffsetBlock)(q % DIPOLE_COUNT), &weights, &s->dipole[q], none, -scale[c] * s->tensor[q],
                    n, s->row.sum[c] + cell[0] - s->row.from);
  }
}

/* The same of markers that are distant from cell i: the double layer itself. */
static void TakeDistant(const DoubleCells *s, PetscInt i, const PetscReal at[2], PetscReal f[3]) {
  const PetscReal nu = s->coupling->fluid->nu;
  Lanes sum[3] = {{0}, {0}, {0}};
  for (PetscInt k = 0; k < s->n; k += LANES) {
    const LanesBits far = CellRowDistant(&s->row, s->n, k, i);
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
  for (int c = 0; c < 2; c++) f[c] += LanesSum(sum[c]) / PETSC_PI;
  f[2] += nu / PETSC_PI * LanesSum(sum[2]);
}

static PetscErrorCode SetVesicle(DoubleCells *s, PetscInt v, const PetscReal X[], const PetscReal U[]) {
  const DoubleLayer d = s->coupling->contrast;
  const Membrane m = s->coupling->membrane;
  PetscReal *normal, *along, *J;
  PetscFunctionBeginUser;
  s->n = LayoutCount(m->layout, v);
  s->ratio = d->ratio[v];
  s->X = X + 2 * m->layout->start[v];
  s->reach = PetscMax(CELLS * s->coupling->fluid->grid->h, SPACINGS * m->ds[v]);
  PetscCall(PetscMalloc3(2 * s->n, &normal, s->n, &along, 2 * s->n, &J));
  PetscCall(DoubleGeometry(m->spectral[v], s->n, s->X, normal, along));
  for (PetscInt k = 0; k < 2 * s->n; k++) J[k] = (1 - s->ratio) * U[2 * m->layout->start[v] + k];
  PetscCall(DoubleCurveCreate(s->n, s->coupling->fluid->nu, s->X, J, &s->curve));
  for (PetscInt k = 0; k < s->n; k++) {
    PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    Stencil part[DIPOLE_COUNT];
    T[DIPOLE_XX] = 2 * J[2 * k] * normal[2 * k];
    T[DIPOLE_YY] = 2 * J[2 * k + 1] * normal[2 * k + 1];
    T[DIPOLE_XY] = J[2 * k] * normal[2 * k + 1] + J[2 * k + 1] * normal[2 * k];
    DipoleStencilsUnwrapped(s->coupling->fluid->grid, s->X + 2 * k, part);
    for (int c = 0; c < DIPOLE_COUNT; c++) StencilPad(&part[c], &s->dipole[DIPOLE_COUNT * k + c]);
  }
  PetscCall(PetscFree3(normal, along, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cells from box[dir][0] to box[dir][1] hold the vesicle and all that is near it; in unbounded fluid all of the window.
 */
static void FindBox(const DoubleCells *s, PetscInt box[2][2]) {
  const Grid g = s->coupling->fluid->grid;
  if (!g->free) {
    CellBox(g, s->n, s->X, s->reach, box);
    return;
  }
  for (int dir = 0; dir < 2; dir++) {
    box[dir][0] = 0;
    box[dir][1] = g->n[dir] - 1;
  }
}

/* Row j of the cells from box[0] to box[1]; to the fields from `start` on, over[] becomes 1/ratio inside. */
static void CorrectRow(DoubleCells *s, const PetscInt box[2], PetscInt j, PetscReal *const field[3], PetscInt start,
                       PetscReal over[]) {
  const Grid g = s->coupling->fluid->grid;
  PetscInt cell[2];
  const PetscBool any = g->free || CellRowPlace(&s->row, g, s->n, s->X, s->reach, box, j) ? PETSC_TRUE : PETSC_FALSE;
  for (PetscInt k = 0; k < s->n && any && !g->free; k++) {
    const PetscInt n = CellRowNear(&s->row, g, k, s->X + 2 * k, SUMMED_CELLS, j, cell);
    if (n) TakeLattice(s, k, cell, n);
  }
  for (PetscInt i = box[0]; i <= box[1]; i++) {
    const PetscInt at = start + ((i % g->n[0]) + g->n[0]) % g->n[0];
    PetscReal x[2], f[3] = {0, 0, 0};
    PetscBool inside;
    GridPosition(g, FIELD_P, i, j, x);
    const PetscBool near = any && (g->free || CellIsNear(s->n, s->X, s->reach, x)) ? PETSC_TRUE : PETSC_FALSE;
    if (near)
      DoubleCurveAdd(s->curve, x, f, &f[2], &inside);
    else
      inside = DoubleCurveContains(s->curve, x);
    if (inside) over[at] = 1 / s->ratio;
    if (!near) continue;
    if (!g->free) TakeDistant(s, i, x, f);
    for (int c = 0; c < 3; c++)
      if (field[c]) field[c][at] += f[c] + (g->free ? 0 : s->row.sum[c][i - s->row.from]);
  }
}

/* One vesicle's part, added. */
static PetscErrorCode CorrectVesicle(DoubleCells *s, PetscReal *const field[3], PetscReal over[]) {
  const Grid g = s->coupling->fluid->grid;
  PetscInt box[2][2];
  PetscFunctionBeginUser;
  FindBox(s, box);
  PetscCall(CellRowCreate(s->n, box[0][1] - box[0][0] + 1, &s->row));
  for (PetscInt j = box[1][0]; j <= box[1][1]; j++) {
    const PetscInt row = ((j % g->n[1]) + g->n[1]) % g->n[1] - g->first;
    if (row >= 0 && row < g->rows[FIELD_P]) CorrectRow(s, box[0], j, field, row * g->n[0], over);
  }
  PetscCall(CellRowDestroy(&s->row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCellsCorrect(Coupling c, Vec U, Vec X, PetscReal u[], PetscReal v[], PetscReal p[]) {
  const Layout l = c->membrane->layout;
  const PetscInt cells = c->fluid->grid->n[0] * c->fluid->grid->rows[FIELD_P];
  PetscReal *const field[3] = {u, v, p};
  PetscReal *x, *velocity, *over;
  DoubleCells s = {.coupling = c};
  PetscFunctionBeginUser;
  if (!c->contrast) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(2 * (l->M + LANES), &x, 2 * l->M, &velocity, cells, &over));
  PetscCall(PetscCalloc2(DIPOLE_COUNT * (l->M + LANES), &s.tensor, DIPOLE_COUNT * l->M, &s.dipole));
  PetscCall(LayoutGatherVec(l, X, x));
  PetscCall(LayoutGatherVec(l, U, velocity));
  if (!c->contrast->pressure.value[0]) PetscCall(PressureTable(SUMMED_CELLS + OFFSET_LAGS, &c->contrast->pressure));
  for (PetscInt k = 0; k < cells; k++) over[k] = 1;
  for (PetscInt b = 0; b < l->bodies; b++) {
    if (c->contrast->ratio[b] == 1) continue;
    PetscCall(SetVesicle(&s, b, x, velocity));
    PetscCall(CorrectVesicle(&s, field, over));
    PetscCall(DoubleCurveDestroy(&s.curve));
  }
  for (int f = 0; f < 2; f++)
    for (PetscInt k = 0; k < cells && field[f]; k++) field[f][k] *= over[k];
  PetscCall(PetscFree2(s.tensor, s.dipole));
  PetscCall(PetscFree3(x, velocity, over));
  PetscFunctionReturn(PETSC_SUCCESS);
}
