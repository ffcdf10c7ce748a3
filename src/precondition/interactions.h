/* What vesicles and walls do to one another, and vesicles to obstacles, inside the preconditioner (docs/suspensions.md,
   Vesicles among themselves).

   B^-1 is the inverse of each vesicle's own problem, by its shared shape; F(.) the forces of an answer; K the mobility
   of other bodies and walls, by the coarse grid (coarsegrid.h) and its correction between near markers. The
   velocities W that the others make obey W + K F(B^-1 (W, 0)) = -K F(B^-1 r). A few iterations of GMRES find most of W.
   With viscosity contrast the correction has the double layer of the jumps too. */
#pragma once
#include "precondition/shapeset.h"
#include "precondition/coarsecorrection.h"
#include <petscksp.h>

struct _p_Interactions {
  SharedShapes shapes; /* borrowed, with its coarse grid */
  CoarseCorrection near;
  Mat A;
  KSP ksp;
  Vec known, velocity; /* marker vectors of all bodies: right-hand side and W */
  PetscScalar *F, *W;  /* [2 own coarse points] forces in the shapes' frames, velocities */
  ShapeSources answer; /* of all bodies, those of obstacles zero: work */
  CurvePoints *solid;  /* [obstacles] */
  PetscReal *work;     /* [2 markers + 2 coarse points] of one vesicle */
};

/* InteractionsCreate - of shapes with a coarse grid. Collective. */
PETSC_EXTERN PetscErrorCode InteractionsCreate(SharedShapes shapes, Interactions *cross);
PETSC_EXTERN PetscErrorCode InteractionsDestroy(Interactions *cross);

/* InteractionsPlace - where the coupling has been placed and its vesicles have chosen their shapes. Collective. */
PETSC_EXTERN PetscErrorCode InteractionsPlace(Interactions cross);

/* InteractionsAdd - U += W for the own U[2(n + w)] and sigma[n] of r. Collective. */
PETSC_EXTERN PetscErrorCode InteractionsAdd(Interactions cross, const PetscScalar sigma[], PetscScalar U[]);
