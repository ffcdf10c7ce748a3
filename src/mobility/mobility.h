/* The mobility: the velocity U that forces and moving membranes give the markers of all bodies (docs/solver.md,
   docs/nearfield.md, docs/contrast.md),

       U = E u - C F + C_D J,      H u + G p = f - E^T F/h^2 + dipoles of J,      G^T u = source of J,

   with F minus the force times ds on the markers, E the interpolation from the grid, C the near field, and
   J = (1 - ratio) G the jump at membranes where the fluid moves with G and the viscosity inside is not that outside;
   C_D is the near field of the double layer of J. In unbounded fluid u = 0, and C and C_D are the whole of it.

   MobilityPlace is the only act that changes the operator. MobilityApply is linear. The velocity of a step is built by
   MobilityBegin, for what is known of the step, and MobilityAdd, for each F and G that a solver finds; what is known
   and what has been added before is in the velocity that MobilityAdd gives. Fields on the grid are made by
   MobilityFields and MobilityPressure alone. Ranks have the rows of their own markers; functions gather the F and G of
   all. */
#pragma once
#include "bodies/bodies.h"
#include "bodies/innerfluid.h"
#include "fluid/stokes/stokes.h"
#include "mobility/doublelayer.h"
#include "mobility/nearfield.h"

/* What is known of a step's velocity; all of it is borrowed until the next MobilityBegin. */
typedef struct {
  Forcing *f;        /* what acts on the fluid besides the bodies; all forces of the step are added to it */
  Vec F;             /* minus the known forces on the markers of all bodies; NULL: none */
  PetscBool outside; /* F has forces from outside, such as gravity: a box periodic both ways takes their mean off */
  Vec G;             /* the known part of the vesicles' motion; NULL: none */
  const StreamPast *past; /* in fluid with inertia: the states before, and where the flow of the step goes; else NULL */
} MobilityKnown;

typedef struct _p_Mobility *Mobility;
struct _p_Mobility {
  Fluid fluid;   /* borrowed */
  Bodies bodies; /* borrowed */
  Markers markers;
  NearField near;             /* NULL without */
  DoubleLayer contrast;       /* NULL where all viscosities are alike */
  PetscReal lag;              /* lag of the markers behind the grid's velocity (time); 0 without */
  Stokes stokes;              /* NULL in unbounded fluid, and unless the setting asks for a solver */
  Stream stream;              /* that of stokes, borrowed */
  DipoleRows dipoles;         /* work: dipoles of the jump in rows of the stream */
  const MobilityKnown *known; /* of the step under way */
  PetscInt added;             /* calls of MobilityAdd in the step under way */
  Vec F, G;                   /* all forces and the whole motion of the step so far */
  Vec flow;                   /* E u of the step so far, in fluid with inertia */
  StreamMeasures measures;    /* measures of u of the step so far */
  InnerFluid inner;           /* of free bodies in fluid with inertia; else NULL */
  Vec sum, field;             /* work: a flow and its velocity on the grid; NULL without inner fluid */
};

/* The settings of a mobility. A part whose setting is zero is not made. */
typedef struct {
  const char *kernel; /* name of the regularised delta function */
  NearFieldType near;
  const FluidSpec *spec;  /* specification of the fluid, for box parts; borrowed */
  PetscBool box_part;     /* near field and double layer have a box part */
  PetscBool lag;          /* in unsteady flow, markers move with the grid's velocity less the lag times its
                             rate of change (docs/nearfield.md, Unsteady flow) */
  const PetscReal *ratio; /* [vesicles] viscosity inside over outside; needs the near field */
  PetscBool solver;       /* MobilityApply and the functions below it are called */
} MobilitySetting;

/* MobilityCreate - the mobility of bodies in a fluid, not placed yet. Collective. */
PETSC_EXTERN PetscErrorCode MobilityCreate(Fluid fluid, Bodies bodies, const MobilitySetting *setting,
                                           Mobility *mobility);
PETSC_EXTERN PetscErrorCode MobilityDestroy(Mobility *mobility);

/* MobilityPlace - the mobility of markers at X, a marker vector of all bodies, in a step with the time coefficient a0
   (1/time). Collective. */
PETSC_EXTERN PetscErrorCode MobilityPlace(Mobility mobility, PetscReal a0, Vec X);

/* F and U are marker vectors of all bodies, F a force times ds over the density (length^3/time^2) and U a velocity. G
   is a velocity of the vesicles' markers alone, and is not looked at without viscosity contrast.

   MobilityApply - U = E u - C F + C_D J of F and G alone. MobilityBegin - begin a step: what is known goes into its
   forcing. MobilityAdd - add F and G to the step under way; U becomes the velocity that all of the step gives, and
   `measures` those of u. MobilityAddLayers - U[own numbers] += - C F + C_D J alone; F may be NULL. Collective. */
PETSC_EXTERN PetscErrorCode MobilityApply(Mobility mobility, Vec F, Vec G, Vec U);
PETSC_EXTERN PetscErrorCode MobilityBegin(Mobility mobility, const MobilityKnown *known);
PETSC_EXTERN PetscErrorCode MobilityAdd(Mobility mobility, Vec F, Vec G, Vec U);
PETSC_EXTERN PetscErrorCode MobilityAddLayers(Mobility mobility, Vec F, Vec G, PetscScalar U[]);

/* MobilityFields - u and p of the forcing f of a step, in fluid without inertia. MobilityPressure - p of the forcing f
   of a step and of its velocity u, in fluid with inertia. Nothing in unbounded fluid. Collective. */
PETSC_EXTERN PetscErrorCode MobilityFields(Mobility mobility, const Forcing *f, Vec u, Vec p);
PETSC_EXTERN PetscErrorCode MobilityPressure(Mobility mobility, const Forcing *f, Vec u, Vec p);

/* MobilityWeight - (1 + ratio)/2 of a vesicle: the factor of its own velocity, 1 without contrast. MobilityLag - the
   lag (time) in a step with the time coefficient alpha, at most MOBILITY_MOST_LAG/alpha. MobilityGridPart - the part of
   a step's new velocity E u that markers have: 1 - MobilityLag alpha. The near field makes up for a negative part down
   to -1/4; below that stiff membranes would be unstable. Not collective. */
static inline PetscReal MobilityWeight(Mobility mobility, PetscInt vesicle) {
  return mobility->contrast ? 0.5 * (1 + mobility->contrast->ratio[vesicle]) : 1;
}
#define MOBILITY_MOST_LAG 1.25
static inline PetscReal MobilityLag(Mobility mobility, PetscReal alpha) {
  return PetscMin(mobility->lag, MOBILITY_MOST_LAG / alpha);
}
static inline PetscReal MobilityGridPart(Mobility mobility, PetscReal alpha) {
  return 1 - MobilityLag(mobility, alpha) * alpha;
}
