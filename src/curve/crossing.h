/* Pairs of points that are near one another, and curves that cross.

   Points are sorted into a list of cells at least as wide as the reach, and each is compared with those of the cells
   around it, so that the time is in proportion to the number of points. Edges that cross have middles within the length
   of the longest edge. Positions are interlaced, x0,y0,x1,y1,...; a period of 0 is none, with a period the nearest
   images count. Ranks share a search by `part`; no function sends a message. */
#pragma once
#include "curve/kind.h"

/* CellsAround - numbers of a cell and its neighbours in a row of cells, periodic or not, each once; returns how many.
   Not collective. */
PETSC_EXTERN int CellsAround(PetscBool periodic, PetscInt cells, PetscInt cell, PetscInt around[3]);

/* PairFound - is called for points i < j, the nearest image of j being d from i; TRUE ends the search. */
typedef PetscBool (*PairFound)(void *context, PetscInt i, PetscInt j, const PetscReal d[2]);

/* PairsWithin - call `found` for every pair of the n points X[2n] nearer than reach (length) until it returns TRUE.
   part: only pairs whose first point is one of part[0] .. part[1] - 1; NULL: all pairs. Not collective. Errors: memory.
 */
PETSC_EXTERN PetscErrorCode PairsWithin(PetscInt n, const PetscReal X[], const PetscInt part[2],
                                        const PetscReal period[2], PetscReal reach, PairFound found, void *context);

/* CurvesCross - two curves of a set, moving or not, with edges that cross; the same curve twice: it crosses itself; -1,
   -1: no curves cross. Polygons that touch do not cross, equal ones do. Where the polygons of smooth curves cross they
   are compared at eight times as many points. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurvesCross(const CurveSet *set, PetscInt pair[2]);
