/* Quick answers for curves that are far from one another and from themselves, which is so in most steps: without a
   search. */
#pragma once
#include "curve/kind.h"

/* CurveLongestEdge - of all edges of a set (length). Not collective. */
PETSC_EXTERN PetscReal CurveLongestEdge(const CurveSet *set);

/* CurvesAreApart - true: each curve that moves is farther than reach (length) from all others and from its own
   images, as their bounding boxes tell. False says nothing. Not collective. */
PETSC_EXTERN PetscBool CurvesAreApart(const CurveSet *set, PetscReal reach);

/* CurvesAreClear - true: they are apart, no curve that moves has edges that cross, and points of one nearer than reach
   are at most twice as far from one another along it, ds[v] (length) from point to point counted. False says nothing;
   so do curves with an edge below 5/6 of ds. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurvesAreClear(const CurveSet *set, const PetscReal ds[], PetscReal reach,
                                           PetscBool *clear);
