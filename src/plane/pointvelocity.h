/* The velocity of the present state at any point x,

       u = u_inf(x) + I[u - u_inf](x),

   I the cubic interpolation from the cells' centres (CellFields). Next to a wall u - u_inf is continued as an odd
   function, so that it is zero at the wall. In unbounded fluid the exact layers of all membranes and bodies stand in
   the place of I.

   Begin once a state, At as often as wanted, End. */
#pragma once
#include "layers/curvelayer.h"
#include "scheme/stepcommon.h"

typedef struct {
  Scheme scheme;     /* borrowed */
  PetscReal *cell;   /* [cells][2] u - u_inf of all ranks' cells; NULL in unbounded fluid */
  PetscInt bodies;   /* that have layers */
  CurveLayer *layer; /* [bodies][2] in unbounded fluid: single, and double where a viscosity is another; else NULL */
} PointVelocity;

/* PointVelocityAt - u[2n] at X[2n], which are the same on all ranks; each rank computes a share. Collective; stops with
   the user's message where a custom flow has no value. */
PETSC_EXTERN PetscErrorCode PointVelocityBegin(Scheme scheme, PointVelocity *p);
PETSC_EXTERN PetscErrorCode PointVelocityAt(PointVelocity *p, PetscInt n, const PetscReal X[], PetscReal u[]);
PETSC_EXTERN PetscErrorCode PointVelocityEnd(PointVelocity *p);
