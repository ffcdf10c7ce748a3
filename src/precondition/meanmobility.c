#include "precondition/meanmobility.h"
#include "layers/layerpairs.h"

#define TABLE_NEAR 14 /* cells up to which stencils are summed where the near field is exact */
#define BOX_NEAR 8    /* cells up to which a pair has the lattice's sums */

PetscErrorCode MeanMobilityCreate(const FluidSpec *spec, Coupling c, PetscReal reach, MeanMobility *out) {
  const Grid g = c->fluid->grid;
  MeanMobility m;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->coupling = c;
  m->near = c->mobility->near ? TABLE_NEAR : PETSC_MAX_REAL;
  if (c->fluid->steady && c->mobility->near && c->mobility->near->box && (g->wall[0] || g->wall[1]))
    PetscCall(NearFieldCreateBoxPart(c->mobility->near, spec, PETSC_TRUE, &m->box));
  else if (!c->fluid->grid->free)
    PetscCall(MobilityTableCreate(spec, c->markers->kernel, reach, &m->table));
  PetscCall(PetscMalloc1(2 * c->bodies->layout->M, &m->stencil));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MeanMobilityDestroy(MeanMobility *mobility) {
  PetscFunctionBeginUser;
  if (!*mobility) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MobilityTableDestroy(&(*mobility)->table));
  PetscCall(BoxPartDestroy(&(*mobility)->box));
  PetscCall(PetscFree((*mobility)->stencil));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MeanMobilitySetUp(MeanMobility m, PetscReal alpha) {
  PetscFunctionBeginUser;
  m->part = MobilityGridPart(m->coupling->mobility, alpha);
  if (m->table) PetscCall(MobilityTableSetUp(m->table, alpha));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mob of markers i and j, the nearest image: xx, yy, xy, yx. */
static void TablePair(MeanMobility m, PetscInt i, PetscInt j, PetscReal Mob[4]) {
  const Grid g = m->coupling->fluid->grid;
  const PetscReal *X = m->coupling->markers->X;
  PetscReal cells[2];
  PetscInt periods[2];         /* in cells */
  PetscBool near = PETSC_TRUE; /* stencils are summed, with all of their offsets in the table */
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal period = g->hi[dir] - g->lo[dir], apart = X[2 * i + dir] - X[2 * j + dir];
    const PetscInt back = (PetscInt)PetscFloorReal(apart / period + 0.5);
    periods[dir] = -back * g->n[dir];
    cells[dir] = (apart - period * (PetscReal)back) / g->h;
    if (PetscAbsReal(cells[dir]) > (PetscReal)(m->table->green.size[dir] - OFFSET_LAGS)) near = PETSC_FALSE;
  }
  if (near && cells[0] * cells[0] + cells[1] * cells[1] <= m->near * m->near)
    StencilFourSums(&m->table->green, &m->stencil[2 * i], &m->stencil[2 * j], periods, Mob);
  else {
    MeanTableAt(&m->table->mean, cells, Mob);
    Mob[3] = Mob[2];
  }
  for (int q = 0; q < 4; q++) Mob[q] *= m->part;
}

/* The stencils of markers, which count from the markers' own places. */
static void PadStencils(MeanMobility m, const MarkerRange *range) {
  const Markers markers = m->coupling->markers;
  for (PetscInt k = range->first; k < range->first + range->n; k++) {
    for (PetscInt q = 2 * k; q < 2 * k + 2; q++) StencilPad(&markers->plain[q], &m->stencil[q]);
    StencilUnwrap(markers->grid, markers->X + 2 * k, &m->stencil[2 * k]);
  }
}

/* Mob[][2 rows] += the block xx, yy, xy, yx of markers i and j: velocity of row marker i by a force on column marker j.
 */
static void AddMobilityPair(PetscInt rows, PetscInt i, PetscInt j, const PetscReal block[4], PetscReal Mob[]) {
  PetscReal *x = Mob + 4 * j * rows + 2 * i, *y = x + 2 * rows;
  x[0] += block[0];
  y[1] += block[1];
  y[0] += block[2];
  x[1] += block[3];
}

/* h^2 (L - C_image) and the exact images of markers i and j, the nearest image: xx, yy, xy, yx. Pairs far from one
   another and from walls take those of S, which leaves out a C of the order h^2/r^2. */
static void BoxPair(NearField f, PetscInt i, PetscInt j, PetscReal value[4]) {
  const PetscReal *X = f->set.markers->X, h = f->set.markers->grid->h;
  PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]}, L[4], C[4] = {0, 0, 0, 0};
  const PetscReal fade = BoxImage(f->set.box, d);
  if (d[0] * d[0] + d[1] * d[1] < PetscSqr(BOX_NEAR * h)) {
    LayerPairLattice(f->pairs, f->pairs->kernel->reach[NEAR_ONE], i, j, d, L);
    WallImageAdd(f->pairs->image, NULL, i, j, d, L, C);
  } else {
    StokesletOne(&f->set, d, 0, L);
    L[3] = L[2];
  }
  WallImageAddExact(f->pairs->image, i, j, d, -1, C);
  for (int q = 0; q < 4; q++) value[q] = h * h * fade * (L[q] - C[q]);
}

PetscErrorCode MeanMobilityAssemble(MeanMobility m, const MarkerRange *rows, const MarkerRange *columns, PetscInt part,
                                    PetscInt parts, PetscReal Mob[]) {
  const Layout l = m->coupling->bodies->layout;
  const PetscReal h2 = PetscSqr(m->coupling->fluid->grid->h);
  PetscInt begin = 0, end = rows->n;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(Mob, 4 * rows->n * columns->n));
  if (m->box) { /* the rows of the own markers */
    begin = PetscMax(l->first - rows->first, 0);
    end = PetscMin(l->first + l->n - rows->first, rows->n);
    part = 0;
    parts = 1;
    PetscCall(BoxPartPlace(m->box));
    PetscCall(BoxPartAdd(m->box, h2, rows, columns, Mob));
  } else if (m->table) {
    PadStencils(m, rows);
    PadStencils(m, columns);
  } else
    PetscFunctionReturn(PETSC_SUCCESS);
  /* where all pairs of markers among themselves are made, a pair and its mirror image are one another's transposes */
  const PetscBool same = rows->first == columns->first && end - begin == columns->n && rows->n == columns->n;
  for (PetscInt j = part; j < columns->n; j += parts)
    for (PetscInt i = same ? j : begin; i < end; i++) {
      PetscReal one[4];
      if (m->box)
        BoxPair(m->coupling->mobility->near, rows->first + i, columns->first + j, one);
      else
        TablePair(m, rows->first + i, columns->first + j, one);
      if (same && i == j) one[2] = one[3]; /* symmetric to the bit */
      AddMobilityPair(rows->n, i, j, one, Mob);
      if (same && i != j) AddMobilityPair(rows->n, j, i, (PetscReal[]){one[0], one[1], one[3], one[2]}, Mob);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MeanMobilityOnRoot(MeanMobility m, const MarkerRange *rows, const MarkerRange *columns, PetscMPIInt root,
                                  PetscReal Mob[]) {
  const Coupling c = m->coupling;
  const Layout l = c->bodies->layout;
  const PetscBool box = m->box ? PETSC_FALSE : PETSC_TRUE; /* C has its box part */
  PetscMPIInt size;
  PetscFunctionBeginUser;
  PetscCall(MeanMobilityAssemble(m, rows, columns, l->rank, l->size, Mob));
  if (c->mobility->near)
    PetscCall(NearFieldAdd(c->mobility->near, PetscSqr(c->fluid->grid->h), box, rows, columns, Mob));
  PetscCall(PetscMPIIntCast(4 * rows->n * columns->n, &size));
  if (l->size > 1)
    PetscCallMPI(MPI_Reduce(l->rank == root ? MPI_IN_PLACE : Mob, Mob, size, MPIU_REAL, MPI_SUM, root, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
