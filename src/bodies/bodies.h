/* All curves whose markers act on the fluid, vesicles first, then obstacles: the layout of markers, forces and
   velocities that coupling and near field know. Without obstacles it is the membranes' own. */
#pragma once
#include "bodies/obstacles.h"
#include "bodies/membrane.h"

typedef struct _p_Bodies *Bodies;
struct _p_Bodies {
  Layout layout;       /* borrowed */
  Membrane membrane;   /* borrowed */
  PetscInt vesicles;   /* so many of the bodies, the first ones */
  PetscReal *ds;       /* [bodies] mean edge (length) */
  Spectral *spectral;  /* [bodies], borrowed */
  CurveKind *kind;     /* [bodies] */
  PetscBool *resting;  /* [bodies] obstacles that stay where they are */
  Obstacles obstacles; /* borrowed; NULL without */
};

/* BodiesCreate - of membranes and obstacles (NULL: none). Not collective. */
PETSC_EXTERN PetscErrorCode BodiesCreate(Membrane membrane, Obstacles obstacles, Bodies *bodies);
PETSC_EXTERN PetscErrorCode BodiesDestroy(Bodies *bodies);

/* BodiesSee - the curves as contacts look at them (contacts.h), all[2(M + W)]: vesicles at X[2M], then the obstacles at
   an instant, those clockwise that have the fluid inside. X may be all. Not collective. */
PETSC_EXTERN PetscErrorCode BodiesSee(Bodies bodies, Instant at, const PetscReal X[], PetscReal all[]);

/* BodiesObstacleNumbers - this rank's numbers (two a marker) of obstacles in a marker vector of all bodies;
   BodiesFirstObstacle - where they start. Not collective. */
static inline PetscInt BodiesObstacleNumbers(Bodies b) {
  return b->obstacles ? 2 * b->obstacles->layout->n : 0;
}
static inline PetscInt BodiesFirstObstacle(Bodies b) {
  return 2 * b->layout->n - BodiesObstacleNumbers(b);
}
