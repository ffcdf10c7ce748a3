/* How a solid body moves: not at all, as it is told (-obstacle_moving), or freely (-obstacle_free): then its place is
   part of the state of a run (freebodies.h). Of the second kind: with the velocity U cos(ft) and the rotation
   w cos(ft) its center is at c + U s, and it has turned by w s, s = sin(ft)/f or, with f = 0, t. That is exact at any
   time, so there is nothing of it to integrate or to keep. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscReal center[2];             /* c, about which it turns and torques are taken: the mean of its markers, of a body
                                      that moves freely the centroid of its area */
  PetscReal velocity[2], rotation; /* of its surface, at time 0 */
  PetscReal frequency;             /* f (1/time) */
  PetscInt free;                   /* number, from 1, among the bodies that move freely; 0: it is none of them */
  PetscBool carried, turned;       /* its markers move; they turn, which those of a circle need not */
} BodyMotion;

/* A time, and where the bodies are then that move freely: center and angle of each, on every rank; NULL: where they
   were at time 0. In a step, the place at its end changes by q times `end` (time) with the velocity q of that time. */
typedef struct {
  PetscReal t;
  Vec place;
  PetscReal end;
} Instant;

/* InstantCopy - an instant with a place of its own, which VecDestroy frees. Not collective. */
PETSC_EXTERN PetscErrorCode InstantCopy(Instant from, Instant *copy);

/* Where a body is. */
typedef struct {
  PetscReal center[2];
  PetscReal angle; /* by which it has turned since time 0 (radian) */
} BodyPose;

PETSC_EXTERN BodyPose MotionPose(const BodyMotion *motion, Instant at);

/* MotionCarry - the n markers X at an instant from those at rest, at time 0. MotionVelocity - the velocity U at an
   instant of the body where X is. MotionTurn - n vectors F of the body as it stands at one instant become those of the
   same body at another one. MotionStride - the farthest way of a point at the distance `reach` from the center, from
   one instant to another. MotionSum - sum[3] += R^T F, force and torque about a center of F[2n] at X[2n]. */
PETSC_EXTERN void MotionCarry(const BodyMotion *motion, Instant at, PetscInt n, const PetscReal rest[], PetscReal X[]);
PETSC_EXTERN void MotionVelocity(const BodyMotion *motion, Instant at, const PetscReal X[2], PetscReal U[2]);
PETSC_EXTERN void MotionTurn(const BodyMotion *motion, Instant from, Instant to, PetscInt n, PetscReal F[]);
PETSC_EXTERN PetscReal MotionStride(const BodyMotion *motion, Instant from, Instant to, PetscReal reach);
PETSC_EXTERN void MotionSum(const PetscReal center[2], PetscInt n, const PetscReal X[], const PetscReal F[],
                            PetscReal sum[3]);
