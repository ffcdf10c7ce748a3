#include "fluid/stokes/stokes.h"

struct _p_Stokes {
  Fluid fluid;
  Stream stream; /* NULL unless both fast solves are fftw_tridiagonal's */
};

Stream StokesStream(Stokes s) {
  return s->stream;
}

PetscErrorCode StokesCreate(Fluid fluid, Stokes *out) {
  Stokes s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  if (fluid->tridiagonal) PetscCall(StreamCreate(fluid, &s->stream));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesDestroy(Stokes *stokes) {
  PetscFunctionBeginUser;
  if (!*stokes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StreamDestroy(&(*stokes)->stream));
  PetscCall(PetscFree(*stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of a force and of its velocity on the grid. */
typedef struct {
  Grid grid;
  const PetscScalar *r;
  Rows u;
  PetscScalar *w;
} GridFlow;

static const PetscScalar *StokesForce(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const GridFlow *a = (const GridFlow *)ctx;
  (void)work;
  return f == FIELD_U ? RowAt(&a->u, j) : a->r + GridRowStart(a->grid, f, j);
}

static void TakeVelocity(void *ctx, Field f, PetscInt j, PetscScalar row[]) {
  GridFlow *a = (GridFlow *)ctx;
  (void)PetscArraycpy(a->w + GridRowStart(a->grid, f, j), row, a->grid->columns[f]);
}

PetscErrorCode StokesVelocity(Stokes s, Vec r, Vec w) {
  GridFlow a = {.grid = s->fluid->grid};
  const PetscInt all = a.grid->rows[FIELD_U];
  const StreamRows rows = {
      .ctx = &a, .forced = {0, all}, .wanted = {0, all}, .force = StokesForce, .velocity = TakeVelocity};
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &a.r)); /* r may be w: all forces are asked for before the first velocity is there */
  PetscCall(VecGetArray(w, &a.w));
  PetscCall(GridRows(a.grid, FIELD_U, a.r, &a.u));
  PetscCall(StreamSolve(s->stream, &rows, NULL));
  PetscCall(VecRestoreArray(w, &a.w));
  PetscCall(VecRestoreArrayRead(r, &a.r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r = 0 but on the faces next to walls that run along the velocity; walls are in y, or both ways. */
static PetscErrorCode KeepNextToWalls(Grid g, Vec r) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(r, &a));
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++)
    if (g->first + j > 0 && g->first + j < g->n[1] - 1)
      PetscCall(PetscArrayzero(a + GridRowStart(g, FIELD_U, j), g->columns[FIELD_U]));
  for (PetscInt j = 0; j < g->rows[FIELD_V]; j++)
    PetscCall(PetscArrayzero(a + GridRowStart(g, FIELD_V, j) + g->wall[0], g->columns[FIELD_V] - 2 * g->wall[0]));
  PetscCall(VecRestoreArray(r, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = -G psi, psi = L^-1 r_p, and phi = alpha psi - nu r_p; rest -= H b + G phi, which is zero but next to walls. phi
   may be r_p. psi, r: work. */
static PetscErrorCode TakePotential(Fluid f, Vec r_p, Vec b, Vec phi, Vec rest, Vec psi, Vec r) {
  const Grid g = f->grid;
  PetscFunctionBeginUser;
  PetscCall(FluidSolvePoisson(f, r_p, psi));
  PetscCall(GridGradient(g, -1, psi, PETSC_FALSE, b));
  if (phi != r_p) PetscCall(VecCopy(r_p, phi));
  PetscCall(VecAXPBY(phi, f->alpha, -f->nu, psi));
  if (!g->wall[1]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(GridHelmholtz(g, f->alpha, f->nu, b, r));
  PetscCall(GridGradient(g, 1, phi, PETSC_TRUE, r));
  PetscCall(KeepNextToWalls(g, r));
  PetscCall(VecAXPY(rest, -1, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesPressure(Stokes s, Vec r_u, Vec u, Vec p) {
  const Fluid f = s->fluid;
  Vec rest;
  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalVector(f->grid->velocity, &rest));
  PetscCall(GridHelmholtz(f->grid, 0, f->nu, u, rest));
  PetscCall(VecAYPX(rest, -1, r_u));
  PetscCall(GridGradientTranspose(f->grid, -1, rest, p));
  PetscCall(DMRestoreGlobalVector(f->grid->velocity, &rest));
  PetscCall(FluidSolvePoisson(f, p, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stream function's velocity of the force, the pressure of what that leaves, which is a gradient. Where r_p is not
   zero -G L^-1 r_p has the divergence and leaves a force next to the walls. Such a force moves next to nothing, which
   comes from chi by differences of large numbers, 1e-16 (n_y)^3 of it: twice. */
static PetscErrorCode SolveByStream(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  const Fluid f = s->fluid;
  const Grid g = f->grid;
  const int rounds = r_p && g->wall[1] ? 2 : 1;
  Vec rest, w, r, psi;
  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalVector(g->velocity, &rest));
  PetscCall(DMGetGlobalVector(g->velocity, &w));
  PetscCall(DMGetGlobalVector(g->velocity, &r));
  PetscCall(DMGetGlobalVector(g->da[FIELD_P], &psi));
  PetscCall(VecCopy(r_u, rest));
  if (r_p)
    PetscCall(TakePotential(f, r_p, u, p, rest, psi, r));
  else {
    PetscCall(VecSet(u, 0));
    PetscCall(VecSet(p, 0));
  }
  for (int round = 0; round < rounds; round++) {
    if (round) PetscCall(GridGradient(g, -1, psi, PETSC_TRUE, rest));
    PetscCall(StokesVelocity(s, rest, w));
    PetscCall(VecAXPY(u, 1, w));
    PetscCall(GridHelmholtz(g, f->alpha, f->nu, w, r));
    PetscCall(VecAXPY(rest, -1, r));
    PetscCall(GridGradientTranspose(g, -1, rest, psi));
    PetscCall(FluidSolvePoisson(f, psi, psi));
    PetscCall(VecAXPY(p, 1, psi));
  }
  PetscCall(DMRestoreGlobalVector(g->da[FIELD_P], &psi));
  PetscCall(DMRestoreGlobalVector(g->velocity, &r));
  PetscCall(DMRestoreGlobalVector(g->velocity, &w));
  PetscCall(DMRestoreGlobalVector(g->velocity, &rest));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w = H^-1 r_u;  q = r_p - G^T w;  psi = L^-1 q, the potential over alpha;  u = w - G psi;  p = alpha psi - nu q */
static PetscErrorCode Project(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  const Fluid f = s->fluid;
  Vec q;
  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalVector(f->grid->da[FIELD_P], &q));
  PetscCall(FluidSolveHelmholtz(f, r_u, u));
  PetscCall(GridGradientTranspose(f->grid, -1, u, q));
  if (r_p) PetscCall(VecAXPY(q, 1, r_p));
  PetscCall(FluidSolvePoisson(f, q, p));
  PetscCall(GridGradient(f->grid, -1, p, PETSC_TRUE, u));
  PetscCall(VecAXPBY(p, -f->nu, f->alpha, q));
  PetscCall(DMRestoreGlobalVector(f->grid->da[FIELD_P], &q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesSolve(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(s->stream ? SolveByStream(s, r_u, r_p, u, p) : Project(s, r_u, r_p, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesProject(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(s->fluid->grid->wall[0] ? Project(s, r_u, r_p, u, p) : StokesSolve(s, r_u, r_p, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
