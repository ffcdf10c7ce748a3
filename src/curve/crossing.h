/* Which of many points are near one another, and which curves cross: by a list of cells, in a time in proportion
   to the points. Positions are interlaced, x0,y0,x1,y1,...; a period of 0 is none, else the nearest images count. */
#pragma once
#include "curve/kind.h"

/* PairFound - told of points i < j, the nearest image of j being d from i; true ends the search. */
typedef PetscBool (*PairFound)(void *context, PetscInt i, PetscInt j, const PetscReal d[2]);

/* PairsWithin - calls `found` for every pair of the n points X[2n] nearer than reach (length) until it returns true.
   part: only those whose first point is one of part[0] .. part[1] - 1, so that ranks can share the search; NULL: all.
   Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode PairsWithin(PetscInt n, const PetscReal X[], const PetscInt part[2],
                                        const PetscReal period[2], PetscReal reach, PairFound found, void *context);

/* CurvesCross - the first two curves of a set, moving or not, that have edges which cross (the same twice: it crosses
   itself); pair -1, -1 if none. Polygons that touch do not cross. Of smooth curves polygons that cross are looked at
   again at eight times the points. Not collective. */
PETSC_EXTERN PetscErrorCode CurvesCross(const CurveSet *set, PetscInt pair[2]);
