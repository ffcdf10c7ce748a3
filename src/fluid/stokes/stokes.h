/* The unsteady Stokes solve A (u, p) = (r_u, r_p):  H u + G p = r_u,  G^T u = r_p. */
#pragma once
#include "fluid/stokes/stream.h"

typedef struct _p_Stokes *Stokes;

/* StokesCreate - solver for a fluid; it follows the fluid's alpha. Collective. */
PETSC_EXTERN PetscErrorCode StokesCreate(Fluid fluid, Stokes *stokes);
PETSC_EXTERN PetscErrorCode StokesDestroy(Stokes *stokes);

/* StokesSolve - velocity u and pressure p (zero mean): where both fast solves are fftw_tridiagonal's, exact, by the
   stream function and the pressure that belongs to it, two scalar solves, three with r_p and five with r_p between
   walls. Else by projection, as StokesProject between walls in x. r_p may be NULL (zero); u may be r_u, p may be r_p.
   Collective. Errors: a scalar solve that does not converge, see FluidFailure. */
PETSC_EXTERN PetscErrorCode StokesSolve(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* StokesVelocity - u of StokesSolve with r_p = 0, one scalar solve, where there is a StokesStream; u may be r_u.
   Collective. */
PETSC_EXTERN PetscErrorCode StokesVelocity(Stokes stokes, Vec r_u, Vec u);

/* StokesProject - between walls in x by projection: three scalar solves, which leave in the momentum next to walls
   nu (L_u G - G L) psi. Else StokesSolve. Collective. */
PETSC_EXTERN PetscErrorCode StokesProject(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* StokesPressure - the pressure p (zero mean) of the velocity u without divergence that solves H u + G p = r_u where
   r_u is given but for a part without divergence: one scalar solve, of L p = -G^T (r_u + nu L_u u). Collective. */
PETSC_EXTERN PetscErrorCode StokesPressure(Stokes stokes, Vec r_u, Vec u, Vec p);

/* StokesStream - the solve for the velocity alone, much cheaper, the same to rounding; borrowed. NULL unless the fast
   solves are fftw_tridiagonal's. Not collective. */
PETSC_EXTERN Stream StokesStream(Stokes stokes);
