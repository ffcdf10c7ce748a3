/* Solid curves in the fluid: closed, spanning a period, or with both ends on a wall (docs/obstacles.md). Their markers
   Y carry forces Phi = -F on the fluid that hold its velocity there at U_w,

       u_inf(Y) + E u - C F - beta N N^T F = U_w,

   C the near field of vesicles and obstacles together, N one unit vector a curve, on which the pressure of enclosed
   fluid alone acts, beta = 1/(4 nu), by which that pressure has the mean of the pressure outside. Every rank has all
   curves; the unknowns are distributed as the layout says.

   A body that moves (-obstacle_moving) is the same markers, carried and turned about their middle c as a solid: with
   velocity U cos(ft) and rotation w cos(ft) it is at c + U s, turned by w s, s = sin(ft)/f or, with f = 0, t. That is
   exact at any time, so there is nothing of it to integrate or to keep. */
#pragma once
#include "curve/kind.h"
#include "fluid/grid/grid.h"
#include "markers/layout.h"
#include "scene/scene.h"

typedef struct _p_Obstacles *Obstacles;
/* What a curve's surface does at time 0, and what of it the curve does too. */
typedef struct {
  PetscReal velocity[2], rotation;
  PetscBool carried, turned; /* the curve moves; its markers turn, which those of a circle need not */
} ObstacleMotion;

/* Where a body is. */
typedef struct {
  PetscReal center[2]; /* the mean of its markers, about which it turns and torques are taken */
  PetscReal angle;     /* by which it has turned since time 0 (radian) */
} ObstaclePose;

struct _p_Obstacles {
  Layout all;             /* borrowed: vesicles and obstacles */
  Layout layout;          /* obstacles alone, on the same ranks */
  PetscReal *rest;        /* [2W] markers of all obstacles at time 0 */
  PetscReal *X;           /* [2W] where they have been placed */
  PetscReal t;            /* at this time */
  ObstacleMotion *motion; /* [curves] */
  PetscBool moving;       /* whether a curve moves */
  PetscReal frequency;    /* velocities swing with its cosine (1/time) */
  PetscReal *N;           /* [2W] unit vector of each curve's normals, dX/dk turned outwards, where placed */
  PetscReal *center;      /* [2 curves] the mean of the markers at time 0 */
  PetscReal *ds;          /* [curves] mean edge */
  PetscBool *container;   /* [curves] the fluid is inside */
  PetscInt *vesicle;      /* [curves] the vesicle around each; -1: none */
  PetscReal *ratio;       /* [curves] viscosity around each over nu */
  Spectral *spectral;     /* [curves] */
  CurveKind *kind;        /* [curves] */
  PetscReal beta;         /* 1/(4 nu) */
  PetscBool modes;        /* the preconditioner takes their block apart (obstaclemodes.h) */
};

/* ObstaclesCreate - of the scene, as the last bodies of the layout of all; *obstacles is NULL where there are none.
   Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesCreate(Scene scene, Layout all, Obstacles *obstacles);
PETSC_EXTERN PetscErrorCode ObstaclesDestroy(Obstacles *obstacles);

/* ObstaclesPlace - X and N at time t. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesPlace(Obstacles obstacles, PetscReal t);

/* ObstaclesPose - of one curve at time t. Not collective. */
PETSC_EXTERN ObstaclePose ObstaclesPose(Obstacles obstacles, PetscInt curve, PetscReal t);

/* ObstaclesCheck - whether moving bodies at time t keep the distance from walls and from other obstacles, images among
   them, down to which their forces are right: KERNEL_FOLDED_CELLS cells and SCENE_LEAST_GAP edges. message is empty,
   or says which do not. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesCheck(Obstacles obstacles, Grid grid, PetscReal t,
                                           char message[PETVES_MAX_MESSAGE]);

/* ObstaclesCurves - markers of all obstacles at time t as others see them, X[2W]: clockwise the curves that have the
   fluid inside. ObstaclesOrder - other numbers of all markers in that order, seen[2W], which may be
   own. Not collective. */
PETSC_EXTERN void ObstaclesCurves(Obstacles obstacles, PetscReal t, PetscReal X[]);
PETSC_EXTERN void ObstaclesOrder(Obstacles obstacles, const PetscReal own[], PetscReal seen[]);

/* ObstaclesPressure - y += beta N N^T F, own parts F[2w], y[2w]. Not collective. */
PETSC_EXTERN void ObstaclesPressure(Obstacles obstacles, const PetscScalar F[], PetscScalar y[]);

/* ObstaclesScale - y times, or (inverse) over, the factor weight/ds of the rows: of the residuals of own
   obstacles, y[2w] (unknowns.h). Not collective. */
PETSC_EXTERN void ObstaclesScale(Obstacles obstacles, PetscReal weight, PetscBool inverse, PetscScalar y[]);

/* ObstaclesData - y += u_inf - U_w of the own obstacles' markers where and when they have been placed; message is
   empty, or says that a custom flow has no value there, on this rank. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesData(Obstacles obstacles, const Flow *flow, PetscScalar y[],
                                          char message[PETVES_MAX_MESSAGE]);

/* Of the fluid on an obstacle, a unit of depth, density 1. */
typedef struct {
  PetscReal force[2]; /* (length^3/time^2) */
  PetscReal torque;   /* about where its center is (length^4/time^2) */
} ObstacleLoad;

/* ObstacleLoadAdd - to += scale times a load that acts at the distance d (length) from the place of `to`. */
static inline void ObstacleLoadAdd(ObstacleLoad *to, PetscReal scale, const ObstacleLoad *from, const PetscReal d[2]) {
  for (int c = 0; c < 2; c++) to->force[c] += scale * from->force[c];
  to->torque += scale * (from->torque + d[0] * from->force[1] - d[1] * from->force[0]);
}

/* ObstaclesLoads - of all obstacles at time t, load[curves], from the own F[2w]. Collective. */
PETSC_EXTERN PetscErrorCode ObstaclesLoads(Obstacles obstacles, PetscReal t, const PetscScalar F[],
                                           ObstacleLoad load[]);
