/* Time-stepping schemes: the interface behind which they stand. */
#pragma once
#include "scheme/judge.h"
#include "scheme/state.h"
#include "fluid/stream.h"

/* Of a sheared channel after a step, from the walls [0] and from the membranes' forces [1] (src/scheme/stress.h). */
typedef struct {
  PetscBool known;        /* whether the scene is one, and a step has been made */
  PetscReal viscosity[2]; /* effective, over nu */
  PetscReal normal[2];    /* first normal stress difference (length^2/time^2) */
} Stress;

/* What the last step did. */
typedef struct {
  PetscInt tension_its, bending_its, coupled_its;
  PetscInt solves;           /* scalar fast solves */
  PetscReal div_max;         /* max |G^T u + bc2|, what the solver left of the divergence */
  PetscReal surface_div_max; /* max |h^2 (Dm V/h^2 - g)/ds|, what it left of the surface divergence */
  PetscReal area_shift;      /* largest shift that restored a vesicle's area (length) */
  PetscReal estimate;        /* of a fixed step of coupled or direct: max |X - X*|/R0, 0 in the first one */
  PetscReal cfl;             /* dt max(|u| + |v|)/h; 0 without convection */
  PetscReal seconds;         /* wall, output excluded */
  StreamMeasures measures;   /* of the velocity of a step that leaves it pending */
  Stress stress;
  const char *stopped; /* why a first step was left undone between two of its parts (StopRequested); NULL: it was not */
  char failure[PETVES_MAX_MESSAGE]; /* why the step could not be taken; empty when it was */
} StepReport;

/* The states before the present one that are kept. */
#define SCHEME_PAST 5

/* All that a step changes and the next one needs; State and this are what a checkpoint holds. */
typedef struct {
  State state, old[SCHEME_PAST]; /* old without vectors where the scheme has none */
  PetscInt past;
  StepPlan plan;
  PetscBool fields; /* velocities and pressures too; without, the scheme's undo brings them back */
} Snapshot;

/* Warnings of the run, for summary.json: the first ones, and which have been given. */
#define SCHEME_WARNINGS 16
typedef struct {
  PetscInt n;
  char *text[SCHEME_WARNINGS];
  PetscBool contact; /* whether parts of membranes are close, as last warned of */
  PetscBool rough;   /* whether it was warned that markers do not resolve a membrane */
  PetscBool film;    /* likewise that they do not resolve a film, */
  PetscBool step;    /* that a step was too large, */
  PetscBool corner;  /* and of a vesicle in a corner of two walls */
} Warnings;

typedef struct _p_Scheme *Scheme;

typedef struct {
  PetscErrorCode (*setup)(Scheme);
  PetscErrorCode (*step)(Scheme, PetscReal most); /* advance the state by state.dt, which step-size control chooses up
                                                     to `most`; or fill in report.failure and leave it */
  /* put back the velocities and pressures of state and old that a step with a past has changed; NULL: they are copied
     before each step */
  PetscErrorCode (*undo)(Scheme);
  /* make what the state has not of velocity and pressure, with a flow the pressure alone; NULL: steps make them */
  PetscErrorCode (*fields)(Scheme);
  /* w = the velocity of a state that has a flow; the flow of w; SUM u^2 over the faces of the state's velocity, which
     is not made */
  PetscErrorCode (*velocity)(Scheme, const State *, Vec w);
  PetscErrorCode (*flow)(Scheme, Vec w, Vec flow);
  PetscErrorCode (*square)(Scheme, PetscReal *square);
  /* what solvers keep from step to step, as SchemeMemorySize numbers, the same on every rank, and made again from them;
     NULL: they keep nothing */
  PetscErrorCode (*remember)(Scheme, PetscReal memory[]);
  PetscErrorCode (*recall)(Scheme, const PetscReal memory[]);
  PetscErrorCode (*view)(Scheme, PetscViewer);
  PetscErrorCode (*options)(Scheme, FILE *);                 /* write the solvers' settings in force as options */
  PetscErrorCode (*ksp)(Scheme, const char prefix[], KSP *); /* borrowed; NULL when there is none of this prefix */
  PetscErrorCode (*destroy)(Scheme);
} SchemeOps;

struct _p_Scheme {
  char type[OPTION_MAX_NAME];
  Scene scene;       /* borrowed */
  Coupling coupling; /* borrowed; what is below is its own */
  Fluid fluid;
  Membrane membrane; /* of no vesicle when the scene has none */
  StepPolicy policy;
  StepPlan plan;
  State state;
  State old[SCHEME_PAST]; /* the states before it, the newest first, of schemes that go on from several; else empty */
  PetscInt past;          /* how many of them are known */
  Snapshot before;        /* what SchemeStep goes back to when a step fails */
  Warnings warnings;
  PetscReal reserve; /* SchemeStep's, of the step under way (seconds) */
  StepReport report;
  Vec background;   /* marker vector: what the markers' velocity has besides the solved part: u_inf, zero in the total
                       form */
  Vec g;            /* edge vector: S^T u = g, minus the background's stretching, Dm u_inf/h^2 */
  Vec work_tension; /* edge vector, for use inside one function */
  PetscScalar *work_all; /* [2(M + W)] likewise, of all curves */
  void *data;            /* the scheme's own */
  SchemeOps ops;
};

/* SchemeRegister - add a scheme under a name of -scheme_type. */
PETSC_EXTERN PetscErrorCode SchemeRegister(const char type[], PetscErrorCode (*create)(Scheme));

/* SchemeCreate - the scene's scheme with the initial state: sigma = 0, p = 0, no disturbance (u_inf in the total form),
   markers X[2M] of all vesicles. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCreate(Scene scene, Coupling coupling, const PetscReal X[], Scheme *scheme);
PETSC_EXTERN PetscErrorCode SchemeDestroy(Scheme *scheme);

/* SchemeStep - one time step: the policy's, at most `most`, the time that is left (PETSC_MAX_REAL: no end). Afterwards
   scheme->report says what was done; when report.failure is not empty the step could not be taken, or led to a state
   that is refused, and the state is the last good one. A first step stops between its parts, or attempts, at a signal
   or where less than `reserve` seconds of -time_wall_limit would be left after another one: report.stopped says why,
   and the state is as before; negative: it does not. Collective. */
PETSC_EXTERN PetscErrorCode SchemeStep(Scheme scheme, PetscReal most, PetscReal reserve);

/* SchemeFields - make the velocity and the pressure of the state, w and p, where the step has not: it needs neither on
   the grid where fluid/stream.h gives the velocity (docs/membrane.md, One step). SchemeVelocity - w alone, if there is
   a cheaper way. To be called before they are read. Collective. */
PETSC_EXTERN PetscErrorCode SchemeFields(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeVelocity(Scheme scheme);

/* SchemeRemember, SchemeRecall - what the solvers have kept from earlier steps (when their blocks were made, and where
   the markers were), as SchemeMemorySize numbers for a checkpoint, and made again from them. Collective. */
PETSC_EXTERN PetscInt SchemeMemorySize(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeRemember(Scheme scheme, PetscReal memory[]);
PETSC_EXTERN PetscErrorCode SchemeRecall(Scheme scheme, const PetscReal memory[]);

PETSC_EXTERN PetscErrorCode SchemeView(Scheme scheme, PetscViewer viewer);

/* SchemeContactEnergy - of the repulsion and adhesion of membranes at the present state (length^4/time^2); 0 without.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeContactEnergy(Scheme scheme, PetscReal *energy);

/* SchemeKineticEnergy - E_K = 1/2 SUM u^2 h^2 of the total velocity minus the background. Collective. */
PETSC_EXTERN PetscErrorCode SchemeKineticEnergy(Scheme scheme, PetscReal *energy);
