/* The grid's periodic Green's function, and the mean mobility of two markers made from it. */
#include "precondition/mobilitytable.h"

#define LAG KERNEL_MAX_POINTS /* most cells between the entries of two stencils at one place */
#define LAGS (2 * LAG + 1)
#define PLACES 4 /* in a cell, in each direction */
#define POINTS 6 /* of an interpolation */

/* Weights by lag of the double sum over two kernels at one place, mean over the places; entry m is at m + 1, or at m +
   1/2 where the kernel is the one across. */
static void CorrelateKernels(KernelWeights response, KernelWeights source, int response_across, int source_across,
                             PetscReal weight[LAGS]) {
  for (int q = 0; q < LAGS; q++) weight[q] = 0;
  for (int s = 0; s < PLACES; s++) {
    PetscReal x[KERNEL_MAX_POINTS], y[KERNEL_MAX_POINTS];
    PetscInt i0, j0;
    const PetscReal place = (s + 0.5) / PLACES;
    const PetscInt m = response(place - (response_across ? 0.5 : 1), &i0, x),
                   n = source(place - (source_across ? 0.5 : 1), &j0, y);
    for (PetscInt i = 0; i < m; i++)
      for (PetscInt j = 0; j < n; j++) weight[LAG + i0 + i - j0 - j] += x[i] * y[j] / PLACES;
  }
}

PetscErrorCode MeanTableCreate(const OffsetTable *green, const Kernel *k, OffsetTable *mean) {
  const PetscInt size[2] = {green->size[0] - LAG, green->size[1] - LAG};
  const PetscInt nx = 2 * size[0] + 1, ny = 2 * size[1] + 1, gx = 2 * green->size[0] + 1;
  const KernelWeights weights[] = {k->along, k->across}; /* with faces at m + 1, m + 1/2 */
  PetscReal *line;
  PetscFunctionBeginUser;
  PetscCall(OffsetTableCreate(size, mean));
  PetscCall(PetscMalloc1(gx, &line));
  for (int b = 0; b < OFFSET_COUNT; b++) {
    const int response = b != OFFSET_UU, source = b == OFFSET_VV; /* component */
    PetscReal wx[LAGS], wy[LAGS];
    CorrelateKernels(weights[response], weights[source], response, source, wx);
    CorrelateKernels(weights[!response], weights[!source], !response, !source, wy);
    for (PetscInt j = 0; j < ny; j++) {
      PetscReal *out = mean->value[b] + j * nx;
      PetscCall(PetscArrayzero(line, gx));
      for (int q = 0; q < LAGS; q++)
        for (PetscInt i = 0; wy[q] != 0 && i < gx; i++) line[i] += wy[q] * green->value[b][(j + q) * gx + i];
      for (int p = 0; p < LAGS; p++)
        for (PetscInt i = 0; wx[p] != 0 && i < nx; i++) out[i] += wx[p] * line[i + p];
    }
  }
  PetscCall(PetscFree(line));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityTableCreate(const FluidSpec *spec, const Kernel *kernel, PetscReal reach, MobilityTable *out) {
  FluidSpec box = BoxGridSpec(spec);
  MobilityTable m;
  PetscInt size[2];
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->kernel = kernel;
  m->alpha = -1;
  box.bc[0] = box.bc[1] = BC_PERIODIC;
  PetscCall(FluidCreate(&box, &m->periodic));
  const Grid g = m->periodic->grid;
  for (int d = 0; d < 2; d++) /* room for drift */
    size[d] = PetscMin(g->n[d] / 2, (PetscInt)(PetscMin(1.1 * reach / g->h, PETSC_MAX_INT / 4)) + 4) + POINTS + LAG;
  PetscCall(OffsetTableCreate(size, &m->green));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityTableDestroy(MobilityTable *table) {
  MobilityTable m = *table;
  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(OffsetTableDestroy(&m->mean));
  PetscCall(OffsetTableDestroy(&m->green));
  PetscCall(FluidDestroy(&m->periodic));
  PetscCall(PetscFree(*table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt TableModulo(PetscInt i, PetscInt n) {
  return ((i % n) + n) % n;
}

/* A field's window of offsets, known to all ranks. */
static PetscErrorCode GatherWindow(Grid g, Field f, const PetscScalar a[], const PetscInt size[2], PetscReal window[]) {
  const PetscInt sx = size[0], sy = size[1], nx = 2 * sx + 1, ny = 2 * sy + 1;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(window, nx * ny));
  for (PetscInt j = -sy; j <= sy; j++) {
    const PetscInt row = TableModulo(j, g->n[1]) - g->first;
    if (row < 0 || row >= g->rows[f]) continue;
    for (PetscInt i = 0, at = TableModulo(-sx, g->n[0]); i < nx; i++, at = at + 1 < g->n[0] ? at + 1 : 0)
      window[(j + sy) * nx + i] = a[row * g->columns[f] + at];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, window, (PetscMPIInt)(nx * ny), MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The periodic box's responses to a unit force on a u face, or on a v face. */
static PetscErrorCode UnitResponse(MobilityTable m, Stokes stokes, Vec velocity, int source) {
  const OffsetTable *G = &m->green;
  const Grid g = m->periodic->grid;
  const PetscScalar *a;
  PetscScalar *r;
  PetscFunctionBeginUser;
  PetscCall(VecSet(velocity, 0));
  PetscCall(VecGetArray(velocity, &r));
  if (!g->rank) r[source ? GridLocalU(g) : 0] = 1;
  PetscCall(VecRestoreArray(velocity, &r));
  PetscCall(StokesVelocity(stokes, velocity, velocity));
  PetscCall(VecGetArrayRead(velocity, &a));
  if (!source) PetscCall(GatherWindow(g, FIELD_U, a, G->size, G->value[OFFSET_UU]));
  PetscCall(GatherWindow(g, FIELD_V, a + GridLocalU(g), G->size, G->value[source ? OFFSET_VV : OFFSET_VU]));
  PetscCall(VecRestoreArrayRead(velocity, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityTableSetUp(MobilityTable m, PetscReal alpha) {
  const Grid g = m->periodic->grid;
  Stokes stokes;
  Vec velocity;
  PetscFunctionBeginUser;
  if (alpha == m->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  m->alpha = alpha;
  PetscCall(FluidSetTimeCoefficient(m->periodic, alpha));
  PetscCall(StokesCreate(m->periodic, &stokes));
  PetscCall(DMCreateGlobalVector(g->velocity, &velocity));
  PetscCall(UnitResponse(m, stokes, velocity, 0));
  if (g->n[0] == g->n[1])
    OffsetTableTurn(&m->green);
  else
    PetscCall(UnitResponse(m, stokes, velocity, 1));
  PetscCall(OffsetTableDestroy(&m->mean));
  PetscCall(MeanTableCreate(&m->green, m->kernel, &m->mean));
  PetscCall(VecDestroy(&velocity));
  PetscCall(StokesDestroy(&stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void MeanTableAt(const OffsetTable *t, const PetscReal cells[2], PetscReal mean[3]) {
  const PetscInt nx = 2 * t->size[0] + 1;
  static const PetscReal product[POINTS] = {-120, 24, -12, 12, -24, 120}; /* of i - j, j != i */
  PetscReal w[2][POINTS];                                                 /* Lagrange's */
  PetscInt at[2];
  for (int dir = 0; dir < 2; dir++) {
    const PetscReal most = t->size[dir] - POINTS / 2;
    const PetscReal x = PetscMax(-most, PetscMin(most, cells[dir])) + t->size[dir];
    at[dir] = (PetscInt)x - POINTS / 2 + 1;
    for (int i = 0; i < POINTS; i++) {
      w[dir][i] = 1 / product[i];
      for (int j = 0; j < POINTS; j++)
        if (j != i) w[dir][i] *= x - (PetscReal)at[dir] - j;
    }
  }
  for (int b = 0; b < OFFSET_COUNT; b++) {
    mean[b] = 0;
    for (int j = 0; j < POINTS; j++) {
      const PetscReal *row = t->value[b] + (at[1] + j) * nx + at[0];
      for (int i = 0; i < POINTS; i++) mean[b] += w[1][j] * w[0][i] * row[i];
    }
  }
}

void MobilityTableAdd(MobilityTable m, PetscReal scale, const PetscReal d[2], PetscInt rows, PetscReal A[]) {
  const PetscReal h = m->periodic->grid->h, cells[2] = {d[0] / h, d[1] / h};
  PetscReal mean[3];
  MeanTableAt(&m->mean, cells, mean);
  A[0] += scale * mean[0];
  A[1] += scale * mean[2];
  A[rows] += scale * mean[2];
  A[rows + 1] += scale * mean[1];
}
