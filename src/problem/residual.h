/* The coupled problem of one time step for velocity, pressure and tension together (docs/solver.md),

       (1)  U = known + M (F, G)                                the mobility (mobility/mobility.h)
       (2)  F = Dm^T sigma + (1/a0) K V                         minus h^2 times the force of a membrane
       (3)  (1 + ratio)/2 G - U = k                             the fluid at vesicles' markers moves with G
            G = V + (v/a0) dV/dt + (P/l) n n^T F + known        water passes markers (bodies/seepage.h)
       (4)  Dm V/h^2 = g                                        inextensible edges
       (5)  U - beta N N^T F - m R q + k = 0                    no slip on obstacles, whose F is unknown
       (6)  R^T F + load + contact = a0 M q - INT_inside R^T Du/Dt   obstacles that move freely, with the velocity q

   V is the markers' velocity without the background's, seen from labels that turn at the speed v of their vesicle; G is
   the motion of the fluid there, P the membranes' permeability; K is what the forces change by with their markers
   (bodies/force.h); k is the background's velocity, less that of the obstacle; M and the integral are 0 without inertia
   of the fluid (bodies/innerfluid.h).

   A Stokes solve gives the fluid's velocity and pressure for any force. So the unknowns are V, the obstacles' F, q and
   sigma, and a product with the operator costs one Stokes solve for the velocity at the markers alone; velocity and
   pressure on the grid follow from the solution's forces.

   ReducedBegin begins a step; then ReducedAdd and products with A, as often as a solver needs them.
   Ranks have the rows of their own markers. */
#pragma once
#include "problem/unknowns.h"

/* A problem: its right-hand sides, and the vectors that the solution goes to. */
typedef struct {
  MobilityKnown known; /* what is known of the velocity; its forcing gets all forces of the solution */
  Vec g, k;            /* right-hand sides of the rows Dm V/h^2 (edge vector) and of velocities (all bodies' markers) */
  PetscBool graded;    /* the step is a part of a graded start */
  const PetscReal *load; /* [3 own free] known force and torque on free bodies; NULL without */
  Vec sigma, V, solid;   /* tension, V and force on obstacles (NULL without): first guess and solution */
} CoupledProblem;

typedef struct _p_Reduced *Reduced;
struct _p_Reduced {
  Unknowns unknowns;             /* borrowed */
  Mat A;                         /* the residuals' derivative, scaled */
  const CoupledProblem *problem; /* the problem under way, borrowed */
  Vec F, U;                      /* work, all bodies' markers: forces and velocity */
  Vec G;                         /* work, the vesicles' markers: motion */
  PetscInt free;                 /* 3 own free */
  PetscScalar *push[2]; /* [free] minus the force of contact on own bodies: of the last F, of the step so far */
};

/* ReducedCreate - the problem for these unknowns. Collective. */
PETSC_EXTERN PetscErrorCode ReducedCreate(Unknowns unknowns, Reduced *reduced);
PETSC_EXTERN PetscErrorCode ReducedDestroy(Reduced *reduced);

/* ReducedBegin - begin a problem, borrowed until the next one, with unknowns that are zero. ReducedAdd - after the
   unknowns have changed by `added` to x: residual becomes minus the scaled residuals at x, by one Stokes solve.
   Collective. */
PETSC_EXTERN PetscErrorCode ReducedBegin(Reduced reduced, const CoupledProblem *problem);
PETSC_EXTERN PetscErrorCode ReducedAdd(Reduced reduced, Vec added, Vec x, Vec residual);
