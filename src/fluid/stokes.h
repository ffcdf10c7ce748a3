/* The unsteady Stokes solve A (u, p) = (r_u, r_p):  H u + G p = r_u,  G^T u = r_p. */
#pragma once
#include "fluid/fluid.h"

typedef struct _p_Stokes *Stokes;

/* StokesCreate - solver for a fluid; follows the fluid's alpha. Collective. */
PETSC_EXTERN PetscErrorCode StokesCreate(Fluid fluid, Stokes *stokes);
PETSC_EXTERN PetscErrorCode StokesDestroy(Stokes *stokes);

/* StokesSolve - three scalar solves, or (x periodic, fast solves by fftw_tridiagonal) one banded solve that counts as
   three. Exact in a periodic box and in a channel (periodic in x, walls in y), where a correction of two unknowns per x
   mode removes the projection's slip at the walls; elsewhere a projection, whose momentum is off next to the walls by
   nu (L_u G - G L) psi. r_p may be NULL (zero); u may be r_u, p may be r_p. Collective. */
PETSC_EXTERN PetscErrorCode StokesSolve(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* StokesIsExact - whether StokesSolve is: x is periodic. Not collective. */
PETSC_EXTERN PetscBool StokesIsExact(Fluid fluid);

/* StokesPotential - psi of the last solve, u = w - G psi; borrowed. Not collective. */
PETSC_EXTERN Vec StokesPotential(Stokes stokes);

/* WallProfile - the projection of a unit force wave on the first of n rows between two walls, lambda minus the
   eigenvalue of its second difference along them: w[n] = H^-1 of it and the potential psi[n]; work[n]. */
PETSC_EXTERN void WallProfile(Fluid fluid, PetscInt n, PetscReal lambda, PetscReal work[], PetscReal w[],
                              PetscReal psi[]);

/* The wall correction of a channel (channel.c). */
typedef struct _p_Channel *Channel;
PETSC_EXTERN PetscErrorCode ChannelCreate(Fluid fluid, Channel *channel);
PETSC_EXTERN PetscErrorCode ChannelDestroy(Channel *channel);

/* ChannelCorrect - add to (u, p) what makes the projection exact; psi is the projection's potential (u = w - G psi).
   Collective. */
PETSC_EXTERN PetscErrorCode ChannelCorrect(Channel channel, Vec psi, Vec u, Vec p);

/* The same on Fourier modes along the rows, n_x/2 + 1 complex numbers each: ChannelSetUp follows the fluid's alpha,
   ChannelForces takes the potential in the bottom and the top row, ChannelAddRow adds to row j of a field. Not
   collective. */
PETSC_EXTERN PetscErrorCode ChannelSetUp(Channel channel);
PETSC_EXTERN void ChannelForces(Channel channel, const PetscReal bottom[], const PetscReal top[]);
PETSC_EXTERN void ChannelAddRow(Channel channel, Field f, PetscInt j, PetscReal line[]);

/* The whole Stokes solve in Fourier modes along x, where x is periodic (banded.c). */
typedef struct _p_BandedStokes *BandedStokes;
PETSC_EXTERN PetscErrorCode BandedStokesCreate(Fluid fluid, Channel channel, BandedStokes *banded);
PETSC_EXTERN PetscErrorCode BandedStokesDestroy(BandedStokes *banded);

/* BandedStokesSolve - StokesSolve: two row transforms there and three back instead of six and the correction's three;
   no grid vector is touched in between. Counted as three scalar solves. Collective. */
PETSC_EXTERN PetscErrorCode BandedStokesSolve(BandedStokes banded, Vec r_u, Vec r_p, Vec u, Vec p);
