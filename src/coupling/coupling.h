/* Fluid and membranes joined: where the membranes are in a step, their tangents, what gives back the kernel's
   smoothing, and the operators S and B of the momentum equation. */
#pragma once
#include "coupling/arearow.h"
#include "coupling/doublelayer.h"
#include "coupling/layer.h"
#include "coupling/nearfield.h"
#include "coupling/repulsion.h"
#include "fluid/fluid.h"

typedef struct _p_Coupling *Coupling;
struct _p_Coupling {
  Fluid fluid;          /* borrowed */
  Membrane membrane;    /* borrowed; of no vesicle when the scene has none */
  Bodies bodies;        /* vesicles and obstacles */
  Markers markers;      /* of all bodies */
  NearField near;       /* NULL without */
  DoubleLayer contrast; /* NULL where all viscosities are alike (contrast.h) */
  Repulsion repulsion;  /* NULL without */
  AreaRow area;         /* NULL without area target */
  PetscReal *tau;       /* [2n] tangents of the own vesicles */
  PetscReal *turning;   /* [n] the tension whose pull turns with the edges (length^3/time^2); CouplingTurn */
  PetscReal *treading;  /* [vesicles] V, the speed of the labels in which the step is made (1/time) */
  PetscReal lag;        /* of the grid's inertia at the markers (time); 0 without */
  Vec X;                /* markers of all bodies */
  Vec force;            /* marker vector of all bodies, work */
  Vec velocity;         /* the same, work */
  Mat S;                /* (velocity x tension) S = E^T Dm^T/h^2: minus the spread tension force */
  Mat B;                /* (velocity x marker vector) B = E^T (c_b ds/h^2) D4: minus the spread bending force */
};

/* What a coupling has besides fluid and bodies; nothing that is zero. */
typedef struct {
  const char *kernel; /* its name */
  NearFieldType near;
  const FluidSpec *spec;           /* the fluid's, for box parts; borrowed */
  PetscBool box_part;              /* the near field and the double layer have it */
  PetscBool apart;                 /* a double layer may take all that walls and images add from its box part */
  PetscBool lag;                   /* in unsteady flow markers have the velocity of the grid less the lag times its rate
                                      of change: what kernel and lattice take from the fluid's inertia, where the near
                                      field is that of quasi-steady flow (docs/nearfield.md, Unsteady flow) */
  PetscBool area_target;           /* steps aim at the vesicles' first areas */
  const PetscReal *ratio;          /* [vesicles] viscosity inside over outside, which needs the near field */
  const SceneRepulsion *repulsion; /* a force of short range between membranes */
} CouplingSetting;

/* CouplingCreate - of a fluid, membranes and obstacles (NULL: none); not placed yet. Collective. */
PETSC_EXTERN PetscErrorCode CouplingCreate(Fluid fluid, Membrane membrane, Obstacles obstacles,
                                           const CouplingSetting *setting, Coupling *coupling);
PETSC_EXTERN PetscErrorCode CouplingDestroy(Coupling *coupling);

/* CouplingAddPast - U += lag E uhat, marker vector of all bodies, of the history uhat in du/dt = alpha u - uhat.
   Collective. */
PETSC_EXTERN PetscErrorCode CouplingAddPast(Coupling coupling, Vec uhat, Vec U);

/* CouplingPlace - everything that a solve stands on, in one call: the time coefficient a0 (1/time) in the fluid's H; E,
   S, B, the tangents, the near field C and the springs of a repulsion at the markers X, and at obstacles where they are
   at time t; the labels' speeds treading[vesicles] (1/time; NULL: at rest). message[PETVES_MAX_MESSAGE] is empty, or
   says why it cannot be: a marker near a wall; the same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode CouplingPlace(Coupling coupling, PetscReal a0, PetscReal t, Vec X,
                                          const PetscReal treading[], char message[PETVES_MAX_MESSAGE]);

/* CouplingTurn - from here on, until the next CouplingPlace, a tension expected (edge vector) pulls along the new edges
   where it is positive, as much of it as waves of the membrane would otherwise swing by (docs/membrane.md), and only
   the rest along those of the markers placed: K_sigma X - Dm^T sigma joins the elastic forces, K_sigma = MembranePull.
   Not collective. */
PETSC_EXTERN PetscErrorCode CouplingTurn(Coupling coupling, Vec expected);

/* CouplingPlaceMarkers - the markers only, E at the vesicles' X. CouplingInterpolate - U = E w of the vesicles.
   Collective. */
PETSC_EXTERN PetscErrorCode CouplingPlaceMarkers(Coupling coupling, Vec X);
PETSC_EXTERN PetscErrorCode CouplingInterpolate(Coupling coupling, Vec w, Vec U);

/* CouplingHasMembrane - whether there is a vesicle. CouplingHasBodies - or an obstacle. CouplingBending - c_b, 0
 * without a vesicle. Not collective. */
static inline PetscBool CouplingHasMembrane(Coupling coupling) {
  return coupling->membrane->layout->bodies > 0 ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscBool CouplingHasBodies(Coupling coupling) {
  return coupling->bodies->layout->bodies > 0 ? PETSC_TRUE : PETSC_FALSE;
}
static inline PetscReal CouplingBending(Coupling coupling) {
  return CouplingHasMembrane(coupling) ? coupling->membrane->bending : 0;
}

/* CouplingLag - the lag in a step with the time coefficient alpha (time): at most COUPLING_MOST_LAG/alpha. Not
   collective. */
#define COUPLING_MOST_LAG 1.25
static inline PetscReal CouplingLag(Coupling coupling, PetscReal alpha) {
  return PetscMin(coupling->lag, COUPLING_MOST_LAG / alpha);
}

/* CouplingGridPart - what of a step's new velocity E u the markers have: 1 - CouplingLag alpha. Down to -1/4 C makes
   up for it; below, stiff membranes would be driven by what should slow them. Not collective. */
static inline PetscReal CouplingGridPart(Coupling coupling, PetscReal alpha) {
  return 1 - CouplingLag(coupling, alpha) * alpha;
}

/* CouplingSpreadTension - w += alpha S sigma. CouplingSpreadBending - w += alpha B X. Collective. */
PETSC_EXTERN PetscErrorCode CouplingSpreadTension(Coupling coupling, PetscReal alpha, Vec sigma, Vec w);
PETSC_EXTERN PetscErrorCode CouplingSpreadBending(Coupling coupling, PetscReal alpha, Vec X, Vec w);

/* CouplingElasticForce - F = (c_b ds D4 + K_sigma + K_rep) X less the springs' push and the pull of the turning tension
   along the old edges: minus the force of bending, turning and repulsion at the markers X (length^3/time^2).
   Collective. */
PETSC_EXTERN PetscErrorCode CouplingElasticForce(Coupling coupling, Vec X, Vec F);

/* CouplingElasticRate - F += alpha (c_b ds D4 + K_sigma + K_rep) V, own parts V[2n], F[2n] of marker vectors.
 * Collective. */
PETSC_EXTERN PetscErrorCode CouplingElasticRate(Coupling coupling, PetscReal alpha, const PetscScalar V[],
                                                PetscScalar F[]);

/* CouplingKnownForce - F = the elastic force of Y less gravity's on the markers X, a marker vector of all bodies: minus
   what is known of the force on them. CouplingSpreadForce - f -= E^T F/h^2, less gravity's mean in a box that is
   periodic both ways. CouplingNearField - u[2n], the bodies' own velocities, += alpha C F with near field; F NULL: 0.
   Collective. */
PETSC_EXTERN PetscErrorCode CouplingKnownForce(Coupling coupling, Vec Y, Vec X, Vec F);
PETSC_EXTERN PetscErrorCode CouplingSpreadForce(Coupling coupling, Vec F, Forcing *f);
PETSC_EXTERN PetscErrorCode CouplingNearField(Coupling coupling, PetscReal alpha, Vec F, PetscScalar u[]);

/* CouplingTread - U += alpha V dX/dt, what the labels' own motion adds to the markers' velocity. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingTread(Coupling coupling, PetscReal alpha, Vec X, Vec U);

/* CouplingStretching - d = Dm U/h^2. d and U are an edge vector and a marker vector. Not collective. */
PETSC_EXTERN PetscErrorCode CouplingStretching(Coupling coupling, Vec U, Vec d);

/* CouplingLayer - the single layer of all forces of membranes at X with tension sigma in unbounded fluid. Collective.
 */
PETSC_EXTERN PetscErrorCode CouplingLayer(Coupling coupling, Vec sigma, Vec X, Layer *layer);
