/* Bodies that move as the fluid carries them (docs/obstacles.md, Free bodies). Three unknowns q a body, the velocity of
   its center and its rotation, and three rows; R are the body's rigid motions at its markers,

       u_inf(Y) + E u - C F - beta N N^T F - m R q = 0,      R^T F + load = 0,

   m the viscosity around the body over nu, load the force and the torque on it from outside. Without inertia a body has
   no mass; innerfluid.h has what fluid with inertia adds to the last row. The place of a body, center and angle, is
   integrated by an Adams formula (scheme/bdf.h) with q for the rate, and its markers follow from it, so its shape never
   changes.

   Unknowns and residuals of obstacles, and the force of a state, are arrays [2w + 3 own free]: q stands behind F, R^T F
   + load behind the rows of the markers. A place is a vector that every rank has, [3 free]. */
#pragma once
#include "bodies/obstacles.h"

/* FreeBodiesCreateVecs - for a state: the force, zero, and the places at time 0 (NULL where no body moves freely).
   Collective. */
PETSC_EXTERN PetscErrorCode FreeBodiesCreateVecs(Obstacles obstacles, Vec *force, Vec *place);

/* FreeBodiesCarry - U[2w] += alpha R q, of q[3 own free], with ratio[curves] (NULL: 1) alpha ratio R q. FreeBodiesShift
   - X[2w] += how far a place is from where bodies have been placed, to first order. FreeBodiesSum - sum[3 own free] +=
   R^T F. Not collective. */
PETSC_EXTERN void FreeBodiesCarry(Obstacles obstacles, PetscReal alpha, const PetscReal ratio[], const PetscScalar q[],
                                  PetscScalar U[]);
PETSC_EXTERN void FreeBodiesShift(Obstacles obstacles, Vec place, PetscScalar X[]);
PETSC_EXTERN void FreeBodiesSum(Obstacles obstacles, const PetscScalar F[], PetscScalar sum[]);

/* FreeBodiesBalance - F[2w] += the rigid parts by which R^T F of own bodies, where they have been placed, becomes minus
   the load[3 own free]. Not collective. */
PETSC_EXTERN void FreeBodiesBalance(Obstacles obstacles, const PetscReal load[], PetscScalar F[]);

/* FreeBodiesBlock - A, h^2 times the mobility C of the markers of curves begin .. end - 1, becomes the block of F and,
   behind them, q/unit m of the free bodies among them,

       (C + beta N N^T) F + m R q = r,   unit (R^T F - inertia M q) = unit s,

   with the mass M[3 free] (NULL: 0). A has room for it. FreeBodyUnit - unit of one of the three numbers of a body, by
   which both parts of the matrix are of one size. Not collective. */
PETSC_EXTERN PetscErrorCode FreeBodiesBlock(Obstacles obstacles, PetscInt begin, PetscInt end, PetscReal h,
                                            PetscReal inertia, const PetscReal mass[], PetscReal A[]);
static inline PetscReal FreeBodyUnit(Obstacles o, PetscInt curve, PetscInt number) {
  return number < 2 ? o->beta : o->beta / ObstacleRadius(o, curve);
}

/* FreeBodiesFarthest - raises `farthest` to the farthest way of a marker of all bodies from one place to another. Not
   collective. */
PETSC_EXTERN void FreeBodiesFarthest(Obstacles obstacles, Vec from, Vec to, PetscReal *farthest);

/* FreeBodiesMove - place += time q, with the q of a state's force. FreeBodiesTurn - the force turns with the bodies
   from where they have been placed to this place. Collective. */
PETSC_EXTERN PetscErrorCode FreeBodiesMove(Obstacles obstacles, Vec force, PetscReal time, Vec place);
PETSC_EXTERN PetscErrorCode FreeBodiesTurn(Obstacles obstacles, Vec place, Vec force);
