/* Solid curves in the fluid: closed, spanning a period, or with both ends on a wall (docs/obstacles.md). Their markers
   Y carry forces Phi on the fluid that hold its velocity there at U_w: u_inf(Y) + E u - C F - beta N N^T F = U_w,     F
   = -Phi, C the near field, of vesicles and obstacles together, N one unit vector a curve that enclosed fluid's
   pressure alone can feel, beta = 1/(4 nu), which leaves that pressure at the mean of the one outside. Every rank has
   all curves; the unknowns are distributed as the layout says. */
#pragma once
#include "curve/kind.h"
#include "markers/layout.h"
#include "scene/scene.h"

typedef struct _p_Obstacles *Obstacles;
struct _p_Obstacles {
  Layout all;           /* borrowed: vesicles and obstacles */
  Layout layout;        /* obstacles alone, on the same ranks */
  PetscReal *X;         /* [2W] markers of all obstacles */
  PetscReal *U;         /* [2W] prescribed velocity there, U_w, at time 0 */
  PetscReal frequency;  /* U_w swings with its cosine (1/time) */
  PetscReal *N;         /* [2W] unit vector of each curve's normals, dX/dk turned outwards */
  PetscReal *center;    /* [2 curves] about which torques are taken: the mean of the markers */
  PetscReal *ds;        /* [curves] mean edge */
  PetscBool *container; /* [curves] the fluid is inside */
  Spectral *spectral;   /* [curves] */
  CurveKind *kind;      /* [curves] */
  PetscReal beta;       /* 1/(4 nu) */
};

/* ObstaclesCreate - of the scene, as the last bodies of the layout of all; *obstacles is NULL where there are none.
   Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesCreate(Scene scene, Layout all, Obstacles *obstacles);
PETSC_EXTERN PetscErrorCode ObstaclesDestroy(Obstacles *obstacles);

/* ObstaclesCurves - markers of all obstacles as others see them, X[2W]: clockwise the curves that have the fluid
   inside. ObstaclesOrder - other numbers of all markers in that order, seen[2W]. Not collective. */
PETSC_EXTERN void ObstaclesCurves(Obstacles obstacles, PetscReal X[]);
PETSC_EXTERN void ObstaclesOrder(Obstacles obstacles, const PetscReal own[], PetscReal seen[]);

/* ObstaclesPressure - y += beta N N^T F, own parts F[2w], y[2w]. Not collective. */
PETSC_EXTERN void ObstaclesPressure(Obstacles obstacles, const PetscScalar F[], PetscScalar y[]);

/* ObstaclesScale - y times, or (inverse) over, the factor (1 + h alpha)/ds of the rows: of the residuals of own
   obstacles, y[2w] (unknowns.h). Not collective. */
PETSC_EXTERN void ObstaclesScale(Obstacles obstacles, PetscReal weight, PetscBool inverse, PetscScalar y[]);

/* ObstaclesData - y += u_inf - U_w of the own obstacles' markers at time t; message is empty, or says that a custom
   flow has no value there, on this rank. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesData(Obstacles obstacles, const Flow *flow, PetscReal t, PetscScalar y[],
                                          char message[PETVES_MAX_MESSAGE]);

/* Of the fluid on an obstacle, a unit of depth, density 1. */
typedef struct {
  PetscReal force[2]; /* (length^3/time^2) */
  PetscReal torque;   /* about its center (length^4/time^2) */
} ObstacleLoad;

/* ObstaclesLoads - of all obstacles, load[curves], from the own F[2w]. Collective. */
PETSC_EXTERN PetscErrorCode ObstaclesLoads(Obstacles obstacles, const PetscScalar F[], ObstacleLoad load[]);
