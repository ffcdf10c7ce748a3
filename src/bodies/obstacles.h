/* Solid curves in the fluid: closed, spanning a period, or with both ends on a wall (docs/obstacles.md). The unknowns
   are the forces F of the fluid on their markers Y, the rows hold its velocity there at U_w, that of their motion
   (motion.h):

       u_inf(Y) + E u - C F - beta N N^T F = U_w,

   C the near field of vesicles and obstacles together, N one unit vector a curve, on which the pressure of enclosed
   fluid alone acts, beta = 1/(4 nu), by which that pressure has the mean of the pressure outside. Every rank has all
   curves; the unknowns are distributed as the layout says. */
#pragma once
#include "bodies/motion.h"
#include "curve/kind.h"
#include "markers/layout.h"
#include "scene/scene.h"

typedef struct _p_Obstacles *Obstacles;
struct _p_Obstacles {
  Layout all;                 /* borrowed: vesicles and obstacles */
  Layout layout;              /* obstacles alone, on the same ranks */
  const PetscReal *rest;      /* [2W] markers of all obstacles at time 0; the scene's, as kind, container and vesicle */
  PetscReal *X;               /* [2W] where they have been placed */
  Instant at;                 /* at this time */
  BodyMotion *motion;         /* [curves] */
  Layout free;                /* bodies that move freely, as one marker each (freebodies.h) */
  PetscReal *load;            /* [3 free] force and torque on each of them from outside */
  PetscReal *density;         /* [free] of each of them over that of the fluid */
  PetscBool moving;           /* whether a curve moves */
  PetscReal *N;               /* [2W] unit vector of each curve's normals, dX/dk turned outwards, where placed */
  PetscReal *ds;              /* [curves] mean edge */
  const CurveKind *kind;      /* [curves] */
  const PetscBool *container; /* [curves] the fluid is inside */
  const PetscInt *vesicle;    /* [curves] the vesicle around each; -1: none */
  PetscReal *ratio;           /* [curves] viscosity around each over nu */
  Spectral *spectral;         /* [curves] */
  PetscReal beta;             /* 1/(4 nu) */
  PetscBool modes;            /* the preconditioner takes their block apart (obstaclemodes.h) */
};

/* ObstaclesCreate - of the scene, as the last bodies of the layout of all; *obstacles is NULL where there are none.
   Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesCreate(Scene scene, Layout all, Obstacles *obstacles);
PETSC_EXTERN PetscErrorCode ObstaclesDestroy(Obstacles *obstacles);

/* FreeBodyAt - where the three numbers of an own free body stand among those of own free bodies. ObstacleRadius - that
   of a circle of the curve's length. Not collective. */
static inline PetscInt FreeBodyAt(Obstacles o, PetscInt curve) {
  return 3 * (o->motion[curve].free - 1 - o->free->first);
}
static inline PetscReal ObstacleRadius(Obstacles o, PetscInt curve) {
  return o->ds[curve] * LayoutCount(o->layout, curve) / (2 * PETSC_PI);
}

/* ObstaclesPlace - X and N at an instant. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesPlace(Obstacles obstacles, Instant at);

/* ObstaclesCheck - whether moving bodies at an instant keep the distance from walls and from other obstacles, images
   among them, down to which their forces are right: KERNEL_FOLDED_CELLS cells and SCENE_LEAST_GAP edges.
   ObstaclesCheckStride - whether no body steps over what it would run into: from one instant to another it goes by at
   most half its width. message is empty, or says which do not. Not collective. */
PETSC_EXTERN PetscErrorCode ObstaclesCheck(Obstacles obstacles, Scene scene, Instant at,
                                           char message[PETVES_MAX_MESSAGE]);
PETSC_EXTERN PetscErrorCode ObstaclesCheckStride(Obstacles obstacles, Instant from, Instant to,
                                                 char message[PETVES_MAX_MESSAGE]);

/* ObstacleStride - the farthest way of a marker of a curve from one instant to another. Not collective. */
PETSC_EXTERN PetscReal ObstacleStride(Obstacles obstacles, PetscInt curve, Instant from, Instant to);

/* ObstaclesCurves - markers of all obstacles at an instant as others see them, X[2W]: clockwise the curves that have
   the fluid inside. Not collective. */
PETSC_EXTERN void ObstaclesCurves(Obstacles obstacles, Instant at, PetscReal X[]);

/* ObstaclesRows - y += beta N N^T F, what obstacles give their rows themselves, of own F[2w], y[2w]. ObstaclesTurn -
   own vectors at the markers as the bodies stood at one instant, F[2w], become those at another, with what stands
   behind them of free bodies. Not collective. */
PETSC_EXTERN void ObstaclesRows(Obstacles obstacles, const PetscScalar F[], PetscScalar y[]);
PETSC_EXTERN void ObstaclesTurn(Obstacles obstacles, Instant from, Instant to, PetscScalar F[]);

/* ObstaclesScale - multiply the residuals y of the own rows by weight/ds, those of force and torque on free bodies by
   1/ds and 1/(ds radius), or (inverse) divide. Not collective. */
PETSC_EXTERN void ObstaclesScale(Obstacles obstacles, PetscReal weight, PetscBool inverse, PetscScalar y[]);

/* ObstaclesTarget - k += u_inf - U_w at the obstacles' markers where and when they have been placed, the last ones of
   each rank's part of k, a marker vector of all bodies; message is empty, or says that a custom flow has no value
   there. Collective. */
PETSC_EXTERN PetscErrorCode ObstaclesTarget(Obstacles obstacles, const Flow *flow, Vec k,
                                            char message[PETVES_MAX_MESSAGE]);

/* ObstaclesLoads - of the fluid on all obstacles at an instant, a unit of depth, density 1, from the own F[2w]: load[3
   curves], the force (length^3/time^2) and the torque about the center (length^4/time^2). Collective. */
PETSC_EXTERN PetscErrorCode ObstaclesLoads(Obstacles obstacles, Instant at, const PetscScalar F[], PetscReal load[]);
