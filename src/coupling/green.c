/* The grid's periodic Green's function, and the mobility of markers made from it. */
#include "coupling/mobility.h"
#include "fluid/stokes.h"

PetscErrorCode MobilityCreate(const FluidSpec *spec, Coupling coupling, Mobility *out) {
  const Grid g = coupling->fluid->grid;
  const Layout l = coupling->membrane->layout;
  FluidSpec box = *spec;
  Mobility m;
  PetscReal reach = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&m));
  *out = m;
  m->coupling = coupling;
  box.bc[0] = box.bc[1] = BC_PERIODIC;
  box.form = FORM_DISTURBANCE;
  /* the table is for a preconditioner: by the default solver, which cannot fail, whatever solves the steps */
  PetscCall(PetscStrncpy(box.helmholtz, "fftw_tridiagonal", sizeof(box.helmholtz)));
  PetscCall(PetscStrncpy(box.poisson, "fftw_tridiagonal", sizeof(box.poisson)));
  PetscCall(FluidCreate(&box, &m->periodic));
  for (PetscInt v = 0; v < l->bodies; v++) reach = PetscMax(reach, coupling->membrane->L0[v] / 2);
  if (l->bodies > 1) reach = PETSC_MAX_INT / 4 * g->h; /* vesicles may be anywhere: the whole box */
  for (int d = 0; d < 2; d++) /* two markers are at most half a contour apart; room for drift and kernels */
    m->size[d] = PetscMin(g->n[d] / 2, (PetscInt)(1.1 * reach / g->h) + 4) + 2 * KERNEL_MAX_POINTS;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MobilityForget(Mobility m) {
  PetscFunctionBeginUser;
  for (int i = 0; i < MOBILITY_CACHE; i++) PetscCall(OffsetTableDestroy(&m->cache[i].offset));
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
    PetscCall(Gather(m, FIELD_U, a, t->offset.value[OFFSET_UU]));
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->offset.value[OFFSET_VU]));
  } else
    PetscCall(Gather(m, FIELD_V, a + GridLocalU(g), t->offset.value[OFFSET_VV]));
  PetscCall(VecRestoreArrayRead(u, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BuildTable(Mobility m, PetscReal alpha, GreenTable *t) {
  Stokes stokes;
  Vec u, p;
  PetscFunctionBeginUser;
  PetscCall(OffsetTableCreate(m->size, &t->offset));
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
    PetscCall(OffsetTableDestroy(&m->cache[i].offset));
    if (alpha[i] >= 0) PetscCall(BuildTable(m, alpha[i], &m->cache[i]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Made, and for a coefficient near enough. */
static PetscBool Serves(const GreenTable *t, PetscReal alpha) {
  return t->offset.value[0] && PetscAbsReal(t->alpha - alpha) <= 0.1 * alpha ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode MobilityGetTable(Mobility m, PetscReal alpha, const GreenTable **table) {
  GreenTable found = {0};
  PetscInt i = 0;
  PetscFunctionBeginUser;
  while (i < MOBILITY_CACHE - 1 && !Serves(&m->cache[i], alpha)) i++;
  if (Serves(&m->cache[i], alpha))
    found = m->cache[i];
  else {
    PetscCall(OffsetTableDestroy(&m->cache[i].offset)); /* the oldest */
    PetscCall(BuildTable(m, alpha, &found));
  }
  for (; i > 0; i--) m->cache[i] = m->cache[i - 1];
  m->cache[0] = found;
  *table = &m->cache[0];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SUM SUM phi(response) Green phi(source), the source being the nearest image. */
static PetscReal Pair(Mobility m, const GreenTable *t, OffsetBlock b, const PaddedStencil *response,
                      const PaddedStencil *source) {
  PetscInt shift[2];
  for (int dir = 0; dir < 2; dir++) {
    const PetscInt n = m->coupling->fluid->grid->n[dir], middle = response->first[dir] - source->first[dir] + 1;
    const PetscBool near = middle < n / 2 && middle >= -n / 2 ? PETSC_TRUE : PETSC_FALSE;
    shift[dir] = near ? 0 : -n * (PetscInt)PetscFloorReal((PetscReal)middle / (PetscReal)n + 0.5);
  }
  return StencilPairSum(&t->offset, b, response, source, shift);
}

PetscErrorCode MobilityAssemble(Mobility m, const GreenTable *t, PetscInt first, PetscInt n, PetscInt part,
                                PetscInt parts, PetscReal Mob[]) {
  PaddedStencil *p; /* component c of marker k at 2k + c */
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &p));
  for (PetscInt k = 0; k < 2 * n; k++) StencilPad(&m->coupling->markers->plain[2 * first + k], &p[k]);
  if (parts > 1) PetscCall(PetscArrayzero(Mob, 4 * n * n));
  for (PetscInt k = part; k < n; k += parts)
    for (PetscInt l = 0; l < n; l++) {
      PetscReal *block = Mob + 2 * k * 2 * n + 2 * l, *mirror = Mob + 2 * l * 2 * n + 2 * k;
      if (l >= k) { /* symmetric */
        block[0] = mirror[0] = Pair(m, t, OFFSET_UU, &p[2 * k], &p[2 * l]);
        block[2 * n + 1] = mirror[2 * n + 1] = Pair(m, t, OFFSET_VV, &p[2 * k + 1], &p[2 * l + 1]);
      }
      block[2 * n] = mirror[1] = Pair(m, t, OFFSET_VU, &p[2 * k + 1], &p[2 * l]);
    }
  PetscCall(PetscFree(p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
