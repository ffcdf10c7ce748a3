#include "fluid/stokes/flux.h"

struct _p_ZeroFlux {
  Fluid fluid;
  PetscReal alpha;    /* coefficient that the profile is for; -1 none yet */
  PetscReal *profile; /* [rows of all] b over its mean */
  PetscReal *factor;  /* work of its solve */
};

PetscErrorCode ZeroFluxCreate(Fluid fluid, ZeroFlux *out) {
  ZeroFlux z;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&z));
  *out = z;
  z->fluid = fluid;
  z->alpha = -1;
  PetscCall(PetscMalloc2(fluid->grid->n[1], &z->profile, fluid->grid->n[1], &z->factor));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ZeroFluxDestroy(ZeroFlux *flux) {
  PetscFunctionBeginUser;
  if (!*flux) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*flux)->profile, (*flux)->factor));
  PetscCall(PetscFree(*flux));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (alpha - nu d_yy) b = 1 with b reflected in the walls to minus itself, by elimination. */
const PetscReal *ZeroFluxProfile(ZeroFlux z) {
  const Fluid f = z->fluid;
  const PetscInt n = f->grid->n[1];
  const PetscReal off = -f->nu / PetscSqr(f->grid->h);
  PetscReal *b = z->profile, *c = z->factor, mean = 0;
  if (z->alpha == f->alpha) return b;
  z->alpha = f->alpha;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal diagonal = f->alpha - off * (j == 0 || j == n - 1 ? 3 : 2);
    const PetscReal pivot = diagonal - (j ? off * c[j - 1] : 0);
    c[j] = off / pivot;
    b[j] = (1 - (j ? off * b[j - 1] : 0)) / pivot;
  }
  for (PetscInt j = n - 2; j >= 0; j--) b[j] -= c[j] * b[j + 1];
  for (PetscInt j = 0; j < n; j++) mean += b[j] / n;
  for (PetscInt j = 0; j < n; j++) b[j] /= mean;
  return b;
}

PetscErrorCode ZeroFluxCorrectMeans(ZeroFlux z, PetscReal means[]) {
  const Grid g = z->fluid->grid;
  PetscReal sum = 0;
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) sum += means[j];
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPIU_REAL, MPI_SUM, g->comm));
  for (PetscInt j = 0; j < g->rows[FIELD_U]; j++) means[j] -= sum / g->n[1] * ZeroFluxProfile(z)[g->first + j];
  PetscFunctionReturn(PETSC_SUCCESS);
}
