/* The coupled problem of one time step, for velocity, pressure and tension together (docs/solver.md),
       H u + G p + E^T F/h^2 = f,   G^T u = 0,   F = Dm^T sigma + (1/a0) (c_b ds D4 + K_rep) V,
       V + (v/a0) dV/dt = E u - C F + k,           Dm V/h^2 = g,           0 = E_w u - C F - beta N N^T F + k_w,
   V the markers' velocity without the background's, seen from labels t that turn at the speed v of their vesicle, C the
   near field, the last for the markers of obstacles (obstacles.h), whose F is an unknown and which C knows as well,
   K_rep the springs of a repulsion if there is one, k what C gives of the forces that are known, reduced to its forces.
   A Stokes solve gives u and p for any force, so the unknowns are V, F of obstacles and sigma:
   (u, p) = Stokes(f - E^T F/h^2),   V + (v/a0) dV/dt - E u + C F = k,   Dm V/h^2 = g.
   A product costs one Stokes solve for the velocity at the markers only (fluid/stream.h); u and p follow from the
   solution's forces.
   In unbounded fluid there is no u on a grid (E = 0) and C is all of the mobility: a product is dense work on markers,
   and u and p stay zero. */
#pragma once
#include "coupling/unknowns.h"
#include "fluid/stokes.h"

/* What a step gives, and the vectors that its answer goes to. */
typedef struct {
  Forcing *f;             /* right-hand side of momentum, to which the forces of the solution are added, */
  Vec g, k;               /* of Dm V/h^2, an edge vector, and of V, of all bodies; */
  Vec F;                  /* minus what is known of the force on all bodies' markers, which is in f, but its near field
                             not in k; NULL: none */
  Vec moved;              /* with viscosity contrast: the part of the markers' motion that is known; else NULL */
  const StreamPast *past; /* with inertia where w is NULL: the states before, whose force is beside f; else NULL */
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
  const CoupledProblem *problem; /* borrowed: the one under way */
  StreamMeasures measures;       /* of the velocity at the last residual, where problem.w is NULL */
  Vec F, U;                      /* marker vectors of all bodies, work: forces, what the markers have of u = E u */
  Vec all;                       /* work: forces with those that are known */
  Vec sum;                       /* with states before: U of the solution so far */
  Vec motion;                    /* with a viscosity contrast: what the jump is of, marker vector, work; else NULL */
  DipoleRows dipoles;            /* of the jump, with stream */
};

/* ReducedCreate - the problem for these unknowns. Collective. */
PETSC_EXTERN PetscErrorCode ReducedCreate(Unknowns unknowns, Reduced *reduced);
PETSC_EXTERN PetscErrorCode ReducedDestroy(Reduced *reduced);

/* ReducedBegin - a problem, borrowed until the next one, begins with the guess x: its forces go into problem->f.
   residual: minus the scaled residuals at x. ReducedUpdate - the forces of `added`, by which x has changed, go into
   problem->f as well, and w and p are made by one Stokes solve; residual: at the new x. Collective. */
PETSC_EXTERN PetscErrorCode ReducedBegin(Reduced reduced, const CoupledProblem *problem, Vec x, Vec residual);
PETSC_EXTERN PetscErrorCode ReducedUpdate(Reduced reduced, Vec added, Vec x, Vec residual);

/* ReducedNeedsNoPressure - whether a problem can be solved without u and p on the grid: disturbances by fluid/stream.h,
   with a flow in fluid with inertia. ReducedFields - then, without a flow, they are the Stokes solve's for f as
   the last problem left it. ReducedPressure - with a flow p follows from f and its velocity w. Not collective;
   collective. */
PETSC_EXTERN PetscBool ReducedNeedsNoPressure(Reduced reduced);
PETSC_EXTERN PetscErrorCode ReducedFields(Reduced reduced, const Forcing *f, Vec w, Vec p);
PETSC_EXTERN PetscErrorCode ReducedPressure(Reduced reduced, const Forcing *f, Vec w, Vec p);

/* ReducedDefersDipoles - whether the markers' rows are without the dipoles, so that ReducedFinish has something to do.
   Not collective. ReducedFinish - problem->f gets the forces of `added`, what the last residual lacks of the solution
   x, and the dipoles of x, and measures is of its velocity; else nothing. Collective. */
PETSC_EXTERN PetscBool ReducedDefersDipoles(Reduced reduced);
PETSC_EXTERN PetscErrorCode ReducedFinish(Reduced reduced, Vec added, Vec x);
