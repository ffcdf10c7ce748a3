/* The Stokes solve in a box that is periodic in x:
     w = H^-1 r_u;  q = r_p - G^T w;  psi = L^-1 q;  u = w - G psi;  p = alpha psi - nu q
   and a channel's wall correction. In Fourier modes along the rows H, G, G^T and L couple neighbouring rows only, so
   everything between the first transforms and the last is done on modes, row by row. G^T and G need one row of the
   neighbouring slabs; the tridiagonal solves know it, so that their two messages are all that a solve sends. */
#include "fluid/banded.h"
#include "fluid/rowtransform.h"
#include "fluid/tridiagonal.h"

struct _p_BandedStokes {
  Fluid fluid;
  Channel channel;               /* borrowed; NULL when y is periodic */
  RowTransform t;                /* of every field: columns are the same where x is periodic */
  Tridiagonal d[3];              /* of each field; their rows y hold w and psi */
  PetscReal *one;                /* [width] ones: the scale of L's solver, whose right-hand side is normalised */
  PetscReal *symbol;             /* [width] (e^{i theta} - 1)/h of G_x, complex */
  PetscReal *line, *near, *ends; /* [width] a row; [width] v below the slab; [2][width] psi in the wall rows */
  PetscReal alpha;               /* coefficient in force; -1 none yet */
};

PetscErrorCode BandedStokesCreate(Fluid f, Channel channel, BandedStokes *out) {
  const unsigned efforts[] = {FFTW_ESTIMATE, FFTW_MEASURE, FFTW_PATIENT};
  BandedStokes b;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&b));
  *out = b;
  b->fluid = f;
  b->channel = channel;
  b->alpha = -1;
  PetscCall(RowTransformCreate(f->grid, FIELD_P, efforts[f->plan], &b->t));
  const PetscInt width = b->t->width;
  PetscCall(PetscMalloc5(width, &b->one, width, &b->symbol, width, &b->line, width, &b->near, 2 * width, &b->ends));
  for (PetscInt k = 0; k < width; k++) b->one[k] = 1;
  for (PetscInt k = 0; k < width / 2; k++) {
    const PetscReal theta = 2 * PETSC_PI * k / f->grid->n[0];
    b->symbol[2 * k] = -2 * PetscSqr(PetscSinReal(theta / 2)) / f->grid->h;
    b->symbol[2 * k + 1] = PetscSinReal(theta) / f->grid->h;
  }
  for (int k = FIELD_U; k <= FIELD_P; k++)
    PetscCall(TridiagonalCreate(f->grid, (Field)k, width, b->t->lambda, k == FIELD_P ? b->one : b->t->scale, &b->d[k]));
  PetscCall(TridiagonalSetCoefficients(b->d[FIELD_P], 0, -1, PETSC_TRUE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BandedStokesDestroy(BandedStokes *banded) {
  BandedStokes b = *banded;
  PetscFunctionBeginUser;
  if (!b) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < 3; k++) PetscCall(TridiagonalDestroy(&b->d[k]));
  PetscCall(RowTransformDestroy(&b->t));
  PetscCall(PetscFree5(b->one, b->symbol, b->line, b->near, b->ends));
  PetscCall(PetscFree(*banded));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(BandedStokes b) {
  const Fluid f = b->fluid;
  PetscFunctionBeginUser;
  if (b->channel) PetscCall(ChannelSetUp(b->channel));
  if (b->alpha == f->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  b->alpha = f->alpha;
  for (int k = FIELD_U; k <= FIELD_V; k++)
    PetscCall(TridiagonalSetCoefficients(b->d[k], f->alpha, f->nu, f->solver[k]->singular));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal *RowOf(BandedStokes b, Field f, PetscInt j) {
  return b->d[f]->y + j * b->d[f]->width;
}

/* q += -G^T w in row j: -conj(symbol) u_j + (v_j - v_{j-1})/h. */
static void AddDivergence(BandedStokes b, PetscInt j, const PetscReal v_below[], PetscReal q[]) {
  const Grid g = b->fluid->grid;
  const PetscReal *restrict u = RowOf(b, FIELD_U, j), *restrict s = b->symbol, *restrict down = v_below, c = 1 / g->h;
  const PetscReal *restrict v = RowOf(b, FIELD_V, j);
  PetscReal *restrict out = q;
  for (PetscInt k = 0; k < b->t->width; k += 2) {
    out[k] -= s[k] * u[k] + s[k + 1] * u[k + 1];
    out[k + 1] -= s[k] * u[k + 1] - s[k + 1] * u[k];
  }
  if (j < g->rows[FIELD_V])
    for (PetscInt k = 0; k < b->t->width; k++) out[k] += c * v[k];
  if (down)
    for (PetscInt k = 0; k < b->t->width; k++) out[k] -= c * down[k];
}

/* v in the row below row j: NULL at a wall. */
static const PetscReal *Below(BandedStokes b, PetscInt j) {
  if (j > 0) return RowOf(b, FIELD_V, j - 1);
  return b->fluid->grid->below == MPI_PROC_NULL ? NULL : b->near;
}

/* w = H^-1 r_u on modes, into the rows of y. */
static PetscErrorCode Helmholtz(BandedStokes b, const PetscScalar r[]) {
  const Grid g = b->fluid->grid;
  const PetscScalar *start[2] = {r, r + GridLocalU(g)};
  PetscFunctionBeginUser;
  for (int f = 0; f < 3; f++) PetscCall(TridiagonalReserve(b->d[f]));
  for (int f = 0; f < 2; f++) {
    for (PetscInt j = 0; j < g->rows[f]; j++) {
      RowTransformForward(b->t, start[f] + j * g->columns[f]);
      TridiagonalUp(b->d[f], j, b->t->modes);
    }
    PetscCall(TridiagonalBegin(b->d[f]));
  }
  for (int f = 0; f < 2; f++) {
    PetscCall(TridiagonalEnd(b->d[f]));
    for (PetscInt j = g->rows[f] - 1; j >= 0; j--) TridiagonalDown(b->d[f], j, RowOf(b, (Field)f, j));
  }
  if (g->below != MPI_PROC_NULL) TridiagonalBelow(b->d[FIELD_V], RowOf(b, FIELD_V, 0), b->near);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* q = r_p - G^T w in row j. Transforms are not normalised, w is. */
static void RightHandSide(BandedStokes b, PetscInt j, const PetscScalar r_p[], PetscReal q[]) {
  const PetscInt columns = b->fluid->grid->columns[FIELD_P];
  for (PetscInt k = 0; k < b->t->width; k++) q[k] = 0;
  if (r_p) {
    RowTransformForward(b->t, r_p + j * columns);
    for (PetscInt k = 0; k < b->t->width; k++) q[k] = b->t->scale[k] * b->t->modes[k];
  }
  AddDivergence(b, j, Below(b, j), q);
}

/* psi = L^-1 q, as far as the message; Project makes its rows. */
static PetscErrorCode Poisson(BandedStokes b, const PetscScalar r_p[]) {
  const Grid g = b->fluid->grid;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < g->rows[FIELD_P]; j++) {
    RightHandSide(b, j, r_p, b->line);
    TridiagonalUp(b->d[FIELD_P], j, b->line);
  }
  PetscCall(TridiagonalBegin(b->d[FIELD_P]));
  PetscCall(TridiagonalEnd(b->d[FIELD_P]));
  if (b->channel) {
    TridiagonalEnds(b->d[FIELD_P], b->ends, b->ends + b->t->width);
    ChannelForces(b->channel, b->ends, b->ends + b->t->width);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Row j of a field from its modes, the channel's correction added. */
static void Finish(BandedStokes b, Field f, PetscInt j, PetscScalar x[]) {
  if (b->channel) ChannelAddRow(b->channel, f, j, b->t->modes);
  RowTransformBackward(b->t, x + j * b->fluid->grid->columns[f]);
}

/* One row's modes: out = alpha psi - nu q. */
static void Pressure(PetscInt width, PetscReal alpha, PetscReal nu, const PetscReal *restrict psi,
                     const PetscReal *restrict q, PetscReal *restrict out) {
  for (PetscInt k = 0; k < width; k++) out[k] = alpha * psi[k] - nu * q[k];
}

/* One row's modes: out = w - G_x psi, G_x being a product with its symbol s. */
static void ProjectU(PetscInt width, const PetscReal *restrict s, const PetscReal *restrict w,
                     const PetscReal *restrict psi, PetscReal *restrict out) {
  for (PetscInt k = 0; k < width; k += 2) {
    out[k] = w[k] - (s[k] * psi[k] - s[k + 1] * psi[k + 1]);
    out[k + 1] = w[k + 1] - (s[k] * psi[k + 1] + s[k + 1] * psi[k]);
  }
}

/* One row's modes: out = w - G_y psi, a difference to the row above. */
static void ProjectV(PetscInt width, PetscReal h, const PetscReal *restrict w, const PetscReal *restrict psi,
                     const PetscReal *restrict above, PetscReal *restrict out) {
  const PetscReal c = 1 / h;
  for (PetscInt k = 0; k < width; k++) out[k] = w[k] - c * (above[k] - psi[k]);
}

/* u = w - G psi, p = alpha psi - nu q, in the pass down the rows that also makes psi: each row needs psi of its own and
   of the row above, which the slab above tells at the start. */
static void Project(BandedStokes b, const PetscScalar r_p[], PetscScalar u[], PetscScalar v[], PetscScalar p[]) {
  const Grid g = b->fluid->grid;
  const PetscInt width = b->t->width;
  PetscReal *modes = b->t->modes, *q = b->line, *above = b->ends;
  TridiagonalAbove(b->d[FIELD_P], above);
  for (PetscInt j = g->rows[FIELD_P] - 1; j >= 0; j--) {
    PetscReal *psi = RowOf(b, FIELD_P, j);
    TridiagonalDown(b->d[FIELD_P], j, psi);
    RightHandSide(b, j, r_p, q);
    Pressure(width, b->fluid->alpha, b->fluid->nu, psi, q, modes);
    Finish(b, FIELD_P, j, p);
    ProjectU(width, b->symbol, RowOf(b, FIELD_U, j), psi, modes);
    Finish(b, FIELD_U, j, u);
    if (j < g->rows[FIELD_V]) { /* no row of v on the upper wall */
      ProjectV(width, g->h, RowOf(b, FIELD_V, j), psi, above, modes);
      Finish(b, FIELD_V, j, v);
    }
    for (PetscInt k = 0; k < width; k++) above[k] = psi[k];
  }
}

PetscErrorCode BandedStokesSolve(BandedStokes b, Vec r_u, Vec r_p, Vec u, Vec p) {
  const PetscScalar *ra, *rp = NULL;
  PetscScalar *ua, *pa;
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(SetUp(b));
  PetscCall(VecGetArrayRead(r_u, &ra));
  PetscCall(Helmholtz(b, ra));
  PetscCall(VecRestoreArrayRead(r_u, &ra));
  PetscCall(VecGetArray(u, &ua));
  PetscCall(VecGetArray(p, &pa));
  if (r_p && r_p != p) PetscCall(VecGetArrayRead(r_p, &rp));
  PetscCall(Poisson(b, r_p == p ? pa : rp));
  Project(b, r_p == p ? pa : rp, ua, ua + GridLocalU(b->fluid->grid), pa);
  if (rp) PetscCall(VecRestoreArrayRead(r_p, &rp));
  PetscCall(VecRestoreArray(p, &pa));
  PetscCall(VecRestoreArray(u, &ua));
  for (int k = 0; k < 3; k++) b->fluid->solver[k]->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
