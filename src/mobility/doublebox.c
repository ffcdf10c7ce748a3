#include "mobility/doublebox.h"
#include "base/lanes.h"
#include "numerics/blas.h"

#define AT_ONCE 64 /* markers */

#define ALL_OFF 1e-4 /* of the largest value: what a square may be off by that has all that the box adds */

PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, PetscBool error,
                               PetscBool all, DoubleBox *out) {
  DoubleBox b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->markers = markers;
  b->lattice = *lattice;
  b->error = error;
  b->asked = all;
  for (int k = 0; k < 2; k++) {
    b->table[k].components = BOX_COMPONENTS;
    b->region[k] = (BoxRegion){.comm = spec->comm,
                               .grid = markers->grid,
                               .whole = &b->table[k],
                               .off = k ? ALL_OFF : BOX_REGION_OFF,
                               .all = k ? PETSC_TRUE : PETSC_FALSE};
  }
  PetscCall(PetvesEvent("BoxTable", &b->make));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxDestroy(DoubleBox *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  for (int all = 0; all < 2; all++) {
    PetscCall(BoxRegionDestroy(&(*box)->region[all]));
    PetscCall(BoxTableDestroy(&(*box)->table[all]));
  }
  PetscCall(PetscFree3((*box)->value, (*box)->function, (*box)->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeTable(DoubleBox b, PetscBool all) {
  BoxLattice lattice = b->lattice;
  PetscFunctionBeginUser;
  if (b->table[all].l) PetscFunctionReturn(PETSC_SUCCESS);
  lattice.all = all;
  PetscCall(PetscLogEventBegin(b->make, 0, 0, 0, 0));
  PetscCall(BoxTableCreate(b->spec, b->markers->kernel->name, &lattice, all, &b->table[all]));
  PetscCall(PetscLogEventEnd(b->make, 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The table where the markers are, and room for what they have of it. */
static PetscErrorCode TakeTable(DoubleBox b) {
  const Layout l = b->markers->layout;
  PetscBool moved, all = b->may_be_all ? BoxRegionMayBeAll(&b->region[1], l->M, b->markers->X) : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (all) {
    PetscCall(MakeTable(b, PETSC_TRUE));
    PetscCall(BoxRegionAt(&b->region[1], l->M, b->markers->X, &b->at, &moved));
    all = DoubleBoxIsAll(b);
  }
  if (!all && !b->error) b->at = NULL;
  if (!all && b->error) {
    PetscCall(MakeTable(b, PETSC_FALSE));
    PetscCall(BoxRegionAt(&b->region[0], l->M, b->markers->X, &b->at, &moved));
  }
  if (!b->at) PetscFunctionReturn(PETSC_SUCCESS);
  b->width = (b->at->functions[1] + LANES - 1) / LANES * LANES;
  const PetscInt values = l->n * (b->at->functions[0] + b->width), functions = b->at->functions[0] * b->width;
  if (values <= b->room && functions <= b->rooms && b->amplitude) PetscFunctionReturn(PETSC_SUCCESS);
  b->room = PetscMax(values, b->room);
  b->rooms = PetscMax(functions, b->rooms);
  PetscCall(PetscFree3(b->value, b->function, b->amplitude));
  PetscCall(PetscCalloc3(b->room, &b->value, BOX_COMPONENTS * b->rooms, &b->function,
                         PetscMax(b->table[0].rank, b->table[1].rank), &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Own marker k's values of the functions of x; those of y come behind. */
static PetscReal *Values(DoubleBox b, PetscInt k) {
  return b->value + k * (b->at->functions[0] + b->width);
}

/* A component's functions. */
static PetscReal *Functions(DoubleBox b, int component) {
  return b->function + component * b->at->functions[0] * b->width;
}

PetscErrorCode DoubleBoxPlace(DoubleBox b) {
  const Layout l = b->markers->layout;
  PetscFunctionBeginUser;
  PetscCall(TakeTable(b));
  const BoxTable *at = b->at;
  if (!at) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = b->markers->X + 2 * (l->first + k);
    PetscReal *value = Values(b, k);
    BoxTableFunctions(at, 0, X[0], value);
    BoxTableFunctions(at, 1, X[1], value + at->functions[0]);
    for (PetscInt j = at->functions[1]; j < b->width; j++) value[at->functions[0] + j] = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Columns of tensor part c's functions, so many vectors from the j-th number on, += of markers k .. k + count - 1,
   which have these parts of them: in registers. */
static inline void GatherColumns(const int vectors, DoubleBox b, int c, PetscInt k, PetscInt count, PetscInt j,
                                 const PetscReal part[]) {
  const PetscInt nx = b->at->functions[0], size = nx + b->width;
  PetscReal *f = Functions(b, c) + j;
  for (PetscInt i = 0; i < nx; i++, f += b->width) {
    const PetscReal *x = Values(b, k) + i, *y = Values(b, k) + nx + j;
    Lanes sum[4];
    for (int q = 0; q < vectors; q++) sum[q] = LanesAt(f + q * LANES);
    for (PetscInt m = 0; m < count; m++, x += size, y += size) {
      const PetscReal scale = part[m] * x[0];
      for (int q = 0; q < vectors; q++) sum[q] += scale * LanesAt(y + q * LANES);
    }
    for (int q = 0; q < vectors; q++) LanesPut(sum[q], f + q * LANES);
  }
}

/* Parts 2, 3, 4: the own markers' tensors in the functions. */
static void Gather(DoubleBox b, const PetscReal T[]) {
  const PetscInt n = b->markers->layout->n;
  PetscReal part[AT_ONCE];
  (void)PetscArrayzero(Functions(b, 2), DIPOLE_COUNT * b->at->functions[0] * b->width);
  for (PetscInt k = 0; k < n; k += AT_ONCE)
    for (int c = 0; c < DIPOLE_COUNT; c++) {
      const PetscInt count = PetscMin(AT_ONCE, n - k);
      PetscInt j = 0;
      for (PetscInt m = 0; m < count; m++) part[m] = T[DIPOLE_COUNT * (k + m) + c];
      for (; j + 4 * LANES <= b->width; j += 4 * LANES) GatherColumns(4, b, 2 + c, k, count, j, part);
      for (; j < b->width; j += LANES) GatherColumns(1, b, 2 + c, k, count, j, part);
    }
}

/* SUM x_i SUM f_ij y_j of so many vectors of columns. */
static inline Lanes ScatterColumns(const int vectors, PetscInt nx, PetscInt width, const PetscReal x[],
                                   const PetscReal y[], const PetscReal f[]) {
  Lanes column[4], sum[4] = {{0}, {0}, {0}, {0}};
  for (int q = 0; q < vectors; q++) column[q] = LanesAt(y + q * LANES);
  for (PetscInt i = 0; i < nx; i++, f += width)
    for (int q = 0; q < vectors; q++) sum[q] += x[i] * LanesAt(f + q * LANES);
  for (int q = 0; q < vectors; q++) sum[q] *= column[q];
  for (int q = 1; q < vectors; q++) sum[0] += sum[q];
  return sum[0];
}

/* Velocity component c of own marker k. */
static PetscReal Scatter(DoubleBox b, PetscInt k, int c) {
  const PetscInt nx = b->at->functions[0];
  const PetscReal *x = Values(b, k), *y = x + nx, *f = Functions(b, c);
  PetscInt j = 0;
  Lanes sum = {0};
  for (; j + 4 * LANES <= b->width; j += 4 * LANES) sum += ScatterColumns(4, nx, b->width, x, y + j, f + j);
  for (; j < b->width; j += LANES) sum += ScatterColumns(1, nx, b->width, x, y + j, f + j);
  return LanesSum(sum);
}

/* Where component c's functions of a block begin. */
static PetscReal *InBlock(DoubleBox b, const BoxBlock *q, int c) {
  return Functions(b, c) + q->first[c][0] * b->width + q->first[c][1];
}

/* A block's eigenvectors' amplitudes of the tensors' functions. */
static void ToAmplitudes(DoubleBox b, const BoxBlock *q) {
  PetscReal weight[DIPOLE_COUNT * BOX_BLOCK_FUNCTIONS], *w = weight;
  for (int c = 2; c < BOX_COMPONENTS; c++)
    for (PetscInt i = 0; i < q->n[0]; i++)
      for (PetscInt j = 0; j < q->n[1]; j++) *w++ = InBlock(b, q, c)[i * b->width + j];
  BoxBlockSum(q, 2, DIPOLE_COUNT, weight, b->amplitude + q->start);
}

/* The velocities' functions of a block. */
static void FromAmplitudes(DoubleBox b, const BoxBlock *q) {
  const PetscReal *Q = q->Q;
  for (int c = 0; c < 2; c++)
    for (PetscInt i = 0; i < q->n[0]; i++)
      for (PetscInt j = 0; j < q->n[1]; j++, Q += q->modes)
        InBlock(b, q, c)[i * b->width + j] = LanesDot(q->modes, b->amplitude + q->start, Q);
}

/* The velocities' functions = alpha D of the tensors', which (add) all ranks have a part of. */
static PetscErrorCode Respond(DoubleBox b, PetscBool add, PetscReal alpha) {
  const BoxTable *t = b->at;
  const PetscMPIInt size = (PetscMPIInt)(t->functions[0] * b->width), r = (PetscMPIInt)t->rank;
  const MPI_Comm comm = b->markers->layout->comm;
  PetscFunctionBeginUser;
  add = add && b->markers->layout->size > 1 ? PETSC_TRUE : PETSC_FALSE;
  if (!t->l) { /* of a square */
    if (add) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, Functions(b, 2), DIPOLE_COUNT * size, MPIU_REAL, MPI_SUM, comm));
    PetscCall(PetscArrayzero(Functions(b, 0), 2 * size));
    PetscCall(
        DenseMultAdd(PETSC_FALSE, 2 * size, DIPOLE_COUNT * size, alpha, t->block->Q, Functions(b, 2), Functions(b, 0)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt k = 0; k < t->blocks; k++) ToAmplitudes(b, &t->block[k]);
  if (add) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, r, MPIU_REAL, MPI_SUM, comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * t->l[m];
  for (PetscInt k = 0; k < t->blocks; k++) FromAmplitudes(b, &t->block[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxApply(DoubleBox b, PetscReal alpha, const PetscReal T[], PetscScalar y[]) {
  PetscFunctionBeginUser;
  Gather(b, T);
  PetscCall(Respond(b, PETSC_TRUE, alpha));
  for (PetscInt k = 0; k < 2 * b->markers->layout->n; k++) y[k] += Scatter(b, k / 2, k % 2);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Part c of a tensor at X, one, in the functions. */
static void Put(DoubleBox b, const PetscReal X[2], int c) {
  const PetscInt nx = b->at->functions[0], ny = b->at->functions[1];
  PetscReal x[BOX_FUNCTIONS], y[BOX_FUNCTIONS], *f = Functions(b, 2 + c);
  (void)PetscArrayzero(Functions(b, 2), DIPOLE_COUNT * nx * b->width);
  BoxTableFunctions(b->at, 0, X[0], x);
  BoxTableFunctions(b->at, 1, X[1], y);
  for (PetscInt i = 0; i < nx; i++)
    for (PetscInt j = 0; j < ny; j++) f[i * b->width + j] = x[i] * y[j];
}

/* Values [M][functions of x][of y] of all markers. */
static PetscErrorCode AllValues(DoubleBox b, PetscReal **values) {
  const Layout l = b->markers->layout;
  const PetscInt nx = b->at->functions[0], ny = b->at->functions[1];
  PetscReal x[BOX_FUNCTIONS], y[BOX_FUNCTIONS], *f;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->M * nx * ny, &f));
  *values = f;
  for (PetscInt k = 0; k < l->M; k++) {
    BoxTableFunctions(b->at, 0, b->markers->X[2 * k], x);
    BoxTableFunctions(b->at, 1, b->markers->X[2 * k + 1], y);
    for (PetscInt i = 0; i < nx * ny; i++) *f++ = x[i / ny] * y[i % ny];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A square's matrix D between functions, from all markers' tensors to the own markers. */
static PetscErrorCode SquareMatrix(DoubleBox b, PetscReal scale, PetscReal out[]) {
  const Layout l = b->markers->layout;
  const PetscInt size = b->at->functions[0] * b->at->functions[1];
  PetscReal *value, *given, *taken;
  PetscFunctionBeginUser;
  PetscCall(AllValues(b, &value));
  PetscCall(PetscMalloc2(2 * size * l->M, &given, l->n * l->M, &taken));
  for (int q = 0; q < 2 * DIPOLE_COUNT; q++) {
    const PetscInt part = q / 2, c = q % 2;
    if (!c)
      PetscCall(
          DenseProduct(PETSC_FALSE, 2 * size, l->M, size, b->at->block->Q + part * size * 2 * size, value, given));
    PetscCall(DenseProductWithin(PETSC_TRUE, (DenseView){value + l->first * size, size, l->n, size},
                                 (DenseView){given + c * size, size, l->M, 2 * size}, 0, taken, l->n));
    for (PetscInt j = 0; j < l->M; j++)
      for (PetscInt k = 0; k < l->n; k++)
        out[2 * ((DIPOLE_COUNT * j + part) * l->M + l->first + k) + c] += scale * taken[j * l->n + k];
  }
  PetscCall(PetscFree2(given, taken));
  PetscCall(PetscFree(value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxMatrix(DoubleBox b, PetscReal scale, PetscReal out[]) {
  const Layout l = b->markers->layout;
  PetscFunctionBeginUser;
  if (!b->at->l) {
    PetscCall(SquareMatrix(b, scale, out));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt j = 0; j < DIPOLE_COUNT * l->M; j++) {
    Put(b, b->markers->X + 2 * (j / DIPOLE_COUNT), (int)(j % DIPOLE_COUNT));
    PetscCall(Respond(b, PETSC_FALSE, scale));
    for (PetscInt k = 0; k < 2 * l->n; k++) out[2 * (j * l->M + l->first) + k] += Scatter(b, k / 2, k % 2);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
