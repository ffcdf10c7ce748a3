#include "mobility/doublebox.h"
#include "base/lanes.h"

#define AT_ONCE 64 /* markers */

PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice, DoubleBox *out) {
  DoubleBox b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->spec = spec;
  b->markers = markers;
  b->lattice = *lattice;
  PetscCall(PetvesEvent("BoxTable", &b->make));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxDestroy(DoubleBox *box) {
  PetscFunctionBeginUser;
  if (!*box) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BoxTableDestroy(&(*box)->table));
  PetscCall(PetscFree3((*box)->value, (*box)->function, (*box)->amplitude));
  PetscCall(PetscFree(*box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make the table, and room for what the markers have of it. */
static PetscErrorCode DoubleBoxMakeTable(DoubleBox b) {
  BoxTable *t = &b->table;
  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(b->make, 0, 0, 0, 0));
  PetscCall(BoxTableCreate(b->spec, b->markers->kernel->name, &b->lattice, PETSC_FALSE, t));
  PetscCall(PetscLogEventEnd(b->make, 0, 0, 0, 0));
  b->width = (t->functions[1] + LANES - 1) / LANES * LANES;
  PetscCall(PetscCalloc3(b->markers->layout->n * (t->functions[0] + b->width), &b->value,
                         BOX_COMPONENTS * t->functions[0] * b->width, &b->function, t->rank, &b->amplitude));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Own marker k's values of the functions of x; those of y come behind. */
static PetscReal *BoxValues(DoubleBox b, PetscInt k) {
  return b->value + k * (b->table.functions[0] + b->width);
}

/* A component's functions. */
static PetscReal *BoxFunctions(DoubleBox b, int component) {
  return b->function + component * b->table.functions[0] * b->width;
}

PetscErrorCode DoubleBoxPlace(DoubleBox b) {
  const Layout l = b->markers->layout;
  PetscFunctionBeginUser;
  if (!b->table.l) PetscCall(DoubleBoxMakeTable(b));
  const BoxTable *at = &b->table;
  for (PetscInt k = 0; k < l->n; k++) {
    const PetscReal *X = b->markers->X + 2 * (l->first + k);
    PetscReal *value = BoxValues(b, k);
    BoxTableFunctions(at, 0, X[0], value);
    BoxTableFunctions(at, 1, X[1], value + at->functions[0]);
    for (PetscInt j = at->functions[1]; j < b->width; j++) value[at->functions[0] + j] = 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Functions of tensor part c += the parts of markers k .. k + count - 1, in `vectors` columns of vectors from the j-th
   number on. The sums stay in registers. */
static inline void GatherColumns(const int vectors, DoubleBox b, int c, PetscInt k, PetscInt count, PetscInt j,
                                 const PetscReal part[]) {
  const PetscInt nx = b->table.functions[0], size = nx + b->width;
  PetscReal *f = BoxFunctions(b, c) + j;
  for (PetscInt i = 0; i < nx; i++, f += b->width) {
    const PetscReal *x = BoxValues(b, k) + i, *y = BoxValues(b, k) + nx + j;
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
static void BoxGather(DoubleBox b, const PetscReal T[]) {
  const PetscInt n = b->markers->layout->n;
  PetscReal part[AT_ONCE];
  (void)PetscArrayzero(BoxFunctions(b, 2), DIPOLE_COUNT * b->table.functions[0] * b->width);
  for (PetscInt k = 0; k < n; k += AT_ONCE)
    for (int c = 0; c < DIPOLE_COUNT; c++) {
      const PetscInt count = PetscMin(AT_ONCE, n - k);
      PetscInt j = 0;
      for (PetscInt m = 0; m < count; m++) part[m] = T[DIPOLE_COUNT * (k + m) + c];
      for (; j + 4 * LANES <= b->width; j += 4 * LANES) GatherColumns(4, b, 2 + c, k, count, j, part);
      for (; j < b->width; j += LANES) GatherColumns(1, b, 2 + c, k, count, j, part);
    }
}

/* SUM x_i SUM f_ij y_j over `vectors` columns of vectors, at most 4. */
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
static PetscReal BoxScatter(DoubleBox b, PetscInt k, int c) {
  const PetscInt nx = b->table.functions[0];
  const PetscReal *x = BoxValues(b, k), *y = x + nx, *f = BoxFunctions(b, c);
  PetscInt j = 0;
  Lanes sum = {0};
  for (; j + 4 * LANES <= b->width; j += 4 * LANES) sum += ScatterColumns(4, nx, b->width, x, y + j, f + j);
  for (; j < b->width; j += LANES) sum += ScatterColumns(1, nx, b->width, x, y + j, f + j);
  return LanesSum(sum);
}

/* Where component c's functions of a block begin. */
static PetscReal *InBlock(DoubleBox b, const BoxBlock *q, int c) {
  return BoxFunctions(b, c) + q->first[c][0] * b->width + q->first[c][1];
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

/* The velocities' functions = alpha D of the tensors', of which each rank has a part. */
static PetscErrorCode BoxRespond(DoubleBox b, PetscReal alpha) {
  const BoxTable *t = &b->table;
  const PetscMPIInt r = (PetscMPIInt)t->rank;
  const MPI_Comm comm = b->markers->layout->comm;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < t->blocks; k++) ToAmplitudes(b, &t->block[k]);
  if (b->markers->layout->size > 1)
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, b->amplitude, r, MPIU_REAL, MPI_SUM, comm));
  for (PetscInt m = 0; m < r; m++) b->amplitude[m] *= alpha * t->l[m];
  for (PetscInt k = 0; k < t->blocks; k++) FromAmplitudes(b, &t->block[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleBoxApply(DoubleBox b, PetscReal alpha, const PetscReal T[], PetscScalar y[]) {
  PetscFunctionBeginUser;
  BoxGather(b, T);
  PetscCall(BoxRespond(b, alpha));
  for (PetscInt k = 0; k < 2 * b->markers->layout->n; k++) y[k] += BoxScatter(b, k / 2, k % 2);
  PetscFunctionReturn(PETSC_SUCCESS);
}
