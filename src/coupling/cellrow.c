#include "coupling/cellrow.h"

void CellStencil(Field f, const PetscInt cell[2], PaddedStencil *padded) {
  Stencil stencil;
  for (int dir = 0; dir < 2; dir++) {
    const PetscBool faces = (int)f == dir ? PETSC_TRUE : PETSC_FALSE;
    stencil.n[dir] = faces ? 2 : 1;
    stencil.first[dir] = cell[dir] - (faces ? 1 : 0);
    stencil.weight[dir][0] = stencil.weight[dir][1] = faces ? 0.5 : 1;
  }
  StencilPad(&stencil, padded);
}

PetscBool CellIsNear(PetscInt n, const PetscReal X[], PetscReal reach, const PetscReal x[2]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal dx = x[0] - X[2 * k], dy = x[1] - X[2 * k + 1];
    if (dx * dx + dy * dy < reach * reach) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

void CellBox(Grid g, PetscInt n, const PetscReal X[], PetscReal reach, PetscInt box[2][2]) {
  for (int dir = 0; dir < 2; dir++) {
    PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
    for (PetscInt k = 0; k < n; k++) {
      low = PetscMin(low, X[2 * k + dir]);
      high = PetscMax(high, X[2 * k + dir]);
    }
    box[dir][0] = (PetscInt)PetscFloorReal((low - reach - g->lo[dir]) / g->h);
    box[dir][1] = (PetscInt)PetscFloorReal((high + reach - g->lo[dir]) / g->h);
    if (!g->wall[dir]) continue;
    box[dir][0] = PetscMax(box[dir][0], 0);
    box[dir][1] = PetscMin(box[dir][1], g->n[dir] - 1);
  }
}

PetscErrorCode CellRowCreate(PetscInt markers, PetscInt cells, CellRow *row) {
  const PetscInt n = markers + LANES;
  PetscFunctionBeginUser;
  *row = (CellRow){0};
  PetscCall(PetscCalloc5(n, &row->first, n, &row->last, cells, &row->sum[0], cells, &row->sum[1], cells, &row->sum[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellRowDestroy(CellRow *row) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(row->first, row->last, row->sum[0], row->sum[1], row->sum[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool CellRowPlace(CellRow *row, Grid g, PetscInt n, const PetscReal X[], PetscReal reach, const PetscInt box[2],
                       PetscInt j) {
  PetscReal x[2];
  row->from = box[1] + 1;
  row->to = box[1];
  for (PetscInt i = box[0]; i <= box[1]; i++) {
    GridPosition(g, FIELD_P, i, j, x);
    if (!CellIsNear(n, X, reach, x)) continue;
    row->from = PetscMin(row->from, i);
    row->to = i;
  }
  if (row->from > box[1]) return PETSC_FALSE;
  for (int f = 0; f < 3; f++) (void)PetscArrayzero(row->sum[f], row->to - row->from + 1);
  return PETSC_TRUE;
}

PetscInt CellRowNear(CellRow *row, Grid g, PetscInt k, const PetscReal X[2], PetscReal cells, PetscInt j,
                     PetscInt cell[2]) {
  const PetscReal x = (X[0] - g->lo[0]) / g->h - 0.5, y = (X[1] - g->lo[1]) / g->h - 0.5 - (PetscReal)j;
  const PetscReal left = cells * cells - y * y, wide = left > 0 ? PetscSqrtReal(left) : -1;
  row->first[k] = PetscCeilReal(x - wide);
  row->last[k] = PetscFloorReal(x + wide);
  cell[0] = PetscMax((PetscInt)row->first[k], row->from);
  cell[1] = j;
  return PetscMax(0, PetscMin((PetscInt)row->last[k], row->to) - cell[0] + 1);
}
