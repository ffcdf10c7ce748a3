/* The whole Stokes solve in Fourier modes along x, for boxes that are periodic in x. */
#pragma once
#include "fluid/channel.h"

typedef struct _p_BandedStokes *BandedStokes;

/* BandedStokesCreate - channel: the wall correction, NULL where y is periodic; borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode BandedStokesCreate(Fluid fluid, Channel channel, BandedStokes *banded);
PETSC_EXTERN PetscErrorCode BandedStokesDestroy(BandedStokes *banded);

/* BandedStokesSolve - what StokesSolve does, with two row transforms there and three back instead of six and the
   correction's three; no grid vector is touched in between. Counted as three scalar solves. Collective. */
PETSC_EXTERN PetscErrorCode BandedStokesSolve(BandedStokes banded, Vec r_u, Vec r_p, Vec u, Vec p);
