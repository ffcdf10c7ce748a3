/* Time-stepping schemes: the state that they advance, and the interface behind which they stand. */
#pragma once
#include "coupling/lagrangian.h"
#include "coupling/saddle.h"
#include "coupling/selfmobility.h"

/* Everything that moves in time. Marker vectors are sequential and the same on every rank. */
typedef struct {
  PetscInt step;
  PetscReal t, dt;
  PetscReal dt_last; /* the step that led here; 0 at the start */
  Vec w;             /* velocity on the faces: the disturbance, or the whole in the total form */
  Vec p;             /* pressure, zero mean */
  Vec sigma;         /* tension, one an edge */
  Vec X;             /* markers */
  Vec U;             /* markers' velocity, background included */
  Vec walls;         /* scheme coupled's wall forces, the same on every rank; else NULL */
} State;

/* What the last step did. */
typedef struct {
  PetscInt tension_its, bending_its, coupled_its;
  PetscInt solves;                  /* scalar fast solves */
  PetscReal div_max;                /* max |G^T u + bc2|, what the solver left of the divergence */
  PetscReal surface_div_max;        /* max |h^2 (S^T u - g)/ds|, self-mobility included */
  PetscReal area_shift;             /* largest shift that restored a vesicle\'s area (length) */
  PetscReal cfl;                    /* dt max(|u| + |v|)/h; 0 without convection */
  PetscReal seconds;                /* wall, output excluded */
  char failure[PETVES_MAX_MESSAGE]; /* why the step could not be taken; empty when it was */
} StepReport;

/* All that a step changes and the next one needs; State and this are what a checkpoint holds. */
typedef struct {
  State state, old; /* old without vectors where the scheme has none */
  PetscBool has_old;
  PetscInt level;
  PetscBool fields; /* velocities and pressures too; without, the scheme's undo brings them back */
} Snapshot;

typedef struct _p_Scheme *Scheme;
struct _p_Scheme {
  char type[OPTION_MAX_NAME];
  Scene scene;       /* borrowed */
  Fluid fluid;       /* borrowed */
  Membrane membrane; /* borrowed; no vesicles when the scene has none */
  Coupling coupling; /* borrowed; NULL when the scene has no vesicle */
  State state;
  State *old;        /* the state one step before, for schemes that go on from two; else NULL */
  PetscBool has_old; /* whether there was a step before */
  PetscInt *level;   /* of step-size control's next step; NULL without */
  Snapshot before;   /* what SchemeStep goes back to when a step fails */
  PetscBool contact; /* whether parts of membranes are close, as last warned of */
  StepReport report;
  SelfMobility self; /* NULL without */
  Vec background;    /* [2M] what the markers' velocity has besides the solved part: u_inf, zero in the total form */
  Vec g;             /* [M] S^T u = g: minus the background's stretching, Dm u_inf/h^2 */
  Vec work_tension, work_markers;
  void *data; /* the scheme's own */
  PetscErrorCode (*setup)(Scheme);
  PetscErrorCode (*step)(Scheme); /* advance the state, or fill in report.failure and leave it */
  /* put back the velocities and pressures of state and old that a step with has_old has changed; NULL: they are copied
     before each step */
  PetscErrorCode (*undo)(Scheme);
  /* what solvers keep from step to step, as SchemeMemorySize numbers, and made again from them; NULL: they keep nothing
   */
  PetscErrorCode (*remember)(Scheme, PetscReal memory[]);
  PetscErrorCode (*recall)(Scheme, const PetscReal memory[]);
  PetscErrorCode (*view)(Scheme, PetscViewer);
  PetscErrorCode (*options)(Scheme, FILE *);                 /* write the solvers' settings in force as options */
  PetscErrorCode (*ksp)(Scheme, const char prefix[], KSP *); /* borrowed; NULL when there is none of this prefix */
  PetscErrorCode (*destroy)(Scheme);
};

/* SchemeRegister - add a scheme under a name of -scheme_type. */
PETSC_EXTERN PetscErrorCode SchemeRegister(const char type[], PetscErrorCode (*create)(Scheme));

/* SchemeCreate - the scene's scheme with the initial state: sigma = 0, p = 0, no disturbance (u_inf in the total form),
   markers X[2M]. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCreate(Scene scene, Fluid fluid, Membrane membrane, Coupling coupling,
                                         const PetscReal X[], Scheme *scheme);
PETSC_EXTERN PetscErrorCode SchemeDestroy(Scheme *scheme);

/* SchemeStep - one time step of size dt. Afterwards scheme->report says what was done; when report.failure is not empty
   the step could not be taken, or led to a state that SchemeCheck refuses, and the state is the last good one.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeStep(Scheme scheme, PetscReal dt);

/* SchemeRemember, SchemeRecall - what the solvers have kept from earlier steps (when their blocks were made, and where
   the markers were), as SchemeMemorySize numbers for a checkpoint, and made again from them. Collective. */
#define SchemeMemorySize(scheme) (SADDLE_MEMORY + 2 * (scheme)->membrane->M)
PETSC_EXTERN PetscErrorCode SchemeRemember(Scheme scheme, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode SchemeRecall(Scheme scheme, const PetscReal memory[]);

/* SchemeKeep, SchemeReturn (watch.c) - copy the state into scheme->before, and put it back. SchemeFreeSnapshot frees
   the copies. */
PETSC_EXTERN PetscErrorCode SchemeKeep(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeReturn(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeFreeSnapshot(Scheme scheme);

/* SchemeCheck (watch.c) - after a step: finite values, markers away from walls, edge ratio, area and length within
   -limit_*; what is wrong and what to try goes into report.failure. Warns when membranes come closer than 2 h.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheck(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeView(Scheme scheme, PetscViewer viewer);

/* SchemePlaceMarkers - put the coupling and the background data (background, g) of time t at the markers X; false with
   report.failure when a marker is too close to a wall. For use inside schemes. */
PETSC_EXTERN PetscErrorCode SchemePlaceMarkers(Scheme scheme, Vec X, PetscReal t, PetscBool *placed);

/* SchemeBackgroundConstraint - g = -Dm background/h^2. */
PETSC_EXTERN PetscErrorCode SchemeBackgroundConstraint(Scheme scheme);

/* SchemeSetSelfMobility - Theta and R at the markers X for a0, and what is known of the markers' velocity before the
   solve, R (u_inf - Theta (Dm^T sigma + c_b ds D4 Xhat)), in u_inf's place in background and g. sigma may be NULL. */
PETSC_EXTERN PetscErrorCode SchemeSetSelfMobility(Scheme scheme, PetscReal a0, Vec X, Vec sigma, Vec Xhat);

/* SchemeSolvedVelocity - U = E w, or R (E w - Theta Dm^T sigma) with self-mobility; sigma may be NULL. */
PETSC_EXTERN PetscErrorCode SchemeSolvedVelocity(Scheme scheme, Vec w, Vec sigma, Vec U);

/* SchemeSurfaceDivergence - d = S^T w, or Dm R E w/h^2 with self-mobility. */
PETSC_EXTERN PetscErrorCode SchemeSurfaceDivergence(Scheme scheme, Vec w, Vec d);

/* SchemeMarkerVelocity - U = background + E w (+ self-mobility of sigma) at the coupling's markers; measures
   report.surface_div_max on the way. */
PETSC_EXTERN PetscErrorCode SchemeMarkerVelocity(Scheme scheme, Vec w, Vec sigma, Vec U);

/* SchemeMeasureDivergence - fill in report.div_max of a solved velocity. */
PETSC_EXTERN PetscErrorCode SchemeMeasureDivergence(Scheme scheme, Vec w);

/* SchemeSolverFailed - record a failed solve: prefix, step, time, residual. */
PETSC_EXTERN PetscErrorCode SchemeSolverFailed(Scheme scheme, const char prefix[], KSPConvergedReason why, PetscInt its,
                                               PetscReal residual);

/* SchemeKineticEnergy - E_K = 1/2 SUM u^2 h^2 of the total velocity minus the background. Collective. */
PETSC_EXTERN PetscErrorCode SchemeKineticEnergy(Scheme scheme, PetscReal *energy);

PETSC_EXTERN PetscErrorCode SchemeCreate_Split(Scheme);
PETSC_EXTERN PetscErrorCode SchemeCreate_Penalty(Scheme);
PETSC_EXTERN PetscErrorCode SchemeCreate_Coupled(Scheme);
