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
   force on X_i is (push - stiffness (the same sum of X_i instead of X_i - X*_i)) weight_i normal. Markers are those of
   all bodies; an obstacle that does not move freely has none. */
typedef struct {
  PetscInt n, marker[3];
  PetscInt vesicle; /* which has the energy; -1: none */
  PetscReal weight[3], normal[2];
  PetscReal distance;  /* at X* (length) */
  PetscReal stiffness; /* (length^2/time^2) */
  PetscReal push;      /* (length^3/time^2) */
  PetscReal energy;    /* at X* (length^4/time^2) */
} Spring;

typedef struct _p_Repulsion *Repulsion;
struct _p_Repulsion {
  Bodies bodies;      /* borrowed */
  Grid grid;          /* borrowed; its walls and periods */
  SceneRepulsion law; /* K, D, W and B, all resolved */
  Spring *spring;     /* of the step, the same on every rank */
  PetscInt count;
  PetscScalar *all; /* [2(M + W)] work */
};
