/* What vesicles and walls do to one another, inside the preconditioner (docs/suspensions.md, Vesicles among
   themselves). With B^-1 the patterns' answers, F(.) their forces and K the mobility of others and walls, by the coarse
   grid and what that lacks between near markers, the velocities W that the others make obey W + K F(B^-1 (W, 0)) = -K
   F(B^-1 r); a few iterations of GMRES solve for most of it. */
#pragma once
#include "coupling/doublecross.h"
#include "coupling/patterns.h"
#include "coupling/shortrange.h"
#include <petscksp.h>

struct _p_PatternCross {
  Patterns patterns; /* borrowed, with its coarse grid */
  ShortRange near;
  Mat A;
  KSP ksp;
  Vec known, velocity;   /* marker vectors: right-hand side and W */
  PetscScalar *F, *W;    /* [2 own coarse points] forces and velocities */
  DoubleCross dipoles;   /* NULL without viscosity contrast */
  PatternSources answer; /* work */
  PetscReal *work;       /* of one vesicle */
};

/* PatternCrossCreate - of patterns with a coarse grid. Collective. */
PETSC_EXTERN PetscErrorCode PatternCrossCreate(Patterns patterns, PatternCross *cross);
PETSC_EXTERN PetscErrorCode PatternCrossDestroy(PatternCross *cross);

/* PatternCrossPlace - where the coupling has been placed and its vesicles have chosen their patterns. Collective. */
PETSC_EXTERN PetscErrorCode PatternCrossPlace(PatternCross cross);

/* PatternCrossSolve - from the own forces and jumps of B^-1 r: the marker vector W, which stays the cross's.
 * Collective.
 */
PETSC_EXTERN PetscErrorCode PatternCrossSolve(PatternCross cross, const PatternSources *alone, Vec *W);
