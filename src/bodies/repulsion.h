/* A force of short range between membranes, and between membranes and walls or obstacles (docs/suspensions.md,
   Repulsion): a stress p(d) along the normal at a distance d,

       p = K (1 - d/D)                                   below D,
       p = -30 (W/B) x^2 (1 - x)^2,  x = (d - D)/B       between D and D + B,
       p = 0                                             beyond.

   It pushes below D and, where there is adhesion W, pulls in a band of width B. In a step it is springs: the pairs that
   touch and their normals are found at the extrapolated markers; the push is taken at the new markers, the pull at the
   extrapolated ones. */
#pragma once
#include "curve/contacts.h"
#include "fluid/grid/grid.h"
#include "bodies/bodies.h"

/* A point of a membrane against an edge or a wall: the distance changes by SUM weight_i normal.(X_i - X*_i), and the
   force on X_i is (push - stiffness (the same sum of X_i instead of X_i - X*_i)) weight_i normal. */
typedef struct {
  PetscInt n, marker[3];
  PetscReal weight[3], normal[2];
  PetscReal distance;  /* at X* (length) */
  PetscReal stiffness; /* (length^2/time^2) */
  PetscReal push;      /* (length^3/time^2) */
  PetscReal energy;    /* at X* (length^4/time^2) */
} Spring;

typedef struct _p_Repulsion *Repulsion;
struct _p_Repulsion {
  Bodies bodies;      /* borrowed; of them */
  Membrane membrane;  /* the vesicles */
  Grid grid;          /* borrowed; its walls and periods */
  SceneRepulsion law; /* K, D, W and B, all resolved */
  Spring *spring;     /* of the step, the same on every rank */
  PetscInt count;
  PetscScalar *all; /* [2(M + W)] work */
};

/* RepulsionCreate - between vesicles, and between vesicles and obstacles or walls. Not collective. */
PETSC_EXTERN PetscErrorCode RepulsionCreate(Bodies bodies, Grid grid, const SceneRepulsion *law, Repulsion *repulsion);
PETSC_EXTERN PetscErrorCode RepulsionDestroy(Repulsion *repulsion);

/* RepulsionPlace - the springs at the markers X[2M] of all vesicles, obstacles where they are at time t. Not
   collective. */
PETSC_EXTERN PetscErrorCode RepulsionPlace(Repulsion repulsion, PetscReal t, const PetscReal X[]);

/* RepulsionStiffness - y += alpha K_rep x, minus the force of the springs that x stretches; own parts x[2n], y[2n].
   Collective. RepulsionPush - y += alpha (the force at x = 0) of the own markers. Not collective. */
PETSC_EXTERN PetscErrorCode RepulsionStiffness(Repulsion repulsion, PetscReal alpha, const PetscScalar x[],
                                               PetscScalar y[]);
PETSC_EXTERN void RepulsionPush(Repulsion repulsion, PetscReal alpha, PetscScalar y[]);

/* RepulsionSeams - SUM over springs of force_x times how far (length, along x) a seam moves the edge that pushes, at
   markers x (own part) with the springs placed at X[2M]: what is too much in SUM force_x x over all markers.
   Collective.
 */
PETSC_EXTERN PetscErrorCode RepulsionSeams(Repulsion repulsion, const PetscReal X[], const PetscScalar x[],
                                           PetscReal *sum);

/* RepulsionAt - what the law gives at time t at markers x[2n] (own part) whatever the springs: y += alpha force of the
   own markers, y NULL: not wanted; the energy, SUM over the films (length^4/time^2). Collective. */
PETSC_EXTERN PetscErrorCode RepulsionAt(Repulsion repulsion, PetscReal t, PetscReal alpha, const PetscScalar x[],
                                        PetscScalar y[], PetscReal *energy);
