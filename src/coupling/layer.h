/* The velocity and the pressure of the membranes' forces in unbounded fluid, at any point: the free-space single layer
       u = SUM [-ln r F + x (x.F)/r^2]/(4 pi nu),   p = SUM F.x/(2 pi r^2),   x from a marker to the point,
   F the force times ds. Near a membrane the sums run over a finer curve, and what the trapezoidal rule lacks next to
   it is added in closed form, so that points at any distance are right, on both sides. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_Layer *Layer;

/* LayerCreate - of the coupling's membranes at the markers X with tension sigma; every rank gets all of it. Collective.
 */
PETSC_EXTERN PetscErrorCode LayerCreate(Coupling coupling, Vec sigma, Vec X, Layer *layer);
PETSC_EXTERN PetscErrorCode LayerDestroy(Layer *layer);

/* LayerEvaluate - velocity u[2] (length/time) and pressure p (length^2/time^2; zero far away) at x[2]. A point on a
   membrane gets the velocity there, and the pressure of one of the sides. Not collective. */
PETSC_EXTERN void LayerEvaluate(Layer layer, const PetscReal x[2], PetscReal u[2], PetscReal *p);
