/* A force of short range between membranes, parts of one membrane, and membranes and walls or obstacles
   (docs/suspensions.md, Repulsion): a stress p(d) along the normal at a distance d,

       p = K (1 - d/D)                                   below D,
       p = -30 (W/B) x^2 (1 - x)^2,  x = (d - D)/B       between D and D + B,
       p = 0                                             beyond.

   It pushes below D and, where there is adhesion W, pulls different membranes in a band of width B. In a step it is
   springs: the pairs that touch and their normals are found at the extrapolated markers; the push is taken at the new
   markers, the pull at the extrapolated ones. */
#pragma once
#include "curve/contacts.h"
#include "bodies/force.h"

/* A point of a membrane against an edge or a wall: the distance changes by SUM weight_i normal.(X_i - X*_i), and the
   force on X_i is (push - stiffness (the same sum of X_i instead of X_i - X*_i)) weight_i normal. Where a free body is
   on a side, the distance changes by pull.q as well, q the body's own change of place, and the force and torque on the
   body are (push - ..) pull. */
typedef struct {
  PetscInt n, marker[3];
  PetscReal weight[3], normal[2];
  PetscReal distance;  /* at X* (length) */
  PetscReal stiffness; /* (length^2/time^2) */
  PetscReal push;      /* (length^3/time^2) */
  PetscReal energy;    /* at X* (length^4/time^2) */
  PetscInt body[2];    /* of the point, of the edge: number of the free body, from 1; 0: none */
  PetscReal pull[2][3];
  PetscReal beyond;  /* SUM weight_i x_i of the body's markers (length) */
  PetscReal shifted; /* pull.q of the places for which the force was asked for last (length) */
} Spring;

typedef struct _p_Repulsion *Repulsion;
struct _p_Repulsion {
  Bodies bodies;      /* borrowed */
  Membrane membrane;  /* the vesicles */
  Grid grid;          /* borrowed; its walls and periods */
  SceneRepulsion law; /* K, D, W and B, all resolved */
  Spring *spring;     /* of the step, the same on every rank */
  PetscInt count;
  PetscScalar *all; /* [2(M + W)] work */
};

/* RepulsionBodies - what the places of free bodies add, of the contact force among the forces, if there is one: with
   minus the force of each spring T = alpha stiffness (SUM weight normal.V + SUM pull.q), and less its push where it is
   known,
       F[2n own vesicles] += what q has of T, b[3 own free] += T pull,
   of own V[2n], q[3 own free]; F or b NULL: not wanted. With a known push q is a way. Without, V and q are velocities:
   alpha V and, for its sign, at.end q of the obstacles are the ways. Collective. */
PETSC_EXTERN PetscErrorCode RepulsionBodies(Forces forces, PetscBool known, PetscReal alpha, const PetscScalar V[],
                                            const PetscScalar q[], PetscScalar F[], PetscScalar b[]);
