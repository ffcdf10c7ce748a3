/* Interpolation between the n markers of a curve and a few points on it, for preconditioners: what is smooth along the
   curve is known everywhere from its values at the points.

   Points of a curve that repeats are equally far apart in the marker's number, the first is marker 0, and values are
   interpolated by the trigonometric polynomial through them. Points of an open curve are those of the cosines with
   level ends, which interpolate there.

   Q, the weights from points to markers, has its transpose for forces: Q^T F on the points has the moments of F on the
   markers. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscInt n, points;
  PetscReal *to_markers; /* [points][n] Q: value at a marker by a unit at a point */
  PetscReal *to_points;  /* [points][n] value at a point by a unit at a marker */
} CurvePoints;

/* CurvePointsCreate - for n markers and so many points, an odd number of at most n. Not collective. */
PETSC_EXTERN PetscErrorCode CurvePointsCreate(PetscBool open, PetscInt n, PetscInt points, CurvePoints *curve);
PETSC_EXTERN PetscErrorCode CurvePointsDestroy(CurvePoints *curve);

/* CurvePointsPlace - Y[2 points], the places of the points of a curve with markers X[2n], after which it repeats
   shifted by span[2]. Not collective. */
PETSC_EXTERN void CurvePointsPlace(const CurvePoints *curve, const PetscReal span[2], const PetscReal X[],
                                   PetscReal Y[]);
