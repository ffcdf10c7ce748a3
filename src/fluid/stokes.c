#include "fluid/stokes.h"
#include "fluid/banded.h"

struct _p_Stokes {
  Fluid fluid;
  Channel channel;     /* NULL unless x is periodic and y has walls */
  BandedStokes banded; /* NULL unless x is periodic and both fast solves are fftw_tridiagonal's */
  ZeroFlux flux;       /* NULL unless the fluid may carry no flux along x */
  Stream stream;       /* where banded is, and in boxes; else NULL */
  PetscBool box;       /* walls in x and in y, and both fast solves are fftw_tridiagonal's: by the stream function */
  Vec q, psi;          /* of the solve by parts */
  Vec r, rest, w;      /* of that by the stream function: forces, and the velocity */
};

/* Walls in x and in y, of which the stream function takes care. */
static PetscBool IsBox(Fluid f) {
  return f->grid->wall[0] && f->grid->wall[1] && !f->grid->free && f->tridiagonal ? PETSC_TRUE : PETSC_FALSE;
}

const PetscReal *StokesProfile(Stokes s) {
  return s->flux ? ZeroFluxProfile(s->flux) : NULL;
}

Stream StokesStream(Stokes s) {
  return s->stream;
}

PetscErrorCode StokesCreate(Fluid fluid, Stokes *out) {
  Stokes s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  if (!fluid->grid->wall[0] && fluid->grid->wall[1]) PetscCall(ChannelCreate(fluid, &s->channel));
  if (!fluid->grid->wall[0] && fluid->tridiagonal) PetscCall(BandedStokesCreate(fluid, s->channel, &s->banded));
  if (fluid->zero_flux && !fluid->grid->wall[0] && fluid->grid->wall[1]) PetscCall(ZeroFluxCreate(fluid, &s->flux));
  s->box = IsBox(fluid);
  if (s->banded || s->box) PetscCall(StreamCreate(fluid, s->flux, &s->stream));
  if (s->banded) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->box) {
    PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &s->r));
    PetscCall(VecDuplicate(s->r, &s->rest));
    PetscCall(VecDuplicate(s->r, &s->w));
  }
  PetscCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &s->q));
  PetscCall(VecDuplicate(s->q, &s->psi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesDestroy(Stokes *stokes) {
  PetscFunctionBeginUser;
  if (!*stokes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StreamDestroy(&(*stokes)->stream));
  PetscCall(BandedStokesDestroy(&(*stokes)->banded));
  PetscCall(ChannelDestroy(&(*stokes)->channel));
  PetscCall(ZeroFluxDestroy(&(*stokes)->flux));
  PetscCall(VecDestroy(&(*stokes)->q));
  PetscCall(VecDestroy(&(*stokes)->psi));
  PetscCall(VecDestroy(&(*stokes)->r));
  PetscCall(VecDestroy(&(*stokes)->rest));
  PetscCall(VecDestroy(&(*stokes)->w));
  PetscCall(PetscFree(*stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* p = alpha psi - nu q: PETSc's loop for three vectors uses no vector instructions. */
static PetscErrorCode Pressure(Stokes s, Vec p) {
  const Grid g = s->fluid->grid;
  const PetscReal alpha = s->fluid->alpha, nu = s->fluid->nu;
  const PetscInt n = g->columns[FIELD_P] * g->rows[FIELD_P];
  const PetscScalar *psi, *q;
  PetscScalar *out;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->psi, &psi));
  PetscCall(VecGetArrayRead(s->q, &q));
  PetscCall(VecGetArrayWrite(p, &out));
  for (PetscInt k = 0; k < n; k++) out[k] = alpha * psi[k] - nu * q[k]; /* three arrays: none is another */
  PetscCall(VecRestoreArrayWrite(p, &out));
  PetscCall(VecRestoreArrayRead(s->q, &q));
  PetscCall(VecRestoreArrayRead(s->psi, &psi));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows of a force and of its velocity on the grid. */
typedef struct {
  Grid grid;
  const PetscScalar *r;
  Rows u;
  PetscScalar *w;
} GridFlow;

static const PetscScalar *Force(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const GridFlow *a = (const GridFlow *)ctx;
  (void)work;
  return f == FIELD_U ? RowAt(&a->u, j) : a->r + GridRowStart(a->grid, f, j);
}

static void TakeVelocity(void *ctx, Field f, PetscInt j, PetscScalar row[]) {
  GridFlow *a = (GridFlow *)ctx;
  (void)PetscArraycpy(a->w + GridRowStart(a->grid, f, j), row, a->grid->columns[f]);
}

/* w = the flow of the force r, without divergence. */
static PetscErrorCode FlowByRows(Stokes s, Vec r, Vec w) {
  GridFlow a = {.grid = s->fluid->grid};
  const PetscInt all = a.grid->rows[FIELD_U];
  const StreamRows rows = {.ctx = &a, .forced = {0, all}, .wanted = {0, all}, .force = Force, .velocity = TakeVelocity};
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &a.r));
  PetscCall(GridRows(a.grid, FIELD_U, a.r, &a.u));
  PetscCall(VecGetArrayWrite(w, &a.w));
  PetscCall(StreamSolve(s->stream, &rows, NULL));
  PetscCall(VecRestoreArrayWrite(w, &a.w));
  PetscCall(VecRestoreArrayRead(r, &a.r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r = 0 but on the faces next to walls that run along the velocity. */
static PetscErrorCode KeepNextToWalls(Grid g, Vec r) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(r, &a));
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++)
    if (g->first + j > 0 && g->first + j < g->n[1] - 1)
      PetscCall(PetscArrayzero(a + GridRowStart(g, FIELD_U, j), g->columns[FIELD_U]));
  for (PetscInt j = 0; j < g->rows[FIELD_V]; j++)
    PetscCall(PetscArrayzero(a + GridRowStart(g, FIELD_V, j) + 1, g->columns[FIELD_V] - 2));
  PetscCall(VecRestoreArray(r, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = -G psi, psi = L^-1 r_p, and phi = alpha psi - nu r_p; rest -= H b + G phi, which is zero but next to walls. phi
   may be r_p. */
static PetscErrorCode TakePotential(Stokes s, Vec r_p, Vec b, Vec phi) {
  const Fluid f = s->fluid;
  const Grid g = f->grid;
  PetscFunctionBeginUser;
  PetscCall(FluidSolvePoisson(f, r_p, s->psi));
  PetscCall(GridGradient(g, -1, s->psi, PETSC_FALSE, b));
  PetscCall(GridHelmholtz(g, f->alpha, f->nu, b, s->r));
  if (phi != r_p) PetscCall(VecCopy(r_p, phi));
  PetscCall(VecAXPBY(phi, f->alpha, -f->nu, s->psi));
  PetscCall(GridGradient(g, 1, phi, PETSC_TRUE, s->r));
  PetscCall(KeepNextToWalls(g, s->r));
  PetscCall(VecAXPY(s->rest, -1, s->r));
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

/* Between walls both ways: the stream function's velocity of the force, the pressure of what that leaves, which is a
   gradient. Where r_p is not zero -G L^-1 r_p has the divergence and leaves a force next to the walls. Such a force
   moves next to nothing, which comes from chi by differences of large numbers, 1e-16 (n_y)^3 of it: twice. */
static PetscErrorCode SolveInBox(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  const Fluid f = s->fluid;
  const Grid g = f->grid;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(r_u, s->rest));
  if (r_p)
    PetscCall(TakePotential(s, r_p, u, p));
  else {
    PetscCall(VecSet(u, 0));
    PetscCall(VecSet(p, 0));
  }
  for (int round = 0; round < (r_p ? 2 : 1); round++) {
    if (round) PetscCall(GridGradient(g, -1, s->psi, PETSC_TRUE, s->rest));
    PetscCall(FlowByRows(s, s->rest, s->w));
    PetscCall(VecAXPY(u, 1, s->w));
    PetscCall(GridHelmholtz(g, f->alpha, f->nu, s->w, s->r));
    PetscCall(VecAXPY(s->rest, -1, s->r));
    PetscCall(GridGradientTranspose(g, -1, s->rest, s->q));
    PetscCall(FluidSolvePoisson(f, s->q, s->psi));
    PetscCall(VecAXPY(p, 1, s->psi));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* w = H^-1 r_u;  q = r_p - G^T w;  psi = L^-1 q, the potential over alpha;  u = w - G psi;  p = alpha psi - nu q */
static PetscErrorCode Project(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  const Fluid f = s->fluid;
  PetscFunctionBeginUser;
  PetscCall(FluidSolveHelmholtz(f, r_u, u));
  PetscCall(GridGradientTranspose(f->grid, -1, u, s->q));
  if (r_p) PetscCall(VecAXPY(s->q, 1, r_p));
  PetscCall(FluidSolvePoisson(f, s->q, s->psi));
  PetscCall(GridGradient(f->grid, -1, s->psi, PETSC_TRUE, u));
  PetscCall(Pressure(s, p));
  if (s->channel) PetscCall(ChannelCorrect(s->channel, s->psi, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesSolve(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  PetscFunctionBeginUser;
  if (s->box) {
    PetscCall(SolveInBox(s, r_u, r_p, u, p));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(s->banded ? BandedStokesSolve(s->banded, r_u, r_p, u, p) : Project(s, r_u, r_p, u, p));
  if (s->flux) PetscCall(ZeroFluxCorrect(s->flux, u));
  if (s->fluid->held) PetscCall(FluidRemoveMean(s->fluid, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesProject(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(s->box ? Project(s, r_u, r_p, u, p) : StokesSolve(s, r_u, r_p, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
