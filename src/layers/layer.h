/* The velocity and the pressure of the membranes' forces in unbounded fluid, at any point: the single layer

       u = SUM [-ln r F + x (x.F)/r^2]/(4 pi nu),   p = SUM F.x/(2 pi r^2),   x from a marker to the point,

   F the force times ds. Near a membrane the sums run over a finer curve, and what the trapezoidal rule lacks next to
   it is added in closed form, so that points at any distance are right, on both sides. Create gathers the markers and
   forces of all ranks; after that nothing crosses them. */
#pragma once
#include "markers/layout.h"

typedef struct _p_LayerCurve LayerCurve;
typedef struct _p_Layer *Layer;
struct _p_Layer {
  PetscReal nu;
  Layout layout;     /* of the membranes, borrowed */
  LayerCurve *curve; /* [bodies] */
  PetscReal *X, *F;  /* [2M] all markers, and the forces times ds on them; whole vectors */
};

/* LayerCreate - of membranes in a fluid of viscosity nu, from the own markers X[2n] and the forces on them F[2n]; every
   rank gets all forces. Collective. LayerUse - make the finer curve of a vesicle, before LayerAdd is called for it. Not
   collective. */
PETSC_EXTERN PetscErrorCode LayerCreate(PetscReal nu, Layout layout, const PetscScalar X[], const PetscScalar F[],
                                        Layer *layer);
PETSC_EXTERN PetscErrorCode LayerDestroy(Layer *layer);
PETSC_EXTERN PetscErrorCode LayerUse(Layer layer, PetscInt vesicle);

/* LayerAdd - add one vesicle's part to the velocity u[2] (length/time) and the pressure p (length^2/time^2; zero far
   away) at x[2]. A point on a membrane gets the velocity there, and the pressure of one of the sides. Not collective.
 */
PETSC_EXTERN void LayerAdd(Layer layer, PetscInt vesicle, const PetscReal x[2], PetscReal u[2], PetscReal *p);
