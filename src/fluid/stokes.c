#include "fluid/stokes.h"

struct _p_Stokes {
  Fluid fluid;
  Channel channel; /* NULL unless x is periodic and y has walls */
  Vec q, phi;
};

PetscErrorCode StokesCreate(Fluid fluid, Stokes *out) {
  Stokes s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  PetscCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &s->q));
  PetscCall(VecDuplicate(s->q, &s->phi));
  if (!fluid->grid->wall[0] && fluid->grid->wall[1]) PetscCall(ChannelCreate(fluid, &s->channel));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesDestroy(Stokes *stokes) {
  PetscFunctionBeginUser;
  if (!*stokes) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ChannelDestroy(&(*stokes)->channel));
  PetscCall(VecDestroy(&(*stokes)->q));
  PetscCall(VecDestroy(&(*stokes)->phi));
  PetscCall(PetscFree(*stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StokesSolve(Stokes s, Vec r_u, Vec r_p, Vec u, Vec p) {
  Fluid f = s->fluid;
  const PetscReal a0 = f->a0;
  PetscFunctionBeginUser;
  /* w = H^-1 r_u;  q = a0 (r_p - G^T w) */
  PetscCall(FluidSolveHelmholtz(f, r_u, u));
  PetscCall(GridGradientTranspose(f->grid, -a0, u, s->q));
  if (r_p) PetscCall(VecAXPY(s->q, a0, r_p));
  /* phi = L^-1 q;  u = w - G phi/a0;  p = phi - (nu/a0) q */
  PetscCall(FluidSolvePoisson(f, s->q, s->phi));
  PetscCall(GridGradient(f->grid, -1 / a0, s->phi, PETSC_TRUE, u));
  PetscCall(VecWAXPY(p, -f->nu / a0, s->q, s->phi));
  if (s->channel) PetscCall(ChannelCorrect(s->channel, s->phi, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}
