/* The unsteady Stokes solve A (u, p) = (r_u, r_p):  H u + G p = r_u,  G^T u = r_p. */
#pragma once
#include "fluid/fluid.h"

typedef struct _p_Stokes *Stokes;

/* StokesCreate - solver for a fluid; follows the fluid's a0. Collective. */
PETSC_EXTERN PetscErrorCode StokesCreate(Fluid fluid, Stokes *stokes);
PETSC_EXTERN PetscErrorCode StokesDestroy(Stokes *stokes);

/* StokesSolve - three scalar solves. Exact in a periodic box and in a channel (periodic in x, walls in y), where a
   correction of two unknowns per x mode removes the projection's slip at the walls; elsewhere a projection, whose
   momentum is off next to the walls by (nu/a0)(L_u G - G L) phi. r_p may be NULL (zero); u may be r_u, p may be r_p.
   Collective. */
PETSC_EXTERN PetscErrorCode StokesSolve(Stokes stokes, Vec r_u, Vec r_p, Vec u, Vec p);

/* The wall correction of a channel (channel.c). */
typedef struct _p_Channel *Channel;
PETSC_EXTERN PetscErrorCode ChannelCreate(Fluid fluid, Channel *channel);
PETSC_EXTERN PetscErrorCode ChannelDestroy(Channel *channel);

/* ChannelCorrect - add to (u, p) what makes the projection exact; phi is the projection's potential (u = w - G phi/a0).
 */
PETSC_EXTERN PetscErrorCode ChannelCorrect(Channel channel, Vec phi, Vec u, Vec p);
