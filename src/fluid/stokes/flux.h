/* A channel whose disturbance carries no flux: a uniform pressure gradient along it holds the mean flow at zero.

   With e the field that is one on every u face and A^-1 the Stokes solve, the solve with the constraint e.u = 0 is
       u = A^-1 r - g b,      b = A^-1 e,      g = (e.A^-1 r)/(e.b),
   symmetric like A^-1. b is the discrete Poiseuille profile, the same in every column. */
#pragma once
#include "fluid/stokes/fluid.h"

typedef struct _p_ZeroFlux *ZeroFlux;

/* ZeroFluxCreate - for a fluid periodic in x between walls in y. Collective. */
PETSC_EXTERN PetscErrorCode ZeroFluxCreate(Fluid fluid, ZeroFlux *flux);
PETSC_EXTERN PetscErrorCode ZeroFluxDestroy(ZeroFlux *flux);

/* ZeroFluxProfile - b over its mean, [rows of all]. Not collective. */
PETSC_EXTERN const PetscReal *ZeroFluxProfile(ZeroFlux flux);

/* ZeroFluxCorrectMeans - take the profile off a Stokes solve's means of u, means[rows of u on this rank], as much as
   makes their sum zero. Collective. */
PETSC_EXTERN PetscErrorCode ZeroFluxCorrectMeans(ZeroFlux flux, PetscReal means[]);
