/* What the steps of all schemes are put together from. */
#pragma once
#include "scheme/scheme.h"

/* SchemePlace - put everything that a solve stands on at the markers X, with label speeds treading[vesicles] or NULL
   (CouplingPlace), and the background of time t there: background = u_inf(X), g = -Dm background/h^2. placed is false
   with report.failure when a marker is too close to a wall or the flow has no value. Collective. */
PETSC_EXTERN PetscErrorCode SchemePlace(Scheme scheme, PetscReal a0, Vec X, const PetscReal treading[], PetscReal t,
                                        PetscBool *placed);

/* SchemeBackground - the background flow's velocity at the markers X at time t, zero in the total form, where it is in
   w; report.failure where a flow of the caller's has none. Collective. */
PETSC_EXTERN PetscErrorCode SchemeBackground(Scheme scheme, Vec X, PetscReal t);

/* SchemeMarkerVelocity - U = background + V of the solved part V at the coupling's markers; measures
   report.surface_div_max on the way. U may be V. Collective. */
PETSC_EXTERN PetscErrorCode SchemeMarkerVelocity(Scheme scheme, Vec V, Vec U);

/* SchemeMeasureDivergence - fill in report.div_max of a solved velocity, whose divergence is to be `expected` (NULL:
   zero). Collective. */
PETSC_EXTERN PetscErrorCode SchemeMeasureDivergence(Scheme scheme, Vec w, Vec expected);

/* SchemeKeep - copy the state into scheme->before. SchemeReturn - put back what was kept before the step; advanced: the
   new state has taken the old one's place since. Collective. */
PETSC_EXTERN PetscErrorCode SchemeKeep(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeReturn(Scheme scheme, PetscBool advanced);

/* SchemeSolverFailed - record a failed solve: prefix, step, time, residual. Not collective. */
PETSC_EXTERN PetscErrorCode SchemeSolverFailed(Scheme scheme, const char prefix[], KSPConvergedReason why, PetscInt its,
                                               PetscReal residual);

/* SchemeCurves - scheme->work_all: the vesicles' markers X, then the obstacles at time t as contacts look at them
   (BodiesSee).
   SchemeNamePair - two bodies in words, by their places: "vesicles 1 and 2", "vesicle 1 and obstacle 2"; `same` with
   the number of one that is both. The first is Collective. */
PETSC_EXTERN PetscErrorCode SchemeCurves(Scheme scheme, PetscReal t, Vec X);
PETSC_EXTERN PetscErrorCode SchemeNamePair(Scheme scheme, PetscInt v, PetscInt w, const char same[], size_t length,
                                           char text[]);

/* SchemePeriods - the box's length in x and y (length), 0 where there are walls. SchemeIsSmooth - whether membranes are
   curves by their markers, not polygons. Not collective. */
PETSC_EXTERN void SchemePeriods(Scheme scheme, PetscReal period[2]);
PETSC_EXTERN PetscBool SchemeIsSmooth(Scheme scheme);

/* The schemes. */
PETSC_EXTERN PetscErrorCode SchemeCreate_Split(Scheme);
PETSC_EXTERN PetscErrorCode SchemeCreate_Penalty(Scheme);
PETSC_EXTERN PetscErrorCode SchemeCreate_Coupled(Scheme);

/* SchemeAdvise - step, time and what to try, behind what is wrong in report.failure. Not collective. */
PETSC_EXTERN PetscErrorCode SchemeAdvise(Scheme scheme, const char advice[]);

/* SchemeWarn - a warning on rank 0's output, one line, and among those of summary.json. Every rank gives the same text.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeWarn(Scheme scheme, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
