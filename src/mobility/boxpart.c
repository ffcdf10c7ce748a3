#include "mobility/boxpart.h"
#include "base/lanes.h"

PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, BoxPart *out) {
  BoxPart b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->lattice = *lattice;
  b->markers = markers;
  b->ramp = spec->inertia == INERTIA_NONE ? PETSC_FALSE : PETSC_TRUE;
  for (int d = 0; d < 2; d++)
    b->axis[d] = BoxAxisOfGrid(markers->grid->wall[d], markers->grid->lo[d], markers->grid->hi[d]);
  PetscCall(PetvesEvent("BoxTable", &b->make));
  PetscCall(PetscMalloc1(2 * markers->layout->n, &b->X));
  for (PetscInt k = 0; k < 2 * markers->layout->n; k++) b->X[k] = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartDestroy(BoxPart *box) {
  BoxPart b = *box;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 2; k++) PetscCall(BoxTableDestroy(&b->table[k]));
  PetscCall(PetscFree2(b->A, b->amplitude));
  PetscCall(PetscFree(b->X));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The part of D that a marker has: in unsteady flow it fades up to four cells from a wall, where the force's smear in
   the inertia would make C + D indefinite. */
static PetscReal Fade(BoxPart b, const PetscReal X[2]) {
  const Grid g = b->markers->grid;
  PetscReal fade = 1;
  for (int d = 0; d < 2 && b->ramp; d++)
    if (g->wall[d]) fade *= BoxSmoothStep(PetscMin(X[d] - g->lo[d], g->hi[d] - X[d]), g->h, 4 * g->h);
  return fade;
}

/* The rows A[2][rank] of marker k, from its functions' values. */
static void BoxPartPlaceMarker(BoxPart b, PetscInt k, PetscReal A[]) {
  const PetscReal *X = b->markers->X + 2 * k;
  BoxTableRows(b->at, X, Fade(b, X), 0, 2, A);
}

/* Whether a box has walls and all markers are in its middle half. */
static PetscBool AreInMiddle(BoxPart b) {
  const Grid g = b->markers->grid;
  for (int d = 0; d < 2; d++) {
    const PetscReal quarter = 0.25 * (g->hi[d] - g->lo[d]);
    for (PetscInt k = 0; k < b->markers->layout->M && g->wall[d]; k++) {
      const PetscReal x = b->markers->X[2 * k + d];
      if (x < g->lo[d] + quarter || x > g->hi[d] - quarter) return PETSC_FALSE;
    }
  }
  return g->wall[0] || g->wall[1] ? PETSC_TRUE : PETSC_FALSE;
}

/* The table that reaches all markers, made when it is first needed. */
static PetscErrorCode BoxPartTakeTable(BoxPart b, PetscBool *moved) {
  const Layout l = b->markers->layout;
  const PetscBool middle = AreInMiddle(b);
  BoxTable *t = &b->table[middle];
  PetscFunctionBeginUser;
  if (!t->l) {
    PetscCall(PetscLogEventBegin(b->make, 0, 0, 0, 0));
    PetscCall(BoxTableCreate(b->spec, b->markers->kernel->name, &b->lattice, middle, t));
    PetscCall(PetscLogEventEnd(b->make, 0, 0, 0, 0));
  }
  *moved = b->at == t ? PETSC_FALSE : PETSC_TRUE;
  b->at = t;
  if (b->at->rank <= b->room) PetscFunctionReturn(PETSC_SUCCESS);
  b->room = b->at->rank;
  PetscCall(PetscFree2(b->A, b->amplitude));
  PetscCall(PetscMalloc2(2 * l->n * b->room, &b->A, b->room, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartPlace(BoxPart b) {
  const Layout l = b->markers->layout;
  PetscBool moved = PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(BoxPartTakeTable(b, &moved));
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *now = b->markers->X + 2 * (l->first + k), *then = b->X + 2 * k;
    if (!moved && now[0] == then[0] && now[1] == then[1]) continue; /* at rest, on an obstacle */
    BoxPartPlaceMarker(b, l->first + k, b->A + 2 * k * b->at->rank);
    b->X[2 * k] = now[0];
    b->X[2 * k + 1] = now[1];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartApply(BoxPart b, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->at->rank;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->amplitude, r));
  for (PetscInt k = 0; k < 2 * l->n; k++)
    for (PetscInt m = 0; m < r; m++) b->amplitude[m] += b->A[k * r + m] * F[k];
  if (l->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, (PetscMPIInt)r, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * b->at->l[m];
  for (PetscInt k = 0; k < 2 * l->n; k++) U[k] += LanesDot(r, b->amplitude, b->A + k * r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of A of the markers in a range: the own ones, or made here and to be freed. */
static PetscErrorCode RangeRows(BoxPart b, const MarkerRange *range, PetscReal **rows, PetscBool *made) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->at->rank;
  PetscFunctionBeginUser;
  *made = range->first < l->first || range->first + range->n > l->first + l->n ? PETSC_TRUE : PETSC_FALSE;
  if (!*made)
    *rows = b->A + 2 * (range->first - l->first) * r;
  else
    PetscCall(PetscMalloc1(2 * range->n * r, rows));
  for (PetscInt k = 0; k < range->n && *made; k++) BoxPartPlaceMarker(b, range->first + k, *rows + 2 * k * r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartAdd(BoxPart b, PetscReal scale, const MarkerRange *rows, const MarkerRange *columns,
                          PetscReal out[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->at->rank, begin = PetscMax(l->first, rows->first),
                 end = PetscMin(l->first + l->n, rows->first + rows->n);
  PetscReal *x, *y;
  PetscBool made[2];
  PetscFunctionBeginUser;
  PetscCall(RangeRows(b, rows, &x, &made[0]));
  PetscCall(RangeRows(b, columns, &y, &made[1]));
  for (PetscInt j = 0; j < 2 * columns->n; j++)
    for (PetscInt i = 2 * (begin - rows->first); i < 2 * (end - rows->first); i++)
      out[j * 2 * rows->n + i] += scale * BoxProduct(r, b->at->l, x + i * r, y + j * r);
  if (made[0]) PetscCall(PetscFree(x));
  if (made[1]) PetscCall(PetscFree(y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
