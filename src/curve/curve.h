/* Curves in the plane, most of them closed: ellipses, splines through points, curves of a file, markers at equal
   distances on them. What a scene and a membrane both need. Markers are interlaced, x0,y0,x1,y1,...; lengths are in the
   user's units. */
#pragma once
#include "curve/kind.h"

#define DIGEST 17 /* 64 bits as text */

/* Curves as equal-edge markers, closed ones counter-clockwise. X holds x0,y0,x1,y1,... of all vesicles one after
   another; vesicle v owns markers start[v] .. start[v+1]-1. */
typedef struct {
  PetscInt vesicles;
  PetscInt *start;     /* [vesicles+1] */
  PetscReal *X;        /* [2*start[vesicles]] */
  PetscReal longest;   /* length of the longest of the curves that they are on */
  CurveKind *kind;     /* [vesicles]; NULL: all closed */
  char digest[DIGEST]; /* of what their file says; empty without */
} Shape;
PETSC_EXTERN PetscErrorCode ShapeDestroy(Shape *shape);

/* ShapeRadius - R0 of vesicle v, its length over 2 pi. */
PETSC_EXTERN PetscReal ShapeRadius(const Shape *shape, PetscInt v);

/* ShapeHolds - whether (x, y) lies within curve v, by its polygon. Not collective. */
PETSC_EXTERN PetscBool ShapeHolds(const Shape *shape, PetscInt v, PetscReal x, PetscReal y);

/* A curve X(t), t in [0,1), with X(t+1) = X(t) + span, or from t = 0 to 1 where it is open. */
typedef struct {
  CurveKind kind;
  PetscInt n;          /* 0: ellipse; else number of the spline's parts */
  PetscReal axes[2];   /* ellipse */
  PetscReal *t, *x[2]; /* knots [n+1], values [n+1] less span t */
  PetscReal *m[2];     /* second derivatives [n+1] */
  char digest[DIGEST]; /* of what its file says (CurvesFromFile) */
} Curve;
PETSC_EXTERN void CurveEvaluate(const Curve *curve, PetscReal t, PetscReal X[2]);
PETSC_EXTERN PetscReal CurveLength(const Curve *curve);
PETSC_EXTERN PetscReal CurvePartLength(const Curve *curve, PetscReal from, PetscReal to);
PETSC_EXTERN PetscReal CurveArea(const Curve *curve);

/* CurveEqualChords - place M points on the curve so that all M chords are equal; X[2M], first point at t = 0. */
PETSC_EXTERN PetscErrorCode CurveEqualChords(const Curve *curve, PetscInt M, PetscReal X[]);

/* CurveEqualArcs - the same with M arcs, equal to 1e-9 of their length on a smooth curve: what CurveFit starts from
   for the edges of the spectral derivative. */
PETSC_EXTERN PetscErrorCode CurveEqualArcs(const Curve *curve, PetscInt M, PetscReal X[]);

/* CurvePartEqualArcs - the same from t = `from` to `to`, the first and the last point there. */
PETSC_EXTERN PetscErrorCode CurvePartEqualArcs(const Curve *curve, PetscReal from, PetscReal to, PetscInt M,
                                               PetscReal X[]);

/* CurveFit - move M markers X[2M] as little as possible (least squares) until all their edges, chords or spectral ones
   dX/dk, are length/M long and the polygon or the spectral curve encloses the area: Newton, at most `most` steps. left:
   the largest relative error of squared edges and area. A circle, which has no freedom left, stays. */
PETSC_EXTERN PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[],
                                     PetscInt most, PetscReal *left);

/* CurveFromPoints - cubic spline through n points xy[2n], by chord length: periodic, or without curvature at the ends
   of an open one. */
PETSC_EXTERN PetscErrorCode CurveFromPoints(const CurveKind *kind, PetscInt n, const PetscReal xy[], Curve *curve);

/* What a file says of a curve besides its points. */
typedef struct {
  PetscReal velocity[2], rotation; /* lines "# velocity u_x u_y" (length/time), "# rotation w" (1/time) before it */
  PetscBool clockwise;             /* its points' order, before they were turned */
  PetscBool open;                  /* a line "# open" */
} CurveNote;

/* CurvesFromFile - the curves of a text file ("x y" a line, # starts a comment, an empty line ends a curve), turned
   counter-clockwise, open ones as if the chord closed them. Where period[2] is given, 0 without, one whose last point
   is its first but for a period spans it, as it runs, and a note makes one open; else all are closed. curve[curves] to
   be freed, each after CurveDestroy, and note[curves] (NULL: not wanted). option: the one that names the file, for
   messages. All have one digest, of the points and notes of all. Collective: rank 0 reads. */
PETSC_EXTERN PetscErrorCode CurvesFromFile(MPI_Comm comm, const char option[], const char file[],
                                           const PetscReal period[2], PetscInt *curves, Curve **curve,
                                           CurveNote **note);
PETSC_EXTERN PetscErrorCode CurveDestroy(Curve *curve);

/* EllipseAxes - semi-axes a >= b of the ellipse with the given area and reduced area V = 4 pi area / perimeter^2. */
PETSC_EXTERN PetscErrorCode EllipseAxes(PetscReal area, PetscReal reduced_area, PetscReal axes[2]);

/* BiconcaveCurve - the red cell's outline of Evans and Fung, thicker or thinner in its middle so that it has the
   reduced area (.35 to .9; their cell has .461) and the area; about the origin, long axis along x. CurveCentroid - of
   the area that a curve encloses. Not collective. */
PETSC_EXTERN PetscErrorCode BiconcaveCurve(PetscReal area, PetscReal reduced_area, Curve *curve);
PETSC_EXTERN void CurveCentroid(const Curve *curve, PetscReal centroid[2]);
