/* The grid's periodic Green's function, and the mobility of markers made from it. */
#include "coupling/mobility.h"
#include "fluid/stokes.h"

#define LAGS (2 * KERNEL_MAX_POINTS) /* of two kernels, one spare: whole vectors */

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
  if (coupling->membrane->vesicles > 1) reach = PETSC_MAX_INT / 4 * g->h; /* vesicles may be anywhere: the whole box */
  for (int d = 0; d < 2; d++) /* two markers are at most half a contour apart; room for drift and kernels */
    m->size[d] = PetscMin(g->n[d] / 2, (PetscInt)(1.1 * reach / g->h) + 4) + 2 * KERNEL_MAX_POINTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeTable(GreenTable *t) {
  PetscFunctionBeginUser;
  for (int b = 0; b < GREEN_COUNT; b++) PetscCall(PetscFree(t->grid[b]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityForget(Mobility m) {
  PetscFunctionBeginUser;
  for (int i = 0; i < MOBILITY_CACHE; i++) PetscCall(FreeTable(&m->cache[i]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityDestroy(Mobility *mobility) {
  PetscFunctionBeginUser;
  if (!*mobility) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(MobilityForget(*mobility));
  PetscCall(FluidDestroy(&(*mobility)->periodic));
  PetscCall(PetscFree(*mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt Modulo(PetscInt i, PetscInt n) {
  return ((i % n) + n) % n;
}

/* A field's window of offsets, known to all ranks. */
static PetscErrorCode Gather(Mobility m, Field f, const PetscScalar a[], PetscReal window[]) {
  const Grid g = m->periodic->grid;
  const PetscInt sx = m->size[0], sy = m->size[1], nx = 2 * sx + 1, ny = 2 * sy + 1;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(window, nx * ny));
  for (PetscInt j = -sy; j <= sy; j++) {
    const PetscInt row = Modulo(j, g->n[1]) - g->first;
    if (row < 0 || row >= g->rows[f]) continue;
    for (PetscInt i = -sx; i <= sx; i++) window[(j + sy) * nx + i + sx] = a[row * g->columns[f] + Modulo(i, g->n[0])];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, window, (PetscMPIInt)(nx * ny), MPIU_REAL, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u: room for the force, then the velocity. */
static PetscErrorCode UnitResponse(Mobility m, Stokes stokes, int source, Vec u, Vec p, GreenTable *t) {
  const PetscScalar *a;
  PetscScalar *ra;
  const Grid g = m->periodic->grid;
  PetscFunctionBeginUser;
  PetscCall(VecSet(u, 0));
  PetscCall(VecGetArray(u, &ra));
  if (!g->rank) ra[source ? GridLocalU(g) : 0] = 1;
  PetscCall(VecRestoreArray(u, &ra));
  PetscCall(StokesSolve(stokes, u, NULL, u, p));
  PetscCall(VecGetArrayRead(u, &a));
  if (!source) {
    PetscCall(Gather(m, FIELD_U, a, t->grid[GREEN_UU]));
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->grid[GREEN_VU]));
  } else
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->grid[GREEN_VV]));
  PetscCall(VecRestoreArrayRead(u, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildTable(Mobility m, PetscReal alpha, GreenTable *t) {
  const PetscInt size = (2 * m->size[0] + 1) * (2 * m->size[1] + 1);
  Stokes stokes;
  Vec u, p;
  PetscFunctionBeginUser;
  for (int b = 0; b < GREEN_COUNT; b++) PetscCall(PetscMalloc1(size, &t->grid[b]));
  t->alpha = alpha;
  PetscCall(FluidSetTimeCoefficient(m->periodic, alpha));
  PetscCall(StokesCreate(m->periodic, &stokes));
  PetscCall(DMCreateGlobalVector(m->periodic->grid->velocity, &u));
  PetscCall(DMCreateGlobalVector(m->periodic->grid->da[FIELD_P], &p));
  for (int source = 0; source < 2; source++) PetscCall(UnitResponse(m, stokes, source, u, p, t));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscCall(StokesDestroy(&stokes));
  m->built++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilitySetTables(Mobility m, const PetscReal alpha[MOBILITY_CACHE]) {
  PetscFunctionBeginUser;
  for (int i = 0; i < MOBILITY_CACHE; i++) {
    PetscCall(FreeTable(&m->cache[i]));
    if (alpha[i] >= 0) PetscCall(BuildTable(m, alpha[i], &m->cache[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Made, and for a coefficient near enough. */
static PetscBool Serves(const GreenTable *t, PetscReal alpha) {
  return t->grid[0] && PetscAbsReal(t->alpha - alpha) <= 0.1 * alpha ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode MobilityGetTable(Mobility m, PetscReal alpha, const GreenTable **table) {
  GreenTable found = {0};
  PetscInt i = 0;
  PetscFunctionBeginUser;
  while (i < MOBILITY_CACHE - 1 && !Serves(&m->cache[i], alpha)) i++;
  if (Serves(&m->cache[i], alpha))
    found = m->cache[i];
  else {
    PetscCall(FreeTable(&m->cache[i])); /* the oldest */
    PetscCall(BuildTable(m, alpha, &found));
  }
  for (; i > 0; i--) m->cache[i] = m->cache[i - 1];
  m->cache[0] = found;
  *table = &m->cache[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Correlation of two stencils in one direction: weight[q] for offsets first + q, LAGS of them, zero past the last.
   Offsets go to the nearest image, inside the window. */
static inline void Correlate(Mobility m, int dir, const Stencil *response, const Stencil *source, PetscInt *first,
                             PetscReal weight[restrict LAGS]) {
  const PetscInt na = response->n[dir], nb = source->n[dir], count = na + nb - 1, n = m->coupling->grid->n[dir];
  const PetscInt low = response->first[dir] - source->first[dir] - nb + 1, middle = low + count / 2;
  PetscReal a[KERNEL_MAX_POINTS] = {0};
  for (PetscInt i = 0; i < na; i++) a[i] = response->weight[dir][i];
  for (int q = 0; q < LAGS; q++) weight[q] = 0;
  for (PetscInt j = 0; j < nb; j++)
    for (int i = 0; i < KERNEL_MAX_POINTS; i++) weight[i - j + nb - 1] += a[i] * source->weight[dir][j];
  *first = low;
  if (middle >= n / 2 || middle < -n / 2)
    *first -= n * (PetscInt)PetscFloorReal((PetscReal)middle / (PetscReal)n + 0.5);
  *first = PetscMax(-m->size[dir], PetscMin(*first, m->size[dir] - LAGS + 1));
}

/* SUM SUM phi(response) Green phi(source) of one component at marker k and one at marker l. */
static PetscReal Pair(Mobility m, const GreenTable *t, GreenBlock b, PetscInt k, PetscInt l) {
  const Stencil *response = &m->coupling->stencil[2 * k + (b == GREEN_UU ? 0 : 1)];
  const Stencil *source = &m->coupling->stencil[2 * l + (b == GREEN_VV ? 1 : 0)];
  const PetscInt width = 2 * m->size[0] + 1;
  PetscInt i0, j0;
  PetscReal wx[LAGS], wy[LAGS], line[LAGS] = {0}, sum = 0;
  Correlate(m, 0, response, source, &i0, wx);
  Correlate(m, 1, response, source, &j0, wy);
  const PetscReal *row = t->grid[b] + (j0 + m->size[1]) * width + i0 + m->size[0];
  for (int j = 0; j < LAGS; j++, row += width) /* weights past the last are zero */
    for (int i = 0; i < LAGS; i++) line[i] += wy[j] * row[i];
  for (int i = 0; i < LAGS; i++) sum += wx[i] * line[i];
  return sum;
}

PetscErrorCode MobilityAssemble(Mobility m, const GreenTable *t, PetscInt first, PetscInt n, PetscReal Mob[]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt l = 0; l < n; l++) {
      PetscReal *block = Mob + 2 * k * 2 * n + 2 * l, *mirror = Mob + 2 * l * 2 * n + 2 * k;
      if (l >= k) { /* symmetric */
        block[0] = mirror[0] = Pair(m, t, GREEN_UU, first + k, first + l);
        block[2 * n + 1] = mirror[2 * n + 1] = Pair(m, t, GREEN_VV, first + k, first + l);
      }
      block[2 * n] = mirror[1] = Pair(m, t, GREEN_VU, first + k, first + l);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}
