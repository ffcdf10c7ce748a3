#include "coupling/boxpart.h"

PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, BoxPart *out) {
  BoxPart b;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->markers = markers;
  b->ramp = spec->inertia == INERTIA_NONE ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetvesEvent("BoxTable", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(BoxTableCreate(spec, markers->kernel->name, lattice, &b->table));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  b->region = (BoxRegion){.comm = spec->comm, .grid = markers->grid, .whole = &b->table};
  b->at = &b->table;
  PetscCall(PetscMalloc3(2 * markers->layout->n * b->table.rank, &b->A, b->table.rank, &b->amplitude,
                         2 * markers->layout->n, &b->X));
  for (PetscInt k = 0; k < 2 * markers->layout->n; k++) b->X[k] = NAN;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartDestroy(BoxPart *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxRegionDestroy(&(*box)->region));
  PetscCall(BoxTableDestroy(&(*box)->table));
  PetscCall(PetscFree3((*box)->A, (*box)->amplitude, (*box)->X));
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
static void PlaceMarker(BoxPart b, PetscInt k, PetscReal A[]) {
  const PetscReal *X = b->markers->X + 2 * k;
  BoxTableRows(b->at, b->markers->grid, X, Fade(b, X), 0, 2, A);
}

PetscErrorCode BoxPartPlace(BoxPart b) {
  const Layout l = b->markers->layout;
  PetscBool moved;
  PetscFunctionBeginUser;
  PetscCall(BoxRegionAt(&b->region, l->M, b->markers->X, &b->at, &moved));
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *now = b->markers->X + 2 * (l->first + k), *then = b->X + 2 * k;
    if (!moved && now[0] == then[0] && now[1] == then[1]) continue; /* at rest, on an obstacle */
    PlaceMarker(b, l->first + k, b->A + 2 * k * b->at->rank);
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
  for (PetscInt k = 0; k < 2 * l->n; k++) U[k] += BoxSum(r, b->amplitude, b->A + k * r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartAdd(BoxPart b, PetscReal scale, PetscInt first, PetscInt n, PetscInt begin, PetscInt end,
                          PetscReal out[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->at->rank;
  const PetscBool own = first >= l->first && first + n <= l->first + l->n ? PETSC_TRUE : PETSC_FALSE;
  PetscReal *all = own ? b->A + 2 * (first - l->first) * r : NULL;
  PetscFunctionBeginUser;
  if (!own) PetscCall(PetscMalloc1(2 * n * r, &all));
  for (PetscInt k = 0; k < n && !own; k++) PlaceMarker(b, first + k, all + 2 * k * r);
  for (PetscInt j = 0; j < 2 * n; j++)
    for (PetscInt i = 2 * (begin - first); i < 2 * (end - first); i++)
      out[j * 2 * n + i] += scale * BoxProduct(r, b->at->l, all + i * r, all + j * r);
  if (!own) PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
