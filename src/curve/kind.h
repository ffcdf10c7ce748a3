/* The kinds of curves that markers are on: closed, spanning a period of the box, or open with both ends on a wall.

   Points are interlaced, x0,y0,x1,y1,...; k = 0 .. n - 1 numbers the markers of a curve, and t is a real marker number.
   Between markers a curve is a trigonometric polynomial,

       X(t) = t/n span + SUM (X_k - k/n span) c_n(t - k),   c_n: TrigonometricCardinal at the angle 2 pi (t - k)/n,

   where it repeats (closed: span = 0), and a polynomial through six markers where it is open. All functions work on one
   rank; CurveSet.part shares a search among ranks. */
#pragma once
#include "numerics/spectral.h"

typedef enum { CURVE_CLOSED, CURVE_SPANNING, CURVE_OPEN } CurveType;

typedef struct {
  CurveType type;
  PetscReal span[2]; /* from marker 0 to where marker n would be: a period of a spanning curve, else zero */
  PetscInt around;   /* 1 + number of the curve of the set that is meant to hold this curve: distances from it are
                        positive   inside; 0: none */
} CurveKind;

/* A set of curves. Curve v has the points start[v] .. start[v+1]-1. */
typedef struct {
  PetscInt curves;
  PetscInt moving; /* the first `moving` curves move; curves that rest are not compared with one another */
  const PetscInt *start;
  const CurveKind *kind; /* [curves]; NULL: all closed */
  const PetscReal *X;
  const PetscReal *period; /* [2] with a period the nearest images count; 0: none */
  PetscBool smooth;        /* the points are on smooth curves; FALSE: polygons */
  const PetscInt *part; /* [2] a search looks at pairs whose first curve, or whose curve at a wall, is one of the moving
                           curves part[0] .. part[1] - 1; NULL: all pairs */
} CurveSet;

/* CurveSetKind - kind of curve v. CurveSetWalk - place X of the point `steps` on from point k of curve v; beyond the
   last point of a spanning curve it is a period further, beyond an open end the function returns FALSE. Not collective.
 */
static inline CurveKind CurveSetKind(const CurveSet *set, PetscInt v) {
  return set->kind ? set->kind[v] : (CurveKind){0};
}
PETSC_EXTERN PetscBool CurveSetWalk(const CurveSet *set, PetscInt v, PetscInt k, PetscInt steps, PetscReal X[2]);

/* CurveBounds - make the rectangle around[4] (x_min, x_max, y_min, y_max; CURVE_NOWHERE is empty) hold n points X[2n].
   Not collective. */
#define CURVE_NOWHERE                                                                                                  \
  { PETSC_MAX_REAL, -PETSC_MAX_REAL, PETSC_MAX_REAL, -PETSC_MAX_REAL }
PETSC_EXTERN void CurveBounds(PetscInt n, const PetscReal X[], PetscReal around[4]);

/* CurveLongestEdge - length of the longest edge of all curves of a set. Not collective. */
PETSC_EXTERN PetscReal CurveLongestEdge(const CurveSet *set);

/* One or two curves of a set as polygons of more points. */
typedef struct {
  CurveSet set;
  PetscInt start[3];
  CurveKind kind[2];
  PetscReal *X;
} CurveFine;

/* CurveFineCreate - the curves which[n] of a set, with `times` as many points, all moving. Not collective. */
PETSC_EXTERN PetscErrorCode CurveFineCreate(const CurveSet *set, PetscInt n, const PetscInt which[], PetscInt times,
                                            CurveFine *fine);
PETSC_EXTERN PetscErrorCode CurveFineDestroy(CurveFine *fine);

/* CurveTangents - T[2n] = dX/dk at the markers X[2n]. s: for n markers. Not collective. */
PETSC_EXTERN PetscErrorCode CurveTangents(const CurveKind *kind, Spectral s, PetscInt n, const PetscReal X[],
                                          PetscReal T[]);

/* CurveFinePlace - t of the q-th of `times` n finer points: they begin at marker 0; on an open curve they lie evenly
   about each marker. CurveFinePoints - Y[2 times n] = X(t) at these places. Not collective. */
PETSC_EXTERN PetscReal CurveFinePlace(const CurveKind *kind, PetscInt times, PetscInt q);
PETSC_EXTERN PetscErrorCode CurveFinePoints(const CurveKind *kind, PetscInt n, const PetscReal X[], PetscInt times,
                                            PetscReal Y[]);

/* CurveOpenWeights - weight[n]: the force on the q-th finer point of an open curve is SUM weight_k (force on marker k).
   The interpolation is linear within four markers of an end, where one-sided polynomials would make the mobility
   indefinite, and constant beyond the last marker. Not collective. */
PETSC_EXTERN void CurveOpenWeights(PetscInt n, PetscInt times, PetscInt q, PetscReal weight[]);
