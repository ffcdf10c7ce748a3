#include "coupling/boxpart.h"

PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, BoxPart *out) {
  BoxPart b;
  PetscLogEvent event;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->markers = markers;
  b->ramp = spec->inertia == INERTIA_NONE ? PETSC_FALSE : PETSC_TRUE;
  PetscCall(PetvesEvent("BoxTable", &event));
  PetscCall(PetscLogEventBegin(event, 0, 0, 0, 0));
  PetscCall(BoxTableCreate(spec, markers->kernel->name, &b->table));
  PetscCall(PetscLogEventEnd(event, 0, 0, 0, 0));
  PetscCall(PetscMalloc2(2 * markers->layout->n * b->table.rank, &b->A, b->table.rank, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxPartDestroy(BoxPart *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxTableDestroy(&(*box)->table));
  PetscCall(PetscFree2((*box)->A, (*box)->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 0 up to low, 1 from high on. */
static PetscReal SmoothStep(PetscReal x, PetscReal low, PetscReal high) {
  const PetscReal t = PetscMax(0, PetscMin(1, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
}

/* The part of D that a marker has: less where the table ends, one cell of its coarser grid from its last places, and in
   unsteady flow up to four cells from a wall, where the force's smear in the inertia would make C + D indefinite. */
static PetscReal Fade(BoxPart b, const PetscReal X[2]) {
  const Grid g = b->markers->grid;
  const BoxTable *t = &b->table;
  const PetscReal last = t->H > g->h * (1 + 1e-9) ? t->H
                                                  : 0.5 * g->h; /* the table of the run's own grid ends at its limit */
  PetscReal fade = 1;
  for (int d = 0; d < 2; d++) {
    const PetscReal *x = &X[d], end = t->axis[d].low - g->lo[d] - (last < t->H ? last : 0);
    if (!g->wall[d]) continue;
    const PetscReal off = PetscMin(*x - g->lo[d], g->hi[d] - *x);
    fade *= SmoothStep(off, end, end + last);
    if (b->ramp) fade *= SmoothStep(off, g->h, 4 * g->h);
  }
  return fade;
}

/* a[modes] += weights of one velocity component's functions times the block's vectors. */
static void AddBlock(const BoxBlock *q, int c, const PetscReal vx[], const PetscReal vy[], PetscReal fade,
                     PetscReal a[]) {
  const PetscInt modes = q->modes;
  const PetscReal *row = q->Q + c * q->n[0] * q->n[1] * modes, *y = vy + q->first[c][1];
  for (PetscInt i = 0; i < q->n[0]; i++) {
    const PetscReal x = fade * vx[q->first[c][0] + i];
    PetscInt j = 0;
    for (; j + 4 <= q->n[1]; j += 4, row += 4 * modes) /* four at once: a is read and written a quarter as often */
      for (PetscInt m = 0; m < modes; m++)
        a[m] += x * (y[j] * row[m] + y[j + 1] * row[modes + m] + y[j + 2] * row[2 * modes + m] +
                     y[j + 3] * row[3 * modes + m]);
    for (; j < q->n[1]; j++, row += modes)
      for (PetscInt m = 0; m < modes; m++) a[m] += x * y[j] * row[m];
  }
}

/* The rows A[2][rank] of marker k, from its functions' values. */
static void PlaceMarker(BoxPart b, PetscInt k, PetscReal A[]) {
  const BoxTable *t = &b->table;
  const PetscReal *X = b->markers->X + 2 * k, fade = Fade(b, X);
  PetscReal vx[BOX_FUNCTIONS], vy[BOX_FUNCTIONS];
  (void)PetscArrayzero(A, 2 * t->rank);
  if (fade == 0) return;
  BoxTableFunctions(t, 0, X[0], vx);
  BoxTableFunctions(t, 1, X[1], vy);
  for (PetscInt q = 0; q < t->blocks; q++)
    for (int c = 0; c < 2; c++) AddBlock(&t->block[q], c, vx, vy, fade, A + c * t->rank + t->block[q].start);
}

void BoxPartPlace(BoxPart b) {
  const Layout l = b->markers->layout;
  for (PetscInt k = 0; k < l->n; k++) PlaceMarker(b, l->first + k, b->A + 2 * k * b->table.rank);
}

/* SUM l x in four lanes. */
static PetscReal Sum(PetscInt r, const PetscReal l[], const PetscReal x[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * x[m + q];
  for (; m < r; m++) rest += l[m] * x[m];
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}

PetscErrorCode BoxPartApply(BoxPart b, PetscReal alpha, const PetscScalar F[], PetscScalar U[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->amplitude, r));
  for (PetscInt k = 0; k < 2 * l->n; k++)
    for (PetscInt m = 0; m < r; m++) b->amplitude[m] += b->A[k * r + m] * F[k];
  if (l->size > 1) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, (PetscMPIInt)r, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * b->table.l[m];
  for (PetscInt k = 0; k < 2 * l->n; k++) U[k] += Sum(r, b->amplitude, b->A + k * r);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SUM l x y in four lanes, the same bits with x and y exchanged. */
static PetscReal Product(PetscInt r, const PetscReal l[], const PetscReal x[], const PetscReal y[]) {
  PetscReal sum[4] = {0}, rest = 0;
  PetscInt m = 0;
  for (; m + 4 <= r; m += 4)
    for (int q = 0; q < 4; q++) sum[q] += l[m + q] * (x[m + q] * y[m + q]);
  for (; m < r; m++) rest += l[m] * (x[m] * y[m]);
  return sum[0] + sum[1] + sum[2] + sum[3] + rest;
}

PetscErrorCode BoxPartAdd(BoxPart b, PetscReal scale, PetscInt first, PetscInt n, PetscInt begin, PetscInt end,
                          PetscReal out[]) {
  const Layout l = b->markers->layout;
  const PetscInt r = b->table.rank;
  const PetscBool own = first >= l->first && first + n <= l->first + l->n ? PETSC_TRUE : PETSC_FALSE;
  PetscReal *all = own ? b->A + 2 * (first - l->first) * r : NULL;
  PetscFunctionBeginUser;
  if (!own) PetscCall(PetscMalloc1(2 * n * r, &all));
  for (PetscInt k = 0; k < n && !own; k++) PlaceMarker(b, first + k, all + 2 * k * r);
  for (PetscInt j = 0; j < 2 * n; j++)
    for (PetscInt i = 2 * (begin - first); i < 2 * (end - first); i++)
      out[j * 2 * n + i] += scale * Product(r, b->table.l, all + i * r, all + j * r);
  if (!own) PetscCall(PetscFree(all));
  PetscFunctionReturn(PETSC_SUCCESS);
}
