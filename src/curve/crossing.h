/* Which of many points are near one another, and which closed curves cross: by a list of cells, in a time in proportion
   to the points. Positions are interlaced, x0,y0,x1,y1,...; a period of 0 is none, else the nearest images count. */
#pragma once
#include "base/base.h"

/* PairFound - told of points i < j, the nearest image of j being d from i; true ends the search. */
typedef PetscBool (*PairFound)(void *context, PetscInt i, PetscInt j, const PetscReal d[2]);

/* PairsWithin - calls `found` for every pair of the n points X[2n] nearer than reach (length) until it returns true.
   part: only those whose first point is one of part[0] .. part[1] - 1, so that ranks can share the search; NULL: all.
   Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode PairsWithin(PetscInt n, const PetscReal X[], const PetscInt part[2],
                                        const PetscReal period[2], PetscReal reach, PairFound found, void *context);

/* CurvesCross - the first two of the closed polygons, curve v with points start[v] .. start[v+1]-1 of X,
   that have edges which cross (the same twice: it crosses itself); pair -1, -1 if none. Polygons that touch do not
   cross. With `smooth` points are those of trigonometric curves, and polygons that cross are looked at again at eight
   times the points. part: only pairs whose first curve is one of part[0] .. part[1] - 1; NULL: all. Not collective. */
PETSC_EXTERN PetscErrorCode CurvesCross(PetscInt curves, const PetscInt start[], const PetscReal X[],
                                        const PetscInt part[2], const PetscReal period[2], PetscBool smooth,
                                        PetscInt pair[2]);
