#include "coupling/mobility.h"

#define NEAR 14 /* cells up to which stencils are summed where the near field is exact */

/* Whether the mobility between walls can be had from the box part's grids. */
static PetscBool HasBox(Coupling c) {
  const Grid g = c->fluid->grid;
  return c->fluid->steady && c->near && c->near->box && (g->wall[0] || g->wall[1]) ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode MobilityCreate(const FluidSpec *spec, Coupling c, PetscReal reach, Mobility *out) {
  Mobility m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->coupling = c;
  m->near = c->near ? NEAR : PETSC_MAX_REAL;
  if (HasBox(c))
    PetscCall(MobilityBoxCreate(spec, c, &m->box));
  else
    PetscCall(MobilityTableCreate(spec, c->markers->kernel, reach, &m->table));
  PetscCall(PetscMalloc1(2 * c->bodies->layout->M, &m->stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityDestroy(Mobility *mobility) {
  PetscFunctionBeginUser;
  if (!*mobility) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*mobility)->table) PetscCall(MobilityTableDestroy(&(*mobility)->table));
  PetscCall(MobilityBoxDestroy(&(*mobility)->box));
  PetscCall(PetscFree((*mobility)->stencil));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilitySetUp(Mobility m, PetscReal alpha) {
  PetscFunctionBeginUser;
  m->part = CouplingGridPart(m->coupling, alpha);
  if (m->table) PetscCall(MobilityTableSetUp(m->table, alpha));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a pair's stencils are summed: near, and with all of their offsets in the table. */
static PetscBool IsNear(Mobility m, const PetscReal cells[2]) {
  for (int dir = 0; dir < 2; dir++)
    if (PetscAbsReal(cells[dir]) > (PetscReal)(m->table->green.size[dir] - OFFSET_LAGS)) return PETSC_FALSE;
  return cells[0] * cells[0] + cells[1] * cells[1] <= m->near * m->near ? PETSC_TRUE : PETSC_FALSE;
}

/* Mob of markers i and j, the nearest image: xx, yy, xy, yx. */
static void Pair(Mobility m, PetscInt i, PetscInt j, PetscReal Mob[4]) {
  const Grid g = m->coupling->fluid->grid;
  const PetscReal *X = m->coupling->markers->X;
  PetscReal d[2], cells[2];
  PetscInt periods[2]; /* in cells */
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal period = g->hi[dir] - g->lo[dir], apart = X[2 * i + dir] - X[2 * j + dir];
    const PetscInt back = (PetscInt)PetscFloorReal(apart / period + 0.5);
    d[dir] = apart - period * (PetscReal)back;
    periods[dir] = -back * g->n[dir];
    cells[dir] = d[dir] / g->h;
  }
  if (IsNear(m, cells))
    StencilFourSums(&m->table->green, &m->stencil[2 * i], &m->stencil[2 * j], periods, Mob);
  else {
    MobilityTableMean(m->table, d, Mob);
    Mob[3] = Mob[2];
  }
  for (int q = 0; q < 4; q++) Mob[q] *= m->part;
}

/* The stencils of markers, which count from the markers' own places. */
static void Pad(Mobility m, const MarkerRange *range) {
  const Markers markers = m->coupling->markers;
  for (PetscInt k = range->first; k < range->first + range->n; k++) {
    for (PetscInt q = 2 * k; q < 2 * k + 2; q++) StencilPad(&markers->plain[q], &m->stencil[q]);
    StencilUnwrap(markers->grid, markers->X + 2 * k, &m->stencil[2 * k]);
  }
}

PetscErrorCode MobilityAssemble(Mobility m, PetscInt first, PetscInt n, PetscInt part, PetscInt parts,
                                PetscReal Mob[]) {
  const MarkerRange range = {first, n};
  PetscFunctionBeginUser;
  if (m->box) {
    PetscCall(MobilityAssembleBetween(m, &range, &range, part, parts, Mob));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  Pad(m, &range);
  if (parts > 1) PetscCall(PetscArrayzero(Mob, 4 * n * n));
  for (PetscInt i = part; i < n; i += parts)
    for (PetscInt j = i; j < n; j++) { /* symmetric */
      PetscReal *block = Mob + 2 * i * 2 * n + 2 * j, *mirror = Mob + 2 * j * 2 * n + 2 * i, one[4];
      Pair(m, first + i, first + j, one);
      block[0] = mirror[0] = one[0];
      block[2 * n + 1] = mirror[2 * n + 1] = one[1];
      block[1] = mirror[2 * n] = one[2];
      block[2 * n] = mirror[1] = one[3];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityAssembleBetween(Mobility m, const MarkerRange *rows, const MarkerRange *columns, PetscInt part,
                                       PetscInt parts, PetscReal Mob[]) {
  const MarkerRange *range[2] = {rows, columns};
  PetscFunctionBeginUser;
  for (int q = 0; q < 2; q++) Pad(m, range[q]);
  if (parts > 1 || m->box) PetscCall(PetscArrayzero(Mob, 4 * rows->n * columns->n));
  if (m->box) PetscCall(MobilityBoxAdd(m->box, rows, columns, Mob));
  for (PetscInt j = part; j < columns->n && !m->box; j += parts)
    for (PetscInt i = 0; i < rows->n; i++) {
      PetscReal *x = Mob + 2 * j * 2 * rows->n + 2 * i, *y = x + 2 * rows->n, one[4];
      Pair(m, rows->first + i, columns->first + j, one);
      x[0] = one[0];
      y[1] = one[1];
      y[0] = one[2];
      x[1] = one[3];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
