/* Grids on the unit sphere, and the tables that all surfaces of one degree share.

   A grid of degree q has q + 1 latitudes at the nodes of Gauss and Legendre, and 2q + 2 longitudes from 0 on, latitude
   by latitude from the north pole. Its weights integrate harmonics of degree 2q + 1 exactly.

   A turned grid has its pole at a point of another grid. With its own weights

       w_j SUM_(n <= q) 2 sin(theta_j/2) P_n(cos theta_j)

   it integrates 1/(2 sin(theta/2)) times a harmonic of degree q exactly, theta the angle to the pole: what a single
   layer has near a point of its surface. A turn about the axis of the sphere mixes the coefficients m and -m
   (HarmonicsTurn), so there is a table of harmonics for each latitude only. */
#pragma once
#include "sphere/harmonics.h"

typedef struct {
  PetscInt q, n;          /* degree, (q + 1)(2q + 2) points */
  PetscReal *theta, *phi; /* [n] */
  PetscReal *weight;      /* [n] */
} SphereGrid;

PETSC_EXTERN PetscErrorCode SphereGridCreate(PetscInt q, SphereGrid *grid);
PETSC_EXTERN PetscErrorCode SphereGridDestroy(SphereGrid *grid);

/* A grid with its harmonics. */
typedef struct {
  SphereGrid grid;
  PetscReal *part[HARMONIC_PARTS]; /* [count][n]; NULL: not made */
} SphereTable;

/* The turned grids of the points of a grid at longitude 0. */
typedef struct {
  PetscInt p;            /* degree of the harmonics */
  PetscInt latitudes, n; /* points of each; 0: not made */
  PetscReal *Y;          /* [latitudes][count][n] */
  PetscReal *weight;     /* [n] the singular ones */
} TurnedGrids;

typedef struct _p_Sphere *Sphere;
struct _p_Sphere {
  PetscInt p, count;  /* degree, number of harmonics */
  SphereTable shape;  /* degree p, values: targets of layers, points that are shown */
  SphereTable fine;   /* degree 2p, with derivatives: bending, area */
  TurnedGrids turned; /* degree 3p/2, poles at the points of `shape` */
  TurnedGrids normal; /* the same points with harmonics of degree 2p; made when first used */
  SphereTable twice;  /* harmonics of degree 2p on the grid of degree 2p, made with it */
};

/* SphereCreate - the tables of degree p >= 2. Not collective. */
PETSC_EXTERN PetscErrorCode SphereCreate(PetscInt p, Sphere *sphere);
PETSC_EXTERN PetscErrorCode SphereDestroy(Sphere *sphere);

/* SphereNormalTables - make sphere->normal, unless it has been made. Not collective. */
PETSC_EXTERN PetscErrorCode SphereNormalTables(Sphere sphere);

/* SphereTableCreate - of harmonics of degree p at most on a grid of degree q; parts as in HarmonicsAt. Not collective.
 */
PETSC_EXTERN PetscErrorCode SphereTableCreate(PetscInt p, PetscInt q, PetscInt parts, SphereTable *table);
PETSC_EXTERN PetscErrorCode SphereTableDestroy(SphereTable *table);

/* SphereTableValues - y[fields][n] at the points, of coefficients c[fields][count]; part: which derivative.
   SphereTableProject - c[fields][count], the coefficients of values y[fields][n]. Not collective. */
PETSC_EXTERN PetscErrorCode SphereTableValues(const SphereTable *table, PetscInt part, PetscInt count, PetscInt fields,
                                              const PetscReal c[], PetscReal y[]);
PETSC_EXTERN PetscErrorCode SphereTableProject(const SphereTable *table, PetscInt count, PetscInt fields,
                                               const PetscReal y[], PetscReal c[]);
