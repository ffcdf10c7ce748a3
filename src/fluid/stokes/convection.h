/* Convection of the disturbance u' = u - u_inf, explicit in time:
       N(u') = (u' + u_inf).grad u' + u'.grad u_inf
   The first part is skew-symmetric on the staggered grid: it keeps the energy h^2/2 SUM |u'|^2 to rounding, even where
   the carrying flow has a divergence. u_inf.grad u_inf is a gradient for the flows offered; the pressure takes
   it up. */
#pragma once
#include "fluid/stokes/forcing.h"

typedef struct _p_Convection *Convection;
struct _p_Convection {
  Fluid fluid; /* borrowed */
  Flow flow;
  PetscInt width, height;   /* size of the padded arrays, which have one face more on every side than there are cells */
  PetscReal *background[2]; /* u_inf on the padded faces */
  PetscReal *own[2];        /* u' on the padded faces */
  PetscReal *carrier[2];    /* u' + u_inf on the padded faces */
};

/* ConvectionCreate - for a background flow, whose values must be the same across periodic boundaries (checked
   by SceneCreate). Collective. */
PETSC_EXTERN PetscErrorCode ConvectionCreate(const Flow *flow, Fluid fluid, Convection *convection);
PETSC_EXTERN PetscErrorCode ConvectionDestroy(Convection *convection);

/* ConvectionAdd - f += alpha N (length/time^2), from the disturbance w = u', which must not be the values of f.
   Collective. */
PETSC_EXTERN PetscErrorCode ConvectionAdd(Convection convection, PetscReal alpha, Vec w, Forcing *f);

/* ConvectionSpeed - max over cells of |u| + |v| of the whole velocity u' + u_inf, which times dt/h is the CFL number;
   NaN when a velocity is not finite. The same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode ConvectionSpeed(Convection convection, Vec w, PetscReal *speed);
