/* The coupled problem of one time step for velocity, pressure and tension together (docs/solver.md),

       (1)  H u + G p + E^T F/h^2 = f,   G^T u = 0              the fluid
       (2)  F = Dm^T sigma + (1/a0) K V                         minus h^2 times the force of a membrane
       (3)  V + (v/a0) dV/dt - E u + C F = k                    vesicles' markers move with the fluid
       (4)  Dm V/h^2 = g                                        inextensible edges
       (5)  E_w u - C F - beta N N^T F + k_w = 0                no slip on obstacles, whose F is unknown

   V is the markers' velocity without the background's, seen from labels that turn at the speed v of their vesicle; C is
   the near field of all bodies; K is what the forces change by with their markers (bodies/force.h); k is what C gives
   of the known forces.

   A Stokes solve gives u and p for any force. So the unknowns are V, the obstacles' F and sigma, and a product with the
   operator costs one Stokes solve for the velocity at the markers alone (fluid/stokes/stream.h); u and p follow from
   the solution's forces. In unbounded fluid E = 0 and C is all of the mobility: u and p stay zero.

   Order of calls in a step: ReducedBegin, products with A by a Krylov solver, ReducedUpdate.
   Ranks have the rows of their own markers; forces are gathered where MarkersRespond and the near field say so. */
#pragma once
#include "problem/unknowns.h"
#include "fluid/stokes/stokes.h"

/* A problem: its right-hand sides, and the vectors that the solution goes to. */
typedef struct {
  Forcing *f;             /* right-hand side of the momentum equation; the solution's forces are added to it */
  Vec g, k;               /* right-hand sides of the rows Dm V/h^2 (edge vector) and V (all bodies' markers) */
  Vec F;                  /* minus the known part of the force on all bodies' markers; f has it, k has not its near
                             field; NULL: none */
  Vec moved;              /* the known part of the markers' motion; NULL without viscosity contrast */
  const StreamPast *past; /* the states before, whose force is beside f, with inertia where w is NULL; else NULL */
  Vec w, p;               /* velocity and pressure; may both be NULL where ReducedNeedsNoPressure */
  PetscBool graded;       /* the step is a part of a graded start */
  Vec sigma, V, solid;    /* tension, V and force on obstacles (NULL without): first guess and solution */
} CoupledProblem;

typedef struct _p_Reduced *Reduced;
struct _p_Reduced {
  Unknowns unknowns;             /* borrowed */
  Stokes stokes;                 /* NULL in unbounded fluid */
  Stream stream;                 /* borrowed; NULL in unbounded fluid */
  Mat A;                         /* the residuals' derivative, scaled */
  const CoupledProblem *problem; /* the problem under way, borrowed */
  StreamMeasures measures;       /* measures of the velocity at the last residual, where problem.w is NULL */
  Vec F, U;                      /* work, all bodies' markers: forces, and E u of the solved velocity */
  Vec all;                       /* work: forces with the known forces */
  Vec sum;                       /* E u of the solution so far, in fluid with inertia */
  Vec motion;                    /* work, marker vector: the motion that makes the jump; NULL without contrast */
  DipoleRows dipoles;            /* dipoles of the jump in rows of the stream */
};

/* ReducedCreate - the problem for these unknowns. Collective. */
PETSC_EXTERN PetscErrorCode ReducedCreate(Unknowns unknowns, Reduced *reduced);
PETSC_EXTERN PetscErrorCode ReducedDestroy(Reduced *reduced);

/* ReducedBegin - begin a problem, borrowed until the next one, with the guess x, whose forces are added to problem->f.
   residual becomes minus the scaled residuals at x. ReducedUpdate - after x has changed by `added`: add the forces of
   `added` to problem->f and make w and p by one Stokes solve; residual becomes that at the new x. Collective. */
PETSC_EXTERN PetscErrorCode ReducedBegin(Reduced reduced, const CoupledProblem *problem, Vec x, Vec residual);
PETSC_EXTERN PetscErrorCode ReducedUpdate(Reduced reduced, Vec added, Vec x, Vec residual);

/* ReducedNeedsNoPressure - whether a problem can be solved without u and p on the grid. Not collective. ReducedFields -
   u and p of the forcing f that a problem has left, in fluid without inertia. ReducedPressure - p of the forcing f and
   its velocity w, in fluid with inertia. Collective. */
PETSC_EXTERN PetscBool ReducedNeedsNoPressure(Reduced reduced);
PETSC_EXTERN PetscErrorCode ReducedFields(Reduced reduced, const Forcing *f, Vec w, Vec p);
PETSC_EXTERN PetscErrorCode ReducedPressure(Reduced reduced, const Forcing *f, Vec w, Vec p);
