/* Grids on the unit sphere, and the tables that all surfaces of one degree share.

   A grid of degree q has q + 1 latitudes at the nodes of Gauss and Legendre, and 2q + 2 longitudes from 0 on, latitude
   by latitude from the north pole. Its weights integrate harmonics of degree 2q + 1 exactly.

   Fields, such as X, have three components, which are made of some harmonics each. On a whole sphere each component is
   made of all of them, with its own coefficients. Of a body of revolution about x,

       x = SUM b_l Y_(l, 0),      (y, z) = SUM a_l (Y_(l, 1), Y_(l, -1))/sqrt(2)        (b_0 .. b_p, a_1 .. a_p),

   y and z share their coefficients, scalars are sums of Y_(l, 0), and the points of one meridian, phi = 0, are enough:
   there y is the distance from the axis, and z = 0 but for its derivatives by phi.

   A turned grid has its pole at a point of another grid. With its own weights

       w_j SUM_(n <= q) 2 sin(theta_j/2) P_n(cos theta_j)

   it integrates 1/(2 sin(theta/2)) times a harmonic of degree q exactly, theta the angle to the pole: what a single
   layer has near a point of its surface. A turn about the axis of the sphere mixes the coefficients m and -m
   (HarmonicsTurn), so there is a table of harmonics for each latitude only. */
#pragma once
#include "sphere/harmonics.h"

/* What is represented: any surface, or bodies of revolution about the axis x. */
typedef enum { SPHERE_WHOLE, SPHERE_REVOLVED } SphereSymmetry;

/* Which longitudes of a grid there are: all; those up to pi, which stand for their mirror images too; 0 for all. */
typedef enum { GRID_WHOLE, GRID_HALF, GRID_MERIDIAN } GridCover;

typedef struct {
  PetscInt q, around, n;  /* degree, longitudes, (q + 1) around points */
  PetscReal *theta, *phi; /* [n] */
  PetscReal *weight;      /* [n] */
} SphereGrid;

PETSC_EXTERN PetscErrorCode SphereGridCreate(PetscInt q, GridCover cover, SphereGrid *grid);
PETSC_EXTERN PetscErrorCode SphereGridDestroy(SphereGrid *grid);

/* The harmonics of a component of fields, and its coefficients among those of the field. */
typedef struct {
  PetscInt first, columns;
  const PetscReal *part[HARMONIC_PARTS]; /* [columns][n] */
} FieldComponent;

/* A grid with its harmonics, of which SphereTableCreate makes the first `parts`. */
typedef struct {
  SphereGrid grid;
  PetscReal *part[HARMONIC_PARTS]; /* [columns][n], scalars first; NULL: not made */
  FieldComponent component[3];
} SphereTable;

typedef struct _p_Sphere *Sphere;
struct _p_Sphere {
  SphereSymmetry symmetry;
  PetscInt p;          /* degree */
  PetscInt count;      /* coefficients of a scalar */
  PetscInt size;       /* coefficients of a field */
  PetscInt *degree;    /* [size] of a field's harmonics */
  SphereTable shape;   /* degree p, with first derivatives: targets of layers, points that are shown */
  SphereTable fine;    /* degree 2p, with derivatives: bending, area */
  SphereTable *turned; /* [p + 1] degree 3p/2 with singular weights, poles at the points of `shape` at longitude 0, one
                          a latitude; NULL until first used, as those below */
  SphereTable *normal; /* [p + 1] these points with harmonics of degree 2p */
  SphereTable twice;   /* harmonics of degree 2p on the grid of degree 2p, made with `normal` */
};

/* SphereCreate - the tables of degree p >= 2. Not collective. */
PETSC_EXTERN PetscErrorCode SphereCreate(PetscInt p, SphereSymmetry symmetry, Sphere *sphere);
PETSC_EXTERN PetscErrorCode SphereDestroy(Sphere *sphere);

/* SphereTurn - make sphere->turned, and sphere->normal where normals are wanted, unless they have been made. Not
   collective. */
PETSC_EXTERN PetscErrorCode SphereTurn(Sphere sphere, PetscBool normals);

/* SphereTableCreate - of harmonics of degree p at most on a grid of degree q; parts: of those of HarmonicsAt, the
   first ones. SphereTableAt - on a whole sphere at n points with these weights. Not collective. */
PETSC_EXTERN PetscErrorCode SphereTableAt(PetscInt p, PetscInt n, const PetscReal theta[], const PetscReal phi[],
                                          const PetscReal weight[], PetscInt parts, SphereTable *table);
PETSC_EXTERN PetscErrorCode SphereTableCreate(PetscInt p, PetscInt q, SphereSymmetry symmetry, PetscInt parts,
                                              SphereTable *table);
PETSC_EXTERN PetscErrorCode SphereTableDestroy(SphereTable *table);

/* SphereTableValues - y[fields][n] at the points, of coefficients c[fields][count]; part: which derivative.
   SphereTableProject - c[fields][count], the coefficients of values y[fields][n]. Not collective. */
PETSC_EXTERN PetscErrorCode SphereTableValues(const SphereTable *table, PetscInt part, PetscInt count, PetscInt fields,
                                              const PetscReal c[], PetscReal y[]);
PETSC_EXTERN PetscErrorCode SphereTableProject(const SphereTable *table, PetscInt count, PetscInt fields,
                                               const PetscReal y[], PetscReal c[]);

/* SphereFieldValues - y[3][n] at the points, of the field c[size]. SphereFieldProject - c[size] of the values y[3][n];
   SphereFieldAdd - c += them.
   SphereUnfold - whole[components][HarmonicsCount(p)], the coefficients on a whole sphere of the field c[size] (3) or
   the scalar c[count] (1). SphereFold - the transpose of this map, of a field. Not collective. */
PETSC_EXTERN PetscErrorCode SphereFieldValues(const SphereTable *table, PetscInt part, const PetscReal c[],
                                              PetscReal y[]);
PETSC_EXTERN PetscErrorCode SphereFieldProject(const SphereTable *table, const PetscReal y[], PetscReal c[]);
PETSC_EXTERN PetscErrorCode SphereFieldAdd(const SphereTable *table, const PetscReal y[], PetscReal c[]);
PETSC_EXTERN void SphereUnfold(Sphere sphere, int components, const PetscReal c[], PetscReal whole[]);
PETSC_EXTERN void SphereFold(Sphere sphere, const PetscReal whole[], PetscReal c[]);
