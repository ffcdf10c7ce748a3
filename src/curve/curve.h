/* Curves in the plane: ellipses, splines through points, the curves of a file, and equal distances along them.

   A spline is cubic in a parameter t from 0 to 1 that grows with the length of chords; integrals along a curve are sums
   over 4000 parts with Richardson extrapolation, relative error h^4. Markers are interlaced, x0,y0,x1,y1,...; lengths
   are in the user's units. Rank 0 reads a file and sends it to all ranks; all other functions work on one rank. */
#pragma once
#include "curve/kind.h"

#define DIGEST 17 /* 64 bits as text */

/* Curves as markers with equal edges; closed curves run counter-clockwise. Vesicle v has the markers start[v] ..
   start[v+1]-1. */
typedef struct {
  PetscInt vesicles;
  PetscInt *start;     /* [vesicles+1] */
  PetscReal *X;        /* [2*start[vesicles]] */
  PetscReal longest;   /* length of the longest curve */
  CurveKind *kind;     /* [vesicles]; NULL: all closed */
  char digest[DIGEST]; /* of the curves in their file; empty without a file */
} Shape;

/* ShapeCreate - curves of markers[n] markers each, of the kinds kind[n] (NULL: all closed); the places X are not set.
   Not collective. */
PETSC_EXTERN PetscErrorCode ShapeCreate(PetscInt n, const PetscInt markers[], const CurveKind kind[], Shape *shape);
PETSC_EXTERN PetscErrorCode ShapeDestroy(Shape *shape);

/* ShapeRadius - R0 of vesicle v: its length over 2 pi. Not collective. */
PETSC_EXTERN PetscReal ShapeRadius(const Shape *shape, PetscInt v);

/* ShapeMiddle - the mean of the markers of curve v. ShapeHolds - whether the point X, or one of its images,
   lies within the polygon of curve v, which is no longer than a period (0: none); FALSE where the curve spans a period.
   Not collective. */
PETSC_EXTERN void ShapeMiddle(const Shape *shape, PetscInt v, PetscReal X[2]);
PETSC_EXTERN PetscBool ShapeHolds(const Shape *shape, PetscInt v, const PetscReal X[2], const PetscReal period[2]);

/* CurvesReverse - of curves with the markers start[v] .. start[v + 1] - 1, numbers X[2 start[curves]] of the markers of
   those that are marked, in the opposite order. Not collective. */
PETSC_EXTERN void CurvesReverse(PetscInt curves, const PetscInt start[], const PetscBool marked[], PetscReal X[]);

/* A curve X(t):

     X(t + 1) = X(t) + span

   where it is closed (span = 0) or spans a period; an open curve runs from t = 0 to t = 1. */
typedef struct {
  CurveKind kind;
  PetscInt n;          /* parts of the spline; 0: ellipse */
  PetscReal axes[2];   /* semi-axes of the ellipse */
  PetscReal *t;        /* [n+1] knots */
  PetscReal *x[2];     /* [n+1] values less span t */
  PetscReal *m[2];     /* [n+1] second derivatives */
  char digest[DIGEST]; /* of the curves in its file; empty without a file */
} Curve;

/* CurveEvaluate - X(t). CurveLength - length of the curve. CurvePartLength - length from t = `from` to `to`. CurveArea
   - enclosed area. CurveCentroid - centroid of the enclosed area. Not collective. */
PETSC_EXTERN void CurveEvaluate(const Curve *curve, PetscReal t, PetscReal X[2]);
PETSC_EXTERN PetscReal CurveLength(const Curve *curve);
PETSC_EXTERN PetscReal CurvePartLength(const Curve *curve, PetscReal from, PetscReal to);
PETSC_EXTERN PetscReal CurveArea(const Curve *curve);
PETSC_EXTERN void CurveCentroid(const Curve *curve, PetscReal centroid[2]);

/* CurveEqualEdges - M points X[2M] on the curve between which all arcs are equal, on a smooth curve to 1e-9 of their
   length: CurveFit starts from these points for the edges of the spectral derivative. part NULL: M arcs around the
   curve, the first point at t = 0; else M - 1 arcs, the first point at t = part[0] and the last at t = part[1]. chords:
   all chords around the curve are equal, not the arcs; part is NULL. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveEqualEdges(const Curve *curve, const PetscReal part[2], PetscBool chords, PetscInt M,
                                            PetscReal X[]);

/* CurveFit - move M markers X[2M] as little as possible (least squares) until all edges are length/M long and the curve
   encloses the area, by at most `most` steps of Newton's method. spectral: edges are dX/dk and the curve is that of the
   spectral derivative; else edges are chords and the curve is a polygon. left: the largest relative error of squared
   edges and area. A circle, which has no freedom, stays. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[],
                                     PetscInt most, PetscReal *left);

/* CurveFromPoints - the cubic spline through n points xy[2n], periodic or, for an open curve, without curvature at its
   ends. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode CurveFromPoints(const CurveKind *kind, PetscInt n, const PetscReal xy[], Curve *curve);

/* Notes on a curve in a file. */
typedef struct {
  PetscReal velocity[2]; /* length/time, of a line "# velocity u_x u_y" before the curve */
  PetscReal rotation;    /* 1/time, of a line "# rotation w" before the curve */
  PetscBool clockwise;   /* the points in the file run clockwise */
  PetscBool open;        /* there is a line "# open" before the curve */
} CurveNote;

/* CurvesFromFile - the curves of a text file with a point "x y" a line, # before a comment, and an empty line behind
   each curve. Points are put into counter-clockwise order, those of an open curve as if its chord closed it. period:
   [2], 0 for none. With it, a curve whose last point is its first one a period on spans the period in the file's order,
   and a note makes a curve open; with NULL all curves are closed. The caller frees curve[curves], each after
   CurveDestroy, and note[curves] (NULL: not wanted). option: the option that names the file, for messages. Every curve
   has the digest of all points and notes. Collective. */
PETSC_EXTERN PetscErrorCode CurvesFromFile(MPI_Comm comm, const char option[], const char file[],
                                           const PetscReal period[2], PetscInt *curves, Curve **curve,
                                           CurveNote **note);
PETSC_EXTERN PetscErrorCode CurveDestroy(Curve *curve);

/* PointsFromFile - the points xy[2n] of such a file as they stand there; the caller frees them. Collective. */
PETSC_EXTERN PetscErrorCode PointsFromFile(MPI_Comm comm, const char option[], const char file[], PetscInt *n,
                                           PetscReal **xy);

/* The lines of a file of surfaces. */
typedef struct {
  PetscInt columns, surfaces;
  PetscInt *end;       /* [surfaces] lines up to the end of each surface */
  PetscReal *x;        /* [lines][columns] */
  char digest[DIGEST]; /* of all numbers */
} SurfaceRows;

/* SurfacesFromFile - the lines of such a file with points "x y z" or coefficients "l m c_x c_y c_z" of spherical
   harmonics; the caller frees end and x. Collective. */
PETSC_EXTERN PetscErrorCode SurfacesFromFile(MPI_Comm comm, const char option[], const char file[], SurfaceRows *rows);

/* EllipseAxes - semi-axes a >= b of the ellipse with the given area and reduced area

     V = 4 pi area/perimeter^2.

   Not collective. */
PETSC_EXTERN PetscErrorCode EllipseAxes(PetscReal area, PetscReal reduced_area, PetscReal axes[2]);

/* BiconcaveCurve - the red cell's outline of Evans and Fung about the origin, with the long axis along x. Its middle is
   made thicker or thinner to have the reduced area, 0.35 to 0.9 (0.461 in their paper). Not collective. Errors: memory.
 */
PETSC_EXTERN PetscErrorCode BiconcaveCurve(PetscReal area, PetscReal reduced_area, Curve *curve);
