/* What vesicles and walls do to one another, inside the preconditioner (docs/suspensions.md, Vesicles among
   themselves). With B^-1 the shapes' answers, F(.) their forces and K the mobility of others and walls, by the coarse
   grid and what that lacks between near markers, the velocities W that the others make obey W + K F(B^-1 (W, 0)) = -K
   F(B^-1 r); a few iterations of GMRES solve for most of it. */
#pragma once
#include "coupling/doublecross.h"
#include "coupling/shapeset.h"
#include "coupling/coarsecorrection.h"
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

/* InteractionsSolve - from the own forces and jumps of B^-1 r: the marker vector W, which stays the cross's.
 * Collective.
 */
PETSC_EXTERN PetscErrorCode InteractionsSolve(Interactions cross, const ShapeSources *alone, Vec *W);
