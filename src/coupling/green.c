/* The grid's periodic Green's function and its average over kernel positions. */
#include "coupling/mobility.h"
#include "fluid/stokes.h"

/* Sub-cell positions that the table's kernels are averaged over, per direction. */
#define POSITIONS 32
#define LAGS (2 * KERNEL_MAX_POINTS + 1)

PetscErrorCode MobilityCreate(Scene scene, Coupling coupling, Mobility *out) {
  const Grid g = coupling->grid;
  Mobility m;
  PetscReal reach = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->coupling = coupling;
  m->scene = *scene;
  m->scene.bc[0] = m->scene.bc[1] = BC_PERIODIC;
  m->scene.flow.form = FORM_DISTURBANCE;
  PetscCall(FluidCreate(&m->scene, &m->periodic));
  for (PetscInt v = 0; v < coupling->membrane->vesicles; v++) reach = PetscMax(reach, coupling->membrane->L0[v] / 2);
  for (int d = 0; d < 2; d++) /* two markers are at most half a contour apart; room for kernels, interpolation, drift */
    m->size[d] = PetscMin(g->n[d] / 2 + 1, (PetscInt)(1.1 * reach / g->h) + 2 * LAGS);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeTable(GreenTable *t) {
  PetscFunctionBeginUser;
  for (int b = 0; b < GREEN_COUNT; b++) {
    PetscCall(PetscFree(t->grid[b]));
    PetscCall(PetscFree(t->table[b]));
  }
  t->a0 = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityDestroy(Mobility *mobility) {
  PetscFunctionBeginUser;
  if (!*mobility) PetscFunctionReturn(PETSC_SUCCESS);
  for (int i = 0; i < MOBILITY_CACHE; i++) PetscCall(FreeTable(&(*mobility)->cache[i]));
  PetscCall(FluidDestroy(&(*mobility)->periodic));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A quarter of a field's rows, known to all ranks. */
static PetscErrorCode Gather(Mobility m, Field f, const PetscScalar a[], PetscReal quarter[]) {
  const Grid g = m->periodic->grid;
  const PetscInt nx = m->size[0] + 1, ny = m->size[1] + 1;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(quarter, nx * ny));
  for (PetscInt j = 0; j < g->rows[f] && j + g->first < ny; j++)
    for (PetscInt i = 0; i < nx && i < g->n[0]; i++) quarter[(j + g->first) * nx + i] = a[j * g->columns[f] + i];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, quarter, (PetscMPIInt)(nx * ny), MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Offset folded into the quarter, -1 in *sign where an odd function changes sign. A vu offset i stands for the
   displacement i - 1/2 in x and i + 1/2 in y (shift). */
static PetscInt Fold(PetscInt i, PetscInt n, PetscInt shift, PetscBool odd, PetscReal *sign) {
  const PetscInt low = shift > 0 ? -(n / 2) : (shift < 0 ? 1 - n / 2 : -(n / 2)); /* first offset of a period */
  i = ((i - low) % n + n) % n + low;
  *sign = 1;
  if (shift ? (shift < 0 ? i < 1 : i < 0) : i < 0) {
    i = -i - shift;
    if (odd) *sign = -1;
  }
  return i;
}

static void FoldBlock(const Mobility m, GreenBlock b, int dir, PetscInt i, PetscInt *index, PetscReal *sign) {
  const PetscInt shift = b == GREEN_VU ? (dir ? 1 : -1) : 0;
  *index = PetscMin(Fold(i, m->coupling->grid->n[dir], shift, b == GREEN_VU ? PETSC_TRUE : PETSC_FALSE, sign),
                    m->size[dir]);
}

static PetscErrorCode UnitResponse(Mobility m, Stokes stokes, int source, Vec r, Vec u, Vec p, GreenTable *t) {
  const PetscScalar *a;
  PetscScalar *ra;
  const Grid g = m->periodic->grid;
  PetscFunctionBeginUser;
  PetscCall(VecSet(r, 0));
  PetscCall(VecGetArray(r, &ra));
  if (!g->rank) ra[source ? GridLocalU(g) : 0] = 1;
  PetscCall(VecRestoreArray(r, &ra));
  PetscCall(StokesSolve(stokes, r, NULL, u, p));
  PetscCall(VecGetArrayRead(u, &a));
  if (!source) {
    PetscCall(Gather(m, FIELD_U, a, t->grid[GREEN_UU]));
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->grid[GREEN_VU]));
  } else
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->grid[GREEN_VV]));
  PetscCall(VecRestoreArrayRead(u, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Mean correlation of two kernels' weights over sub-cell positions: lag[q + KERNEL_MAX_POINTS] for indices q apart. */
static void Correlation(const Kernel *kernel, int a, int b, int dir, PetscReal lag[LAGS]) {
  for (int q = 0; q < LAGS; q++) lag[q] = 0;
  for (int s = 0; s < POSITIONS; s++) {
    const PetscReal x = (s + 0.5) / POSITIONS;
    PetscReal wa[KERNEL_MAX_POINTS], wb[KERNEL_MAX_POINTS];
    PetscInt fa, fb;
    const PetscInt na = (a == dir ? kernel->along : kernel->across)(x - (a == dir ? 1.0 : 0.5), &fa, wa);
    const PetscInt nb = (b == dir ? kernel->along : kernel->across)(x - (b == dir ? 1.0 : 0.5), &fb, wb);
    for (PetscInt i = 0; i < na; i++)
      for (PetscInt j = 0; j < nb; j++) lag[fa + i - fb - j + KERNEL_MAX_POINTS] += wa[i] * wb[j] / POSITIONS;
  }
}

/* table(d) = SUM lag_x lag_y grid(d + lag), one direction after the other. */
static PetscErrorCode Average(Mobility m, GreenBlock b, const PetscReal in[], PetscReal out[]) {
  const int response = b == GREEN_UU ? 0 : 1, source = b == GREEN_VV ? 1 : 0;
  const PetscInt nx = m->size[0] + 1, ny = m->size[1] + 1;
  PetscReal lag[LAGS], *half, sign;
  PetscInt i;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(nx * ny, &half));
  PetscCall(PetscArrayzero(out, nx * ny));
  Correlation(m->coupling->kernel, response, source, 0, lag);
  for (PetscInt d = 0; d < nx; d++)
    for (int q = 0; q < LAGS; q++) {
      FoldBlock(m, b, 0, d + q - KERNEL_MAX_POINTS, &i, &sign);
      for (PetscInt j = 0; j < ny; j++) half[j * nx + d] += sign * lag[q] * in[j * nx + i];
    }
  Correlation(m->coupling->kernel, response, source, 1, lag);
  for (PetscInt d = 0; d < ny; d++)
    for (int q = 0; q < LAGS; q++) {
      FoldBlock(m, b, 1, d + q - KERNEL_MAX_POINTS, &i, &sign);
      for (PetscInt k = 0; k < nx; k++) out[d * nx + k] += sign * lag[q] * half[i * nx + k];
    }
  PetscCall(PetscFree(half));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildTable(Mobility m, PetscReal a0, GreenTable *t) {
  const PetscInt size = (m->size[0] + 1) * (m->size[1] + 1);
  Stokes stokes;
  Vec r, u, p;
  PetscFunctionBeginUser;
  for (int b = 0; b < GREEN_COUNT; b++) {
    PetscCall(PetscMalloc1(size, &t->grid[b]));
    PetscCall(PetscMalloc1(size, &t->table[b]));
  }
  t->a0 = a0;
  PetscCall(FluidSetTimeCoefficient(m->periodic, a0));
  PetscCall(StokesCreate(m->periodic, &stokes));
  PetscCall(DMCreateGlobalVector(m->periodic->grid->velocity, &r));
  PetscCall(VecDuplicate(r, &u));
  PetscCall(DMCreateGlobalVector(m->periodic->grid->da[FIELD_P], &p));
  for (int source = 0; source < 2; source++) PetscCall(UnitResponse(m, stokes, source, r, u, p, t));
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscCall(StokesDestroy(&stokes));
  for (int b = 0; b < GREEN_COUNT; b++) PetscCall(Average(m, (GreenBlock)b, t->grid[b], t->table[b]));
  m->built++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityGetTable(Mobility m, PetscReal a0, const GreenTable **table) {
  GreenTable found = {0};
  PetscInt i = 0;
  PetscFunctionBeginUser;
  while (i < MOBILITY_CACHE - 1 && !(m->cache[i].a0 > 0 && PetscAbsReal(m->cache[i].a0 / a0 - 1) < 0.1)) i++;
  if (m->cache[i].a0 > 0 && PetscAbsReal(m->cache[i].a0 / a0 - 1) < 0.1)
    found = m->cache[i];
  else {
    PetscCall(FreeTable(&m->cache[i])); /* the oldest */
    PetscCall(BuildTable(m, a0, &found));
  }
  for (; i > 0; i--) m->cache[i] = m->cache[i - 1];
  m->cache[0] = found;
  *table = &m->cache[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Correlation of two stencils in one direction, with the folded offsets: index, weight (sign included); returns the
 * count. */
static PetscInt Correlate(Mobility m, GreenBlock b, int dir, const Stencil *response, const Stencil *source,
                          PetscInt index[], PetscReal weight[]) {
  const PetscInt na = response->n[dir], nb = source->n[dir], n = na + nb - 1;
  for (PetscInt q = 0; q < n; q++) {
    PetscReal sum = 0, sign;
    for (PetscInt i = PetscMax(0, q - nb + 1); i < PetscMin(na, q + 1); i++)
      sum += response->weight[dir][i] * source->weight[dir][i - q + nb - 1];
    FoldBlock(m, b, dir, response->first[dir] - source->first[dir] + q - nb + 1, &index[q], &sign);
    weight[q] = sign * sum;
  }
  return n;
}

static PetscReal NearPair(Mobility m, const GreenTable *t, GreenBlock b, PetscInt k, PetscInt l) {
  const Stencil *response = &m->coupling->stencil[2 * k + (b == GREEN_UU ? 0 : 1)];
  const Stencil *source = &m->coupling->stencil[2 * l + (b == GREEN_VV ? 1 : 0)];
  PetscInt ix[LAGS], iy[LAGS];
  PetscReal wx[LAGS], wy[LAGS], sum = 0;
  const PetscInt nx = Correlate(m, b, 0, response, source, ix, wx), ny = Correlate(m, b, 1, response, source, iy, wy);
  for (PetscInt j = 0; j < ny; j++) {
    const PetscReal *row = t->grid[b] + iy[j] * (m->size[0] + 1);
    PetscReal line = 0;
    for (PetscInt i = 0; i < nx; i++) line += wx[i] * row[ix[i]];
    sum += wy[j] * line;
  }
  return sum;
}

/* Cubic Lagrange weights at x in [0,1) for the points -1, 0, 1, 2. */
static void Cubic(PetscReal x, PetscReal w[4]) {
  w[0] = -x * (x - 1) * (x - 2) / 6;
  w[1] = (x + 1) * (x - 1) * (x - 2) / 2;
  w[2] = -(x + 1) * x * (x - 2) / 2;
  w[3] = (x + 1) * x * (x - 1) / 6;
}

/* Table index of the displacement i in whole cells: even, or odd about zero. */
static PetscInt FoldTable(Mobility m, GreenBlock b, int dir, PetscInt i, PetscReal *sign) {
  return PetscMin(Fold(i, m->coupling->grid->n[dir], 0, b == GREEN_VU ? PETSC_TRUE : PETSC_FALSE, sign), m->size[dir]);
}

static PetscReal FarPair(Mobility m, const GreenTable *t, GreenBlock b, const PetscReal d[2]) {
  PetscInt index[2][4];
  PetscReal weight[2][4], sum = 0;
  for (int dir = 0; dir < 2; dir++) {
    const PetscInt below = (PetscInt)PetscFloorReal(d[dir]);
    Cubic(d[dir] - below, weight[dir]);
    for (int q = 0; q < 4; q++) {
      PetscReal sign;
      index[dir][q] = FoldTable(m, b, dir, below - 1 + q, &sign);
      weight[dir][q] *= sign;
    }
  }
  for (int j = 0; j < 4; j++)
    for (int i = 0; i < 4; i++)
      sum += weight[1][j] * weight[0][i] * t->table[b][index[1][j] * (m->size[0] + 1) + index[0][i]];
  return sum;
}

PetscErrorCode MobilityAssemble(Mobility m, const GreenTable *t, const PetscScalar X[], PetscInt v, PetscReal Mob[]) {
  const Grid g = m->coupling->grid;
  const PetscInt first = m->coupling->membrane->start[v], n = m->coupling->membrane->start[v + 1] - first;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++) {
      PetscReal d[2], distance2 = 0, value[GREEN_COUNT];
      for (int dir = 0; dir < 2; dir++) {
        d[dir] = (X[2 * (first + k) + dir] - X[2 * (first + l) + dir]) / g->h;
        distance2 += PetscSqr(d[dir] - g->n[dir] * PetscFloorReal(d[dir] / g->n[dir] + 0.5)); /* nearest image */
      }
      for (int b = 0; b < GREEN_COUNT; b++) {
        if (b != GREEN_VU && l < k) continue; /* symmetric */
        value[b] = distance2 < PetscSqr(MOBILITY_NEAR) ? NearPair(m, t, (GreenBlock)b, first + k, first + l)
                                                       : FarPair(m, t, (GreenBlock)b, d);
      }
      if (l >= k) {
        Mob[2 * k * 2 * n + 2 * l] = Mob[2 * l * 2 * n + 2 * k] = value[GREEN_UU];
        Mob[(2 * k + 1) * 2 * n + 2 * l + 1] = Mob[(2 * l + 1) * 2 * n + 2 * k + 1] = value[GREEN_VV];
      }
      Mob[(2 * k + 1) * 2 * n + 2 * l] = Mob[2 * l * 2 * n + 2 * k + 1] = value[GREEN_VU];
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
