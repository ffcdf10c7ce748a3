/* Fluid and bodies joined: the mobility of the markers of a step, the membranes' forces, and the operators S and B of
   the momentum equation. CouplingPlace comes first in every step; all else is at the markers placed. Ranks know all
   markers and own the rows of their own bodies. */
#pragma once
#include "bodies/forcelist.h"
#include "bodies/law.h"
#include "mobility/mobility.h"

typedef struct _p_Coupling *Coupling;
struct _p_Coupling {
  Fluid fluid;         /* borrowed */
  Membrane membrane;   /* borrowed; of no vesicle when the scene has none */
  Bodies bodies;       /* vesicles and obstacles */
  Mobility mobility;   /* of the markers of all bodies */
  Markers markers;     /* those of the mobility, borrowed */
  Forces forces;       /* on the membranes */
  MembraneLaw law;     /* of the own vesicles */
  PetscReal *treading; /* [vesicles] speed of the labels in which the step is made (1/time) */
  Vec X;               /* markers of all bodies */
  Vec force;           /* marker vector of all bodies, work */
  Vec velocity;        /* marker vector of all bodies, work */
  Mat S;               /* (velocity x tension) S = E^T Dm^T/h^2: minus the spread tension force */
  Mat B;               /* (velocity x marker vector) B = E^T (c_b ds/h^2) D4: minus the spread bending force */
};

/* The settings of a coupling. A part whose setting is zero is not made. */
typedef struct {
  MobilitySetting mobility;
  PetscBool area_target; /* steps aim at the vesicles' initial areas */
  Scene scene;           /* gravity and repulsion; NULL: neither */
} CouplingSetting;

/* CouplingCreate - a coupling of a fluid, membranes and obstacles (NULL: none), not placed yet. Collective. */
PETSC_EXTERN PetscErrorCode CouplingCreate(Fluid fluid, Membrane membrane, Obstacles obstacles,
                                           const CouplingSetting *setting, Coupling *coupling);
PETSC_EXTERN PetscErrorCode CouplingDestroy(Coupling *coupling);

/* CouplingPlace - place everything that a solve stands on: the time coefficient a0 (1/time) in the fluid's H; E, S, B,
   tangents, near field and forces at the markers X and at the obstacles of an instant; the labels' speeds
   treading[vesicles] (1/time; NULL: at rest). message[PETVES_MAX_MESSAGE] is empty, or says which marker is too near to
   a wall; it is the same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode CouplingPlace(Coupling coupling, PetscReal a0, Instant at, Vec X,
                                          const PetscReal treading[], char message[PETVES_MAX_MESSAGE]);

/* CouplingCopyVesicles - copy the vesicles' part of `from` to that of `to`; each is a marker vector of the vesicles or
   of all bodies. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingCopyVesicles(Coupling coupling, Vec from, Vec to);

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

/* CouplingSpreadTension - w += alpha S sigma. CouplingSpreadBending - w += alpha B X. Collective. */
PETSC_EXTERN PetscErrorCode CouplingSpreadTension(Coupling coupling, PetscReal alpha, Vec sigma, Vec w);
PETSC_EXTERN PetscErrorCode CouplingSpreadBending(Coupling coupling, PetscReal alpha, Vec X, Vec w);

/* CouplingMarkers - the markers of all bodies: the vesicles' Y, and the obstacles', free ones at a place. Not
   collective. CouplingStepForce - F = K Y + k + Dm^T sigma, minus the forces at such markers Y, linearised at the
   markers X placed (bodies/force.h), and the law's of sigma (NULL: without); F is zero behind the vesicles' part. Minus
   the force of contact on free bodies is added to push[3 own free] (NULL: not wanted). Collective. */
PETSC_EXTERN PetscErrorCode CouplingMarkers(Coupling coupling, Vec Y, Vec place, Vec all);
PETSC_EXTERN PetscErrorCode CouplingStepForce(Coupling coupling, Vec Y, Vec X, Vec sigma, Vec F, PetscReal push[]);

/* CouplingTread - U += alpha V dX/dt, the velocity of markers by the labels' own motion. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingTread(Coupling coupling, PetscReal alpha, Vec X, Vec U);

/* CouplingSeep - U += alpha times the velocity of the vesicles' markers X relative to the fluid, F minus the forces
   (NULL: of osmotic pressures alone). Not collective. */
PETSC_EXTERN PetscErrorCode CouplingSeep(Coupling coupling, PetscReal alpha, Vec X, Vec F, Vec U);

/* CouplingStretching - d = Dm U/h^2. d and U are an edge vector and a marker vector. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingStretching(Coupling coupling, Vec U, Vec d);

/* CouplingForces - F = all forces times ds of membranes at an instant at X with tension sigma, as marker vectors of the
   membranes. Collective. */
PETSC_EXTERN PetscErrorCode CouplingForces(Coupling coupling, Instant at, Vec sigma, Vec X, Vec F);
