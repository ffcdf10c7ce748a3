/* Tests without a search that show most curves to be far from one another and from themselves, as they are in most
   steps.

   Two curves are apart where their bounding boxes are. One curve is cut into groups of successive edges: where the
   discs around two groups are disjoint the edges of the groups do not cross. Two groups that follow one another make an
   arc; an arc that turns by T in all, less than half a turn, does not cross itself, and its chords are at least

       cos(T/2)

   times as long as the way along it. All functions work on one rank. */
#pragma once
#include "curve/kind.h"

/* CurveLongestEdge - length of the longest edge of all curves of a set. Not collective. */
PETSC_EXTERN PetscReal CurveLongestEdge(const CurveSet *set);

/* CurvesAreApart - TRUE: each curve that moves is farther than reach (length) from all others and from its own images.
   FALSE says nothing. Not collective. */
PETSC_EXTERN PetscBool CurvesAreApart(const CurveSet *set, PetscReal reach);

/* CurvesAreClear - TRUE: the curves are apart, no curve that moves has edges that cross, and two points of a curve that
   are nearer than reach are at most twice as far from one another along the curve, counted as ds[v] (length) from point
   to point. FALSE says nothing, as for curves with an edge below 5/6 of ds. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurvesAreClear(const CurveSet *set, const PetscReal ds[], PetscReal reach,
                                           PetscBool *clear);
