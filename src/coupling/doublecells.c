#include "coupling/doublecells.h"
#include "coupling/doubleblock.h"
#include "coupling/doublecurve.h"
#include "coupling/lattice.h"
#include "coupling/nearcells.h"

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
  PetscReal *tensor;     /* [DIPOLE_COUNT n] */
  PaddedStencil *dipole; /* [DIPOLE_COUNT n], not wrapped into the grid */
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

/* Take off what the lattice has of the dipoles at a cell. */
static void TakeLattice(const DoubleCells *s, const PetscInt cell[2], const PetscReal x[2], PetscReal f[3]) {
  const DoubleLayer d = s->coupling->contrast;
  const PetscReal h = s->coupling->fluid->grid->h, nu = s->coupling->fluid->nu;
  const OffsetTable *table[3] = {&d->lattice[0], &d->lattice[1], &d->pressure};
  const PetscReal scale[3] = {1 / h, 1 / h, nu / (h * h)};
  PaddedStencil weights[3];
  for (int c = 0; c < 3; c++) NearCellStencil((Field)c, cell, &weights[c]);
  for (PetscInt k = 0; k < s->n; k++) {
    if (PetscHypotReal(x[0] - s->X[2 * k], x[1] - s->X[2 * k + 1]) > SUMMED_CELLS * h) continue;
    for (int c = 0; c < 3; c++)
      for (PetscInt q = DIPOLE_COUNT * k; q < DIPOLE_COUNT * (k + 1); q++)
        f[c] -= scale[c] * s->tensor[q] *
                StencilNearSum(table[c], (OffsetBlock)(q % DIPOLE_COUNT), &weights[c], &s->dipole[q]);
  }
}

/* The same of distant markers: the double layer itself. */
static void TakeFar(const DoubleCells *s, const PetscReal x[2], PetscReal f[3]) {
  const PetscReal h = s->coupling->fluid->grid->h, nu = s->coupling->fluid->nu;
  for (PetscInt k = 0; k < s->n; k++) {
    const PetscReal r[2] = {s->X[2 * k] - x[0], s->X[2 * k + 1] - x[1]}, r2 = r[0] * r[0] + r[1] * r[1];
    const PetscReal *T = s->tensor + DIPOLE_COUNT * k;
    if (r2 <= PetscSqr(SUMMED_CELLS * h)) continue;
    const PetscReal through = 0.5 * (T[DIPOLE_XX] * r[0] * r[0] + T[DIPOLE_YY] * r[1] * r[1]) +
                              T[DIPOLE_XY] * r[0] * r[1];
    for (int c = 0; c < 2; c++) f[c] += through * r[c] / (PETSC_PI * r2 * r2);
    f[2] += nu / PETSC_PI * (0.5 * (T[DIPOLE_XX] + T[DIPOLE_YY]) / r2 - 2 * through / (r2 * r2));
  }
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
    NearCellsBox(g, s->n, s->X, s->reach, box);
    return;
  }
  for (int dir = 0; dir < 2; dir++) {
    box[dir][0] = 0;
    box[dir][1] = g->n[dir] - 1;
  }
}

/* One vesicle's part, added; over[] becomes 1/ratio inside it. */
static void CorrectVesicle(const DoubleCells *s, PetscReal *const field[3], PetscReal over[]) {
  const Grid g = s->coupling->fluid->grid;
  PetscInt box[2][2], cell[2];
  FindBox(s, box);
  for (cell[1] = box[1][0]; cell[1] <= box[1][1]; cell[1]++) {
    const PetscInt row = ((cell[1] % g->n[1]) + g->n[1]) % g->n[1] - g->first;
    if (row < 0 || row >= g->rows[FIELD_P]) continue;
    for (cell[0] = box[0][0]; cell[0] <= box[0][1]; cell[0]++) {
      const PetscInt at = row * g->n[0] + ((cell[0] % g->n[0]) + g->n[0]) % g->n[0];
      PetscReal x[2], f[3] = {0, 0, 0};
      PetscBool inside;
      GridPosition(g, FIELD_P, cell[0], cell[1], x);
      const PetscBool near = g->free || NearCellIs(s->n, s->X, s->reach, x) ? PETSC_TRUE : PETSC_FALSE;
      if (near)
        DoubleCurveAdd(s->curve, x, f, &f[2], &inside);
      else
        inside = DoubleCurveContains(s->curve, x);
      if (inside) over[at] = 1 / s->ratio;
      if (!near) continue;
      if (!g->free) TakeLattice(s, cell, x, f);
      if (!g->free) TakeFar(s, x, f);
      for (int c = 0; c < 3; c++)
        if (field[c]) field[c][at] += f[c];
    }
  }
}

PetscErrorCode DoubleCellsCorrect(Coupling c, Vec U, Vec X, PetscReal u[], PetscReal v[], PetscReal p[]) {
  const Layout l = c->membrane->layout;
  const PetscInt cells = c->fluid->grid->n[0] * c->fluid->grid->rows[FIELD_P];
  PetscReal *const field[3] = {u, v, p};
  PetscReal *x, *velocity, *over;
  DoubleCells s = {.coupling = c};
  PetscFunctionBeginUser;
  if (!c->contrast) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc3(2 * l->M, &x, 2 * l->M, &velocity, cells, &over));
  PetscCall(PetscMalloc2(DIPOLE_COUNT * l->M, &s.tensor, DIPOLE_COUNT * l->M, &s.dipole));
  PetscCall(LayoutGatherVec(l, X, x));
  PetscCall(LayoutGatherVec(l, U, velocity));
  if (!c->contrast->pressure.value[0]) PetscCall(PressureTable(SUMMED_CELLS + OFFSET_LAGS, &c->contrast->pressure));
  for (PetscInt k = 0; k < cells; k++) over[k] = 1;
  for (PetscInt b = 0; b < l->bodies; b++) {
    if (c->contrast->ratio[b] == 1) continue;
    PetscCall(SetVesicle(&s, b, x, velocity));
    CorrectVesicle(&s, field, over);
    PetscCall(DoubleCurveDestroy(&s.curve));
  }
  for (int f = 0; f < 2; f++)
    for (PetscInt k = 0; k < cells && field[f]; k++) field[f][k] *= over[k];
  PetscCall(PetscFree2(s.tensor, s.dipole));
  PetscCall(PetscFree3(x, velocity, over));
  PetscFunctionReturn(PETSC_SUCCESS);
}
