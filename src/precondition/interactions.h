/* What vesicles and walls do to one another, inside the preconditioner (docs/suspensions.md, Vesicles among
   themselves).

   B^-1 is the inverse of each vesicle's own problem, by its shared shape; F(.) the forces of an answer; K the mobility
   of other vesicles and walls, by the coarse grid (coarsegrid.h) and its correction between near markers. The
   velocities W that the others make obey W + K F(B^-1 (W, 0)) = -K F(B^-1 r). A few iterations of GMRES find most of W.
   With viscosity contrast -K F has the double layer of the jumps beside it (doublecross.h). */
#pragma once
#include "precondition/doublecross.h"
#include "precondition/shapeset.h"
#include "precondition/coarsecorrection.h"
#include <petscksp.h>

struct _p_Interactions {
  SharedShapes shapes; /* borrowed, with its coarse grid */
  CoarseCorrection near;
  Mat A;
  KSP ksp;
  Vec known, velocity; /* marker vectors: right-hand side and W */
  PetscScalar *F, *W;  /* [2 own coarse points] forces and velocities */
  DoubleCross dipoles; /* NULL without viscosity contrast */
  ShapeSources answer; /* work */
  PetscReal *work;     /* of one vesicle */
};

/* InteractionsCreate - of shapes with a coarse grid. Collective. */
PETSC_EXTERN PetscErrorCode InteractionsCreate(SharedShapes shapes, Interactions *cross);
PETSC_EXTERN PetscErrorCode InteractionsDestroy(Interactions *cross);

/* InteractionsPlace - where the coupling has been placed and its vesicles have chosen their shapes. Collective. */
PETSC_EXTERN PetscErrorCode InteractionsPlace(Interactions cross);

/* InteractionsSolve - from the own forces and jumps of B^-1 r: the marker vector W, which belongs to `cross`.
   Collective. */
PETSC_EXTERN PetscErrorCode InteractionsSolve(Interactions cross, const ShapeSources *alone, Vec *W);
