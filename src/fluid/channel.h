/* The wall correction of a channel, periodic in x with walls in y: what makes the projection an exact Stokes solve. */
#pragma once
#include "fluid/fluid.h"

typedef struct _p_Channel *Channel;

/* ChannelCreate - for a fluid whose grid is periodic in x with walls in y; it follows the fluid's
   alpha. Not collective. */
PETSC_EXTERN PetscErrorCode ChannelCreate(Fluid fluid, Channel *channel);
PETSC_EXTERN PetscErrorCode ChannelDestroy(Channel *channel);

/* ChannelCorrect - add to (u, p) what makes the projection exact; psi is the projection's potential (u = w - G psi).
   Collective. */
PETSC_EXTERN PetscErrorCode ChannelCorrect(Channel channel, Vec psi, Vec u, Vec p);

/* The same on Fourier modes along the rows, n_x/2 + 1 complex numbers each, in this order: ChannelSetUp takes over the
   fluid's alpha, ChannelForces takes the potential in the bottom and the top row, ChannelAddRow adds to local row j of
   a field. Not collective. */
PETSC_EXTERN PetscErrorCode ChannelSetUp(Channel channel);
PETSC_EXTERN void ChannelForces(Channel channel, const PetscReal bottom[], const PetscReal top[]);
PETSC_EXTERN void ChannelAddRow(Channel channel, Field f, PetscInt j, PetscReal line[]);
