/* The kinds of curves that markers are on: closed, spanning a period of the box, or open with both ends on a wall.
   Derivatives along them, finer points, and how a force on finer points follows from that on the markers. Points are
   interlaced, x0,y0,x1,y1,...; k = 0 .. n - 1 numbers the markers. */
#pragma once
#include "curve/spectral.h"

typedef enum { CURVE_CLOSED, CURVE_SPANNING, CURVE_OPEN } CurveType;

typedef struct {
  CurveType type;
  PetscReal span[2]; /* from marker 0 to where marker n would be: a period of a spanning curve, else zero */
  PetscInt around;   /* 1 + the closed curve of its set that it is meant to lie within, where its distance from that is
                        positive; 0: none */
} CurveKind;

/* Curves as contacts see them: curve v has the points start[v] .. start[v+1]-1. */
typedef struct {
  PetscInt curves;
  PetscInt moving; /* the first ones; others are not compared among themselves */
  const PetscInt *start;
  const CurveKind *kind; /* [curves]; NULL: all closed */
  const PetscReal *X;
  const PetscReal *period; /* [2] 0 is none, else the nearest images count */
  PetscBool smooth;        /* the points are those of smooth curves, else of polygons */
  const PetscInt *part; /* [2] only pairs are looked at whose first curve, or whose curve at a wall, is one of part[0]
                           .. part[1] - 1, of the moving ones, so that ranks can share the search; NULL: all */
} CurveSet;

/* CurveSetKind - of curve v. CurveSetWalk - the place X of the point `steps` on from point k of curve v, a period
   further where that leads over the end of a spanning curve; false beyond an open end. Not
   collective. */
static inline CurveKind CurveSetKind(const CurveSet *set, PetscInt v) {
  return set->kind ? set->kind[v] : (CurveKind){0};
}
PETSC_EXTERN PetscBool CurveSetWalk(const CurveSet *set, PetscInt v, PetscInt k, PetscInt steps, PetscReal X[2]);

/* CurveFineCreate - one or two curves of a set, which[n], as a set of polygons of their own, all moving, at `times`
   their points. Not collective. */
typedef struct {
  CurveSet set;
  PetscInt start[3];
  CurveKind kind[2];
  PetscReal *X;
} CurveFine;
PETSC_EXTERN PetscErrorCode CurveFineCreate(const CurveSet *set, PetscInt n, const PetscInt which[], PetscInt times,
                                            CurveFine *fine);
PETSC_EXTERN PetscErrorCode CurveFineDestroy(CurveFine *fine);

/* CurveTangents - T[2n] = dX/dk: spectral where the curve repeats, else of polynomials through six markers. s is of n
   markers. Not collective. */
PETSC_EXTERN PetscErrorCode CurveTangents(const CurveKind *kind, Spectral s, PetscInt n, const PetscReal X[],
                                          PetscReal T[]);

/* CurveFinePlace - where the q-th of `times` n finer points lies, as a marker's number: points begin at marker 0, those
   of open curves lie evenly about each marker. CurveFinePoints - Y[2 times n], by trigonometric interpolation or
   polynomials through six markers. Not collective. */
PETSC_EXTERN PetscReal CurveFinePlace(const CurveKind *kind, PetscInt times, PetscInt q);
PETSC_EXTERN PetscErrorCode CurveFinePoints(const CurveKind *kind, PetscInt n, const PetscReal X[], PetscInt times,
                                            PetscReal Y[]);

/* CurveOpenWeights - of an open curve: weight[n], what a force on the q-th finer point has of those on the markers.
   Linear within four markers of an end, where one-sided polynomials would make the mobility indefinite, constant beyond
   the last marker. Not collective. */
PETSC_EXTERN void CurveOpenWeights(PetscInt n, PetscInt times, PetscInt q, PetscReal weight[]);
