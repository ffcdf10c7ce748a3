#include "fluid/stokes.h"
#include "fluid/banded.h"

struct _p_Stokes {
  Fluid fluid;
  Channel channel;     /* NULL unless x is periodic and y has walls */
  BandedStokes banded; /* NULL unless x is periodic and both fast solves are fftw_tridiagonal's */
  ZeroFlux flux;       /* NULL unless the fluid may carry no flux along x */
  Stream stream;       /* NULL where banded is */
  Vec q, psi;          /* of the solve by parts */
};

PetscBool StokesIsExact(Fluid f) {
  return f->grid->wall[0] && !f->grid->free ? PETSC_FALSE : PETSC_TRUE;
}

Vec StokesPotential(Stokes s) {
  return s->psi;
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
  if (s->banded) {
    PetscCall(StreamCreate(fluid, s->flux, &s->stream));
    PetscFunctionReturn(PETSC_SUCCESS);
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

/* The solve without regard to the flux. */
static PetscErrorCode Solve(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  Fluid f = s->fluid;
  PetscFunctionBeginUser;
  if (s->banded) {
    PetscCall(BandedStokesSolve(s->banded, r_u, r_p, u, p));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /* w = H^-1 r_u;  q = r_p - G^T w */
  PetscCall(FluidSolveHelmholtz(f, r_u, u));
  PetscCall(GridGradientTranspose(f->grid, -1, u, s->q));
  if (r_p) PetscCall(VecAXPY(s->q, 1, r_p));
  /* psi = L^-1 q, the potential over alpha;  u = w - G psi;  p = alpha psi - nu q */
  PetscCall(FluidSolvePoisson(f, s->q, s->psi));
  PetscCall(GridGradient(f->grid, -1, s->psi, PETSC_TRUE, u));
  PetscCall(Pressure(s, p));
  if (s->channel) PetscCall(ChannelCorrect(s->channel, s->psi, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesSolve(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  PetscFunctionBeginUser;
  PetscCall(Solve(s, r_u, r_p, u, p));
  if (s->flux) PetscCall(ZeroFluxCorrect(s->flux, u));
  if (s->fluid->held) PetscCall(FluidRemoveMean(s->fluid, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}
