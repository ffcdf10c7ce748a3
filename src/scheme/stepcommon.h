/* What the steps of all schemes share: the scheme with its state, what a step reports, and the parts that steps are put
   together from. */
#pragma once
#include "scheme/state.h"
#include "scheme/stepcontrol.h"
#include "fluid/stokes/stream.h"

/* Stresses of a sheared channel after a step, measured at the walls [0] and from the membranes' forces [1] (stress.h).
 */
typedef struct {
  PetscBool known;        /* the scene is a sheared channel, and a step has been made */
  PetscReal viscosity[2]; /* effective viscosity over nu */
  PetscReal normal[2];    /* first normal stress difference (length^2/time^2) */
} Stress;

/* What the last step did. */
typedef struct {
  PetscInt tension_its, bending_its, coupled_its;
  PetscInt solves;           /* scalar fast solves of the step */
  PetscReal div_max;         /* max |G^T u + bc2|, the divergence that the solver left (1/time) */
  PetscReal surface_div_max; /* the surface divergence that the solver left (LawLargest; 1/time) */
  PetscReal area_shift;      /* largest shift of markers that restored a vesicle's area (length) */
  PetscReal estimate;        /* error estimate of a fixed step: max |X - X*|/R0; 0 in a first step and in baselines */
  PetscReal cfl;             /* dt max(|u| + |v|)/h; 0 without convection */
  PetscReal seconds;         /* wall time of the step without output */
  StreamMeasures measures;   /* measures of the velocity where a step does not make it on the grid */
  Stress stress;
  char failure[PETVES_MAX_MESSAGE]; /* why the step was not taken; empty: it was taken */
} StepReport;

/* Number of states before the present one that are kept. */
#define SCHEME_PAST 5

/* All that a step changes and that the next step needs. A checkpoint holds the same. */
typedef struct {
  State state, old[SCHEME_PAST]; /* the present state and those before it; old is empty in schemes of one state */
  PetscInt past;                 /* number of old states that are known */
  StepPlan plan;
  PetscBool fields; /* velocities and pressures are in it; else the scheme's undo restores them */
} Snapshot;

/* Warnings of a run: the first texts, for summary.json, and which warnings have been given. */
#define SCHEME_WARNINGS 16
typedef struct {
  PetscInt n;
  char *text[SCHEME_WARNINGS];
  PetscBool contact; /* parts of membranes are close */
  PetscBool rough;   /* markers do not resolve a membrane */
  PetscBool film;    /* markers do not resolve a film */
  PetscBool step;    /* a step is too large */
  PetscBool corner;  /* a vesicle is in a corner of two walls */
} Warnings;

typedef struct _p_Scheme *Scheme;

/* A Krylov solver of a scheme, borrowed. inner: the preconditioner where the KSP's own is a shell around it, else NULL.
 */
#define SCHEME_SOLVERS 2
typedef struct {
  KSP ksp;
  PC inner;
} SchemeSolver;

/* What a scheme does. All operations are collective; an operation may be NULL where its comment says so. */
typedef struct {
  /* solve the first state, or fill in report.failure and leave it; NULL: fluid and membranes start from rest */
  PetscErrorCode (*start)(Scheme);
  /* advance the state by state.dt, which step-size control chooses up to `most`; or fill in report.failure and leave it
   */
  PetscErrorCode (*step)(Scheme, PetscReal most);
  /* put back the velocities and pressures of state and old that a step with a past has changed; NULL: they are copied
     before each step */
  PetscErrorCode (*undo)(Scheme);
  PetscErrorCode (*view)(Scheme, PetscViewer); /* what SchemeView shows besides Krylov solvers; NULL: nothing */
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
  StepReport report;
  Vec background; /* marker vector: what the markers' velocity has besides the solved part: u_inf, zero in the total
                     form */
  Vec g;          /* right-hand side of the rows of the membranes' law (law.h), minus those of u_inf; edge vector */
  PetscScalar *work_all; /* [2(M + W)] of all curves, for use inside one function */
  void *data;            /* the scheme's own */
  SchemeOps ops;
  PetscInt solvers;
  SchemeSolver solver[SCHEME_SOLVERS];
};

/* The times of a scheme's states and its plan for the next step, for a run that goes on from a checkpoint. */
typedef struct {
  PetscInt step, past;                               /* steps taken; old states that are known */
  PetscReal t, dt, dt_last, dt_earlier[SCHEME_PAST]; /* dt_earlier: the steps that led to the old states */
  StepPlan plan;
} SchemeTimes;

/* SchemeSetTimes - take these times and this plan; a scheme of one state takes no old ones. Not collective. */
PETSC_EXTERN void SchemeSetTimes(Scheme scheme, const SchemeTimes *times);

/* SchemeImplement - give a scheme its operations and its own data. SchemeAddSolver - one more Krylov solver, at most
   SCHEME_SOLVERS, that SchemeView, SchemeWriteOptions and SchemeGetKSP know by its options prefix. SchemeIterations -
   report the iterations of the solves for tension and bending. Not collective. */
PETSC_EXTERN void SchemeImplement(Scheme scheme, const SchemeOps *ops, void *data);
PETSC_EXTERN PetscErrorCode SchemeAddSolver(Scheme scheme, KSP ksp, PC inner);
PETSC_EXTERN void SchemeIterations(Scheme scheme, PetscInt tension, PetscInt bending);

/* SchemeCheckBodies - report.failure says so when bodies at that instant, after a step, have run into what is solid or
   stepped over it. Collective. */
PETSC_EXTERN PetscErrorCode SchemeCheckBodies(Scheme scheme, Instant at);

/* SchemePlace - put everything that a solve stands on at the markers X, with label speeds treading[vesicles] or NULL
   (CouplingPlace), and the background of that instant there: background = u_inf(X), g minus the law's rows of the
   background. report.failure says so when a marker is too close to a wall or the flow has no value. Collective. */
PETSC_EXTERN PetscErrorCode SchemePlace(Scheme scheme, PetscReal a0, Vec X, const PetscReal treading[], Instant at);

/* SchemeBackground - the background flow's velocity at the markers X at time t, zero in the total form, where it is in
   w; report.failure where a flow of the caller's has none. Collective. */
PETSC_EXTERN PetscErrorCode SchemeBackground(Scheme scheme, Vec X, PetscReal t);

/* SchemeMarkerVelocity - U = background + V of the solved part V, with sigma, at the coupling's markers; measures
   report.surface_div_max on the way. U may be V. Collective. */
PETSC_EXTERN PetscErrorCode SchemeMarkerVelocity(Scheme scheme, Vec V, Vec sigma, Vec U);

/* SchemeMeasureDivergence - fill in report.div_max of a solved velocity, whose divergence is to be `expected` (NULL:
   zero). Collective. */
PETSC_EXTERN PetscErrorCode SchemeMeasureDivergence(Scheme scheme, Vec w, Vec expected);

/* SchemeKeep - copy the state into scheme->before. SchemeReturn - put back what was kept before the step; advanced: the
   new state has taken the old one's place since. Collective. */
PETSC_EXTERN PetscErrorCode SchemeKeep(Scheme scheme);
PETSC_EXTERN PetscErrorCode SchemeReturn(Scheme scheme, PetscBool advanced);

/* SchemeSolverFailed - record a failed solve: prefix, step, time, residual. Not collective. */
PETSC_EXTERN PetscErrorCode SchemeSolverFailed(Scheme scheme, const char prefix[], KSPConvergedReason why, PetscInt its,
                                               PetscReal residual);

/* SchemeCurves - scheme->work_all: the vesicles' markers X, then the obstacles at an instant as contacts look at them
   (BodiesSee).
   SchemeNamePair - two bodies in words, by their places: "vesicles 1 and 2", "vesicle 1 and obstacle 2"; `same` with
   the number of one that is both. The first is Collective. */
PETSC_EXTERN PetscErrorCode SchemeCurves(Scheme scheme, Instant at, Vec X);
PETSC_EXTERN PetscErrorCode SchemeNamePair(Scheme scheme, PetscInt v, PetscInt w, const char same[], size_t length,
                                           char text[]);

/* SchemeIsSmooth - whether membranes are curves by their markers, not polygons. Not collective. */
PETSC_EXTERN PetscBool SchemeIsSmooth(Scheme scheme);

/* SchemeAdvise - step, time and what to try, behind what is wrong in report.failure. Not collective. */
PETSC_EXTERN PetscErrorCode SchemeAdvise(Scheme scheme, const char advice[]);

/* SchemeWarn - a warning on rank 0's output, one line, and among those of summary.json. Every rank gives the same text.
   Collective. */
PETSC_EXTERN PetscErrorCode SchemeWarn(Scheme scheme, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
