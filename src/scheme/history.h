/* The states that a step goes on from: the present state and those before it. Labels turn with the tank-treading
   membranes (docs/steps.md, Frame of the labels), so that a steady shape is the same in all states. */
#pragma once
#include "scheme/bdf.h"
#include "scheme/stepcommon.h"

typedef struct {
  PetscInt n;                      /* states whose markers are carried: 1 to BDF_MOST */
  PetscInt solved;                 /* states that a step has led to, at most BDF_STATES; the first state of a run has no
                                      velocity and no sigma */
  PetscReal step[BDF_STATES];      /* the step to be made, the step before it, and so on (time) */
  PetscReal *treading;             /* [vesicles] V, speed of the labels (1/time) */
  PetscBool moving;                /* the labels of a vesicle turn */
  Vec X[BDF_MOST];                 /* markers of the states, carried along; borrowed */
  Vec U[BDF_STATES];               /* velocities of the solved states, of one at least, carried along; borrowed */
  Vec room[BDF_MOST + BDF_STATES]; /* where X and U are when labels turn */
  Vec carried;                     /* edge vector: work */
  Vec guess[2];                    /* of free bodies, work: a place, forces and velocities; NULL without */
} History;

/* HistoryCreate - for the scheme's vectors. Collective. */
PETSC_EXTERN PetscErrorCode HistoryCreate(Scheme scheme, History *history);
PETSC_EXTERN PetscErrorCode HistoryDestroy(History *history);

/* HistoryCarry - before a step of size dt: fit V of each vesicle to the present velocity of its markers (zero in a
   first step, and of membranes that are not spectral), and carry markers and velocities of the states. Collective. */
PETSC_EXTERN PetscErrorCode HistoryCarry(History *history, Scheme scheme, PetscReal dt);

/* HistorySum - y = scale SUM_j weight_j x_j over the first `count` states, of vectors x_j that are carried or need not
   be. HistoryEdges - y = SUM_j weight_j x_j of the states' own edge vectors, which are carried here. Not collective. */
PETSC_EXTERN PetscErrorCode HistorySum(PetscInt count, const PetscReal weight[], PetscReal scale, const Vec x[], Vec y);
PETSC_EXTERN PetscErrorCode HistoryEdges(History *history, Membrane membrane, PetscInt count, const PetscReal weight[],
                                         const Vec x[], Vec y);
