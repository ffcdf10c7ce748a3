/* The coupled problem of one time step, for velocity, pressure and tension together (docs/solver.md),
       H u + G p + E^T F/h^2 = f,   G^T u = -bc2,   F = Dm^T sigma + (1/a0) (c_b ds D4 + K_rep) V,
       V + (v/a0) dV/dt = E u - C F + k,           Dm V/h^2 = g,           0 = E_w u - C F - beta N N^T F + k_w,
   V the markers' velocity without the background's, seen from labels t that turn at the speed v of their vesicle, C the
   near field, the last for the markers of obstacles (obstacles.h), whose F is an unknown and which C knows as well,
   K_rep the springs of a repulsion if there is one, k what C gives of the forces that are known, reduced to its forces.
   A Stokes solve gives u and p for any force, so the unknowns are V, F of obstacles, sigma, and forces d on the faces
   next to walls, where the Stokes solve is not exact: (u, p) = Stokes(f - E^T F/h^2 + d, -bc2), V + (v/a0) dV/dt - E u
   + C F = k,    Dm V/h^2 = g,    d + (what the Stokes solve leaves at the walls) = 0. A product costs one Stokes solve;
   where fluid/stream.h gives it one for the velocity at the markers only, u and p follow from the solution's
   forces.
   In unbounded fluid there is no u on a grid (E = 0) and C is all of the mobility: a product is dense work on markers,
   and u and p stay zero. */
#pragma once
#include "coupling/products.h"
#include "coupling/unknowns.h"
#include "fluid/stokes.h"

typedef struct _p_Reduced *Reduced;
struct _p_Reduced {
  Unknowns unknowns; /* borrowed */
  Stokes stokes;     /* NULL in unbounded fluid */
  Stream stream;     /* borrowed; NULL where products are made on the grid, and kept */
  Mat A;             /* the residuals' derivative, scaled */
  Products kept;
  Forcing r;               /* of a product; not made with stream */
  Vec F, U;                /* marker vectors of all bodies, work: forces, what the markers have of u = E u */
  Vec all, known;          /* work: forces with those that are known (borrowed) */
  Vec flow;                /* borrowed: of u, where the problem makes one; else NULL */
  StreamPast past;         /* then: the states before, */
  Vec sum;                 /* and U of all so far, */
  StreamMeasures measures; /* and what was measured */
  Vec motion;              /* with a viscosity contrast: what the jump is of, marker vector, work */
  Vec moved;               /* borrowed: of the motion what is known */
  DipoleRows dipoles;      /* of the jump, with stream */
  Vec rest;                /* unknowns, work */
  PetscScalar *d;          /* [walls->n] all wall forces, work */
  PetscScalar *slip;       /* [walls->n] work */
};

/* ReducedCreate - the problem for these unknowns. Collective. */
PETSC_EXTERN PetscErrorCode ReducedCreate(Unknowns unknowns, Reduced *reduced);
PETSC_EXTERN PetscErrorCode ReducedDestroy(Reduced *reduced);

/* ReducedBegin - a problem begins, in which `known`, minus a part of the force on the bodies' markers, is in f but its
   near field is not in k, and the part `moved` of the markers' motion is known (NULL without viscosity contrast). flow:
   u is kept as that (fluid/streamflow.h), and the force of the states before, `past`, is beside f; else NULL. Not
   collective. */
PETSC_EXTERN void ReducedBegin(Reduced reduced, Vec known, Vec moved, const StreamPast *past, Vec flow);

/* ReducedResidual - the forces of `added` go into f, those of x itself with the dipoles of `moved`; minus the scaled
   residuals at x, with u, p = w, p by one Stokes solve of f, f holding the forces of x. grid false: w and p are not
   wanted and may stay as they are. Both may be NULL where ReducedNeedsNoPressure, and measures is then of u unless it
   is NULL. With a flow it is added to, and the first residual of a problem must be that of added = x. g: an edge
   vector, k: a marker vector of all bodies. Collective. */
PETSC_EXTERN PetscErrorCode ReducedResidual(Reduced reduced, Vec added, Forcing *f, Vec g, Vec k, Vec x, PetscBool grid,
                                            Vec w, Vec p, Vec residual, StreamMeasures *measures);

/* ReducedNeedsNoPressure - whether a problem can be solved without u and p on the grid: disturbances by fluid/stream.h,
   with a flow in fluid with inertia. ReducedFields - then, without a flow, they are the Stokes solve's for f as
   ReducedResidual left it. ReducedPressure - with a flow p follows from f and its velocity w. Not collective;
   collective. */
PETSC_EXTERN PetscBool ReducedNeedsNoPressure(Reduced reduced);
PETSC_EXTERN PetscErrorCode ReducedFields(Reduced reduced, const Forcing *f, Vec w, Vec p);
PETSC_EXTERN PetscErrorCode ReducedPressure(Reduced reduced, const Forcing *f, Vec w, Vec p);

/* ReducedFinish - f gets the forces of `added` (NULL: none) and the dipoles of the solution x where the markers' rows
   are without them; measures is of its velocity; else nothing. Collective.
   ReducedIsFinished - whether it does. Not collective. */
PETSC_EXTERN PetscErrorCode ReducedFinish(Reduced reduced, Vec added, Forcing *f, Vec x, StreamMeasures *measures);
PETSC_EXTERN PetscBool ReducedIsFinished(Reduced reduced);

/* ReducedForgetProducts - a solve begins: products with A are kept from here on. Not collective. */
PETSC_EXTERN PetscErrorCode ReducedForgetProducts(Reduced reduced);

/* ReducedCombine - the change of w, p and the residual that goes with a change of x made of the kept products, added; x
   := what it is made of. combined is false when they were not kept, or too many, and nothing has changed. Collective.
 */
PETSC_EXTERN PetscErrorCode ReducedCombine(Reduced reduced, Vec x, Vec w, Vec p, Vec residual, PetscBool *combined);
