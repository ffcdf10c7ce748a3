/* Fluid and bodies joined: the markers of a step on the grid, the near field that gives back the kernel's smoothing,
   the membranes' forces, and the operators S and B of the momentum equation. CouplingPlace comes first in every step;
   all else is at the markers placed. Ranks know all markers and own the rows of their own bodies. */
#pragma once
#include "bodies/arearow.h"
#include "mobility/doublelayer.h"
#include "mobility/nearfield.h"
#include "bodies/forcelist.h"
#include "fluid/stokes/fluid.h"

typedef struct _p_Coupling *Coupling;
struct _p_Coupling {
  Fluid fluid;          /* borrowed */
  Membrane membrane;    /* borrowed; of no vesicle when the scene has none */
  Bodies bodies;        /* vesicles and obstacles */
  Markers markers;      /* of all bodies */
  NearField near;       /* NULL without */
  DoubleLayer contrast; /* NULL where all viscosities are alike (contrast.h) */
  Forces forces;        /* on the membranes */
  AreaRow area;         /* NULL without area target */
  PetscReal *tau;       /* [2n] tangents of the own vesicles */
  PetscReal *treading;  /* [vesicles] speed of the labels in which the step is made (1/time) */
  PetscReal lag;        /* lag of the markers behind the grid's velocity (time); 0 without */
  Vec X;                /* markers of all bodies */
  Vec force;            /* marker vector of all bodies, work */
  Vec velocity;         /* marker vector of all bodies, work */
  Mat S;                /* (velocity x tension) S = E^T Dm^T/h^2: minus the spread tension force */
  Mat B;                /* (velocity x marker vector) B = E^T (c_b ds/h^2) D4: minus the spread bending force */
};

/* The settings of a coupling. A part whose setting is zero is not made. */
typedef struct {
  const char *kernel; /* name of the regularised delta function */
  NearFieldType near;
  const FluidSpec *spec;  /* specification of the fluid, for box parts; borrowed */
  PetscBool box_part;     /* near field and double layer have a box part */
  PetscBool lag;          /* in unsteady flow, markers move with the grid's velocity less the lag times its
                             rate of change (docs/nearfield.md, Unsteady flow) */
  PetscBool area_target;  /* steps aim at the vesicles' initial areas */
  const PetscReal *ratio; /* [vesicles] viscosity inside over outside; needs the near field */
  Scene scene;            /* gravity and repulsion; NULL: neither */
} CouplingSetting;

/* CouplingCreate - a coupling of a fluid, membranes and obstacles (NULL: none), not placed yet. Collective. */
PETSC_EXTERN PetscErrorCode CouplingCreate(Fluid fluid, Membrane membrane, Obstacles obstacles,
                                           const CouplingSetting *setting, Coupling *coupling);
PETSC_EXTERN PetscErrorCode CouplingDestroy(Coupling *coupling);

/* CouplingAddPast - U += lag E uhat, a marker vector of all bodies, for the history uhat in du/dt = alpha u - uhat.
   Collective. */
PETSC_EXTERN PetscErrorCode CouplingAddPast(Coupling coupling, Vec uhat, Vec U);

/* CouplingPlace - place everything that a solve stands on: the time coefficient a0 (1/time) in the fluid's H; E, S, B,
   tangents, near field and forces at the markers X and at the obstacles of time t; the labels' speeds
   treading[vesicles] (1/time; NULL: at rest). message[PETVES_MAX_MESSAGE] is empty, or says which marker is too near to
   a wall; it is the same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode CouplingPlace(Coupling coupling, PetscReal a0, PetscReal t, Vec X,
                                          const PetscReal treading[], char message[PETVES_MAX_MESSAGE]);

/* CouplingPlaceMarkers - place the markers alone, for E at the vesicles' X. CouplingInterpolate - U = E w of the
   vesicles. Collective. */
PETSC_EXTERN PetscErrorCode CouplingPlaceMarkers(Coupling coupling, Vec X);
PETSC_EXTERN PetscErrorCode CouplingInterpolate(Coupling coupling, Vec w, Vec U);

/* CouplingHasMembrane - whether there is a vesicle. CouplingHasBodies - whether there is a vesicle or an obstacle.
   CouplingBending - c_b; 0 without a vesicle. Not collective. */
static inline PetscBool CouplingHasMembrane(Coupling coupling) {
  return coupling->membrane->layout->bodies > 0 ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscBool CouplingHasBodies(Coupling coupling) {
  return coupling->bodies->layout->bodies > 0 ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscReal CouplingBending(Coupling coupling) {
  return CouplingHasMembrane(coupling) ? coupling->membrane->bending : 0;
}

/* CouplingLag - the lag (time) in a step with the time coefficient alpha, at most COUPLING_MOST_LAG/alpha. Not
   collective. */
#define COUPLING_MOST_LAG 1.25
static inline PetscReal CouplingLag(Coupling coupling, PetscReal alpha) {
  return PetscMin(coupling->lag, COUPLING_MOST_LAG / alpha);
}

/* CouplingGridPart - the part of a step's new velocity E u that markers have: 1 - CouplingLag alpha. The near field
   makes up for a negative part down to -1/4; below that stiff membranes would be unstable. Not collective. */
static inline PetscReal CouplingGridPart(Coupling coupling, PetscReal alpha) {
  return 1 - CouplingLag(coupling, alpha) * alpha;
}

/* CouplingSpreadTension - w += alpha S sigma. CouplingSpreadBending - w += alpha B X. Collective. */
PETSC_EXTERN PetscErrorCode CouplingSpreadTension(Coupling coupling, PetscReal alpha, Vec sigma, Vec w);
PETSC_EXTERN PetscErrorCode CouplingSpreadBending(Coupling coupling, PetscReal alpha, Vec X, Vec w);

/* CouplingKnownForce - F = K Y + k, minus all forces but the tension's at the markers Y, linearised at the markers X
   placed (bodies/force.h); F is zero behind the vesicles' part. CouplingSpreadForce - f -= E^T F/h^2, less the mean of
   forces from outside in a box that is periodic both ways. CouplingNearField - u += alpha C F for the own velocities
   u[2n] of all bodies; nothing without near field or with F NULL. Collective. */
PETSC_EXTERN PetscErrorCode CouplingKnownForce(Coupling coupling, Vec Y, Vec X, Vec F);
PETSC_EXTERN PetscErrorCode CouplingSpreadForce(Coupling coupling, Vec F, Forcing *f);
PETSC_EXTERN PetscErrorCode CouplingNearField(Coupling coupling, PetscReal alpha, Vec F, PetscScalar u[]);

/* CouplingTread - U += alpha V dX/dt, the velocity of markers by the labels' own motion. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingTread(Coupling coupling, PetscReal alpha, Vec X, Vec U);

/* CouplingStretching - d = Dm U/h^2. d and U are an edge vector and a marker vector. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingStretching(Coupling coupling, Vec U, Vec d);

/* CouplingForces - F = all forces times ds of membranes at time t at X with tension sigma, as marker vectors of the
   membranes. Collective. */
PETSC_EXTERN PetscErrorCode CouplingForces(Coupling coupling, PetscReal t, Vec sigma, Vec X, Vec F);
