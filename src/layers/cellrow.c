#include "layers/cellrow.h"
#include "layers/wallimage.h"

void CellStencil(Field f, const PetscInt cell[2], PaddedStencil *padded) {
  Stencil stencil;
  for (int dir = 0; dir < 2; dir++) {
    const PetscBool faces = (int)f == dir;
    stencil.n[dir] = faces ? 2 : 1;
    stencil.first[dir] = cell[dir] - (faces ? 1 : 0);
    stencil.weight[dir][0] = stencil.weight[dir][1] = faces ? 0.5 : 1;
  }
  StencilPad(&stencil, padded);
}

/* The row of this rank that row j of cells is, wrapped into the grid; -1: another rank's. */
static PetscInt OwnRow(Grid g, PetscInt j) {
  const PetscInt row = ((j % g->n[1]) + g->n[1]) % g->n[1] - g->first;
  return row < g->rows[FIELD_P] ? PetscMax(row, -1) : -1;
}

PetscBool CellRowBegin(Grid g, PetscInt n, const PetscReal X[], PetscReal reach, CellRow *c) {
  const NearBounds bounds = NearBoundsOf(n, X);
  *c = (CellRow){.grid = g, .n = n, .X = X, .reach = reach};
  for (int dir = 0; dir < 2; dir++) {
    c->box[dir][0] = g->free ? 0 : (PetscInt)PetscFloorReal((bounds.low[dir] - reach - g->lo[dir]) / g->h);
    c->box[dir][1] = g->free ? g->n[dir] - 1 : (PetscInt)PetscFloorReal((bounds.high[dir] + reach - g->lo[dir]) / g->h);
    if (!g->wall[dir]) continue;
    c->box[dir][0] = PetscMax(c->box[dir][0], 0);
    c->box[dir][1] = PetscMin(c->box[dir][1], g->n[dir] - 1);
  }
  for (PetscInt j = c->box[1][0]; j <= c->box[1][1]; j++)
    if (OwnRow(g, j) >= 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Whether a cell, at x, is corrected. */
static PetscBool IsNear(const CellRow *c, PetscInt i, PetscInt j, PetscReal x[2]) {
  GridPosition(c->grid, FIELD_P, i, j, x);
  for (PetscInt k = 0; k < c->n && !c->grid->free; k++) {
    const PetscReal dx = x[0] - c->X[2 * k], dy = x[1] - c->X[2 * k + 1];
    if (dx * dx + dy * dy < c->reach * c->reach) return PETSC_TRUE;
  }
  return c->grid->free;
}

/* The lattice's part at the cells of row j that are corrected, of the markers near each. */
static void SumRow(CellRow *c, const CellLayer *layer, PetscInt j) {
  const Grid g = c->grid;
  PetscReal x[2];
  c->from = c->box[0][1] + 1;
  c->to = c->box[0][1];
  for (PetscInt i = c->box[0][0]; i <= c->box[0][1]; i++) {
    if (!IsNear(c, i, j, x)) continue;
    c->from = PetscMin(c->from, i);
    c->to = i;
  }
  for (int f = 0; f < 3; f++) (void)PetscArrayzero(c->sum[f], c->to - c->from + 1);
  for (PetscInt k = 0; k < c->n && c->from <= c->to; k++) {
    const PetscReal off = (c->X[2 * k] - g->lo[0]) / g->h - 0.5;
    const PetscReal above = (c->X[2 * k + 1] - g->lo[1]) / g->h - 0.5 - (PetscReal)j;
    const PetscReal left = layer->summed * layer->summed - above * above, wide = left > 0 ? PetscSqrtReal(left) : -1;
    c->first[k] = PetscCeilReal(off - wide);
    c->last[k] = PetscFloorReal(off + wide);
    const PetscInt cell[2] = {PetscMax((PetscInt)c->first[k], c->from), j};
    const PetscInt count = PetscMin((PetscInt)c->last[k], c->to) - cell[0] + 1, at = cell[0] - c->from;
    PetscReal *const sum[3] = {c->sum[0] + at, c->sum[1] + at, c->sum[2] + at};
    if (count > 0) layer->lattice(layer->context, k, cell, count, sum);
  }
}

PetscErrorCode CellRowCorrect(CellRow *c, const CellLayer *layer, PetscReal *const field[3]) {
  const Grid g = c->grid;
  const PetscInt cells = c->box[0][1] - c->box[0][0] + 1, n = c->n + LANES;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc5(n, &c->first, n, &c->last, cells, &c->sum[0], cells, &c->sum[1], cells, &c->sum[2]));
  for (PetscInt j = c->box[1][0]; j <= c->box[1][1]; j++) {
    const PetscInt row = OwnRow(g, j);
    if (row < 0) continue;
    if (!g->free) SumRow(c, layer, j);
    for (PetscInt i = c->box[0][0]; i <= c->box[0][1]; i++) {
      const PetscInt at = row * g->n[0] + ((i % g->n[0]) + g->n[0]) % g->n[0];
      PetscReal x[2], found[3] = {0, 0, 0};
      const PetscBool near = IsNear(c, i, j, x);
      for (int f = 0; f < 3 && near && !g->free; f++) found[f] = c->sum[f][i - c->from];
      layer->exact(layer->context, c, i, x, near, at, found);
      for (int f = 0; f < 3; f++)
        if (field[f] && near) field[f][at] += found[f];
    }
  }
  PetscCall(PetscFree5(c->first, c->last, c->sum[0], c->sum[1], c->sum[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
