/* The unsteady Stokes solve A (u, p) = (r_u, r_p):  H u + G p = r_u,  G^T u = r_p. */
#pragma once
#include "fluid/stream.h"

typedef struct _p_Stokes *Stokes;

/* StokesCreate - solver for a fluid; it follows the fluid's alpha. Collective. */
PETSC_EXTERN PetscErrorCode StokesCreate(Fluid fluid, Stokes *stokes);
PETSC_EXTERN PetscErrorCode StokesDestroy(Stokes *stokes);

/* StokesSolve - velocity u and pressure p (zero mean). Exact but between walls in x where the fast solves are not
   fftw_tridiagonal's: x periodic, one banded solve that counts as three scalar ones, or three with a
   correction of two unknowns a mode next to walls; walls both ways, by the stream function and the pressure that
   belongs to it, two scalar solves, five with r_p. Elsewhere it is StokesProject. r_p may be NULL (zero); u may be r_u,
   p may be r_p. Collective. Errors: a scalar solve that does not converge, see FluidFailure. */
PETSC_EXTERN PetscErrorCode StokesSolve(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* StokesProject - the same by projection where there are walls in x: three scalar solves, which leave in the momentum
   next to walls nu (L_u G - G L) psi. Else StokesSolve. Collective. */
PETSC_EXTERN PetscErrorCode StokesProject(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* StokesPressure - the pressure p (zero mean) of the velocity u without divergence that solves H u + G p = r_u where
   r_u is given but for a part without divergence: one scalar solve, of L p = -G^T (r_u + nu L_u u). Collective. */
PETSC_EXTERN PetscErrorCode StokesPressure(Stokes stokes, Vec r_u, Vec u, Vec p);

/* StokesProfile - of u along the channel, [rows of all], with a mean of 1: what the solve leaves out where the fluid
   may carry no flux; borrowed, NULL elsewhere. Not collective. */
PETSC_EXTERN const PetscReal *StokesProfile(Stokes stokes);

/* StokesStream - the solve for the velocity alone, much cheaper, the same to rounding; borrowed. NULL unless the fast
   solves are fftw_tridiagonal's. Not collective. */
PETSC_EXTERN Stream StokesStream(Stokes stokes);
