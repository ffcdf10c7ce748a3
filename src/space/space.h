/* Vesicles in fluid of three dimensions, unbounded or in a tube: their states in time and one step (docs/space.md). A
   shape is its field of coefficients X[size] (sphere/spheregrid.h); ranks own contiguous ranges of vesicles.

   A step of the orders 1 to 3 (scheme/bdf.h) solves the problem of vesicle3.h for all vesicles by GMRES with the prefix
   coupled_, preconditioned by the factors of each vesicle's own problem, which are kept as long as their iterations are
   cheaper than new factors.

   Of several vesicles whose viscosities are not all equal, the velocities U are unknowns too, as they are within the
   double layers. With S and K of each vesicle alone, S_o and D_o from all others, with the tube,

       U + K^-1 [(S + S_o) F + D_o (1 - ratio) U] = K^-1 u_inf. */
#pragma once
#include "precondition/age.h"
#include "scheme/bdf.h"
#include "scheme/stepcontrol.h"
#include "space/crosslayer.h"
#include "space/throat.h"
#include "space/vesicle3.h"

/* A background flow: u[3][n] at the points X[3][n] at time t, not finite where it fails. Not collective. */
typedef PetscErrorCode (*Flow3)(const void *context, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]);

/* The caller fills it in before SpaceCreate. */
typedef struct {
  PetscInt p; /* degree of the harmonics */
  SphereSymmetry symmetry;
  PetscInt order;  /* in time */
  PetscInt newton; /* Newton steps on the bending energy within a step, 1 or 2 */
  PetscReal rtol;  /* default of -coupled_ksp_rtol */
  Flow3 flow;
  const void *context;
  StepPolicy policy;
  Contact3Law repulsion;
  TubeSetting tube; /* about bodies of revolution of the fluid's viscosity */
  ThroatSetting throat;
} SpaceSetting;

/* What the last step did. */
typedef struct {
  PetscReal dt, seconds;
  PetscInt its;                     /* of GMRES */
  PetscReal estimate;               /* largest root mean square of X - X* of a vesicle, over its radius */
  char failure[PETVES_MAX_MESSAGE]; /* why the step was not taken; empty: it was taken */
} SpaceReport;

/* States are arrays of the own vesicles, one behind the other. */
typedef struct {
  PetscInt step;
  PetscReal t, dt_last; /* dt_last: the step, or its last part, that led to it; 0 at the start */
  PetscBool solved;     /* U and sigma are those of a solve */
  PetscReal *X, *U;     /* [own][size] */
  PetscReal *sigma;     /* [own][count] */
} SpaceState;

/* The step under way: the extrapolated state, which has X*, and arrays [own][size], Xhat, the iterate Y, K^-1 u_inf at
   X*, forces and velocities, velocities that are unknowns. */
typedef struct {
  SpaceState star;
  PetscReal *Xhat, *Y, *background, *F, *V, *U;
} SpaceWork;

/* The factors of the own vesicles' problems, and what they were made for: X* [own][size], the tension that pulled
   [own][count]. */
typedef struct {
  PetscReal *matrix;   /* [own][unknowns][unknowns] */
  PetscBLASInt *pivot; /* [own][unknowns] */
  PetscReal a0;        /* 0: none */
  PetscReal *X, *sigma;
} SpaceFactors;

/* The tube and what the vesicles have of it. */
typedef struct {
  Tube tube;           /* NULL: none */
  Throat throat;       /* NULL: none */
  PetscReal *wall;     /* [own][size][rows] T of the vesicles */
  PetscReal *traction; /* [own][size][rows] Theta of those whose ratio of viscosities is not 1 */
  PetscReal spacing;   /* largest of the latitudes of the grids of degree p */
  PetscReal film;      /* least distance of vesicles that have been placed; negative where they overlap */
  PetscReal least;     /* film that nodes and rings resolve (TubeLeastFilm, ThroatLeastFilm) */
  PetscReal thrust;    /* of the vesicles in the last solve: pi R^2 times minus their pressure drop */
  PetscReal *flow;     /* [own][size] what the throat adds to the flow of mean velocity 1; NULL: no throat */
  PetscReal drop;      /* of the pressure by the throat alone, at the mean velocity 1 (length/time) */
  PetscReal left;      /* part of the flux in the tube alone that the throat leaves: 1 where the flux is given */
} SpaceTube;

typedef struct _p_Space *Space;
struct _p_Space {
  VesicleShare share;
  SpaceSetting setting;
  Sphere sphere;
  PetscInt count, size; /* coefficients of a tension, of a field */
  PetscInt unknowns;    /* size + count, and size of U where that is an unknown too */
  Vesicle3 *vesicle;    /* [own] */
  PetscBool contrast;   /* some vesicle's ratio of viscosities is not 1 */
  CrossLayer cross;     /* NULL: one vesicle */
  SpaceTube tube;
  SpaceState state, old[BDF_MOST - 1];
  SpaceState start; /* the first state, which a failed first step goes back to */
  PetscInt past;    /* states before the present one that are known */
  PetscInt order;   /* of the next step, where enough states are known */
  StepPlan plan;    /* of adaptive steps */
  SpaceReport report;
  SpaceWork work;
  Mat A;
  KSP ksp;
  Vec x, b; /* unknowns (Q, sigma) or (Q, sigma, U) of the own vesicles, right-hand sides */
  Age age;  /* of the factors */
  SpaceFactors made;
};

/* SpaceCreate - vesicles of the shapes X[vesicles][3 HarmonicsCount(p)], on whole spheres, with their materials
   [vesicles] at time 0. Collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode SpaceCreate(MPI_Comm comm, const SpaceSetting *setting, PetscInt vesicles,
                                        const Vesicle3Setting material[], const PetscReal X[], Space *space);
PETSC_EXTERN PetscErrorCode SpaceDestroy(Space *space);

/* SpaceStart - solve for the velocities and tensions of the first shapes, which stay. Nothing happens after a step, and
   where the solve fails, as the first step will say why. Collective. */
PETSC_EXTERN PetscErrorCode SpaceStart(Space space);

/* SpaceStep - one time step, to the time `until` at most. The first one of a fixed policy is taken in parts that grow
   from 1/64 of it. When report.failure is not empty the step was not taken, and the state is the one before.
   Collective. */
PETSC_EXTERN PetscErrorCode SpaceStep(Space space, PetscReal until);

/* SpacePlace - the vesicles' parts of the problem at the shapes X[own][size], which the tensions sigma[own][count]
   pull, tube included. SpaceRecall - the factors of a run that goes on, made again for what they were made for,
   space->made. SpaceFailWhere - the step fails for a reason, where `bad` on any rank. Collective. */
PETSC_EXTERN PetscErrorCode SpacePlace(Space space, const PetscReal X[], const PetscReal sigma[]);
PETSC_EXTERN PetscErrorCode SpaceRecall(Space space);
PETSC_EXTERN PetscErrorCode SpaceFailWhere(Space space, PetscBool bad, const char why[]);

/* SpaceMobility - V[own][size] = K^-1 [(S + S_o) F + D_o (1 - ratio) U] of all vesicles where they have been placed,
   the second part where velocities are unknowns. Collective. */
PETSC_EXTERN PetscErrorCode SpaceMobility(Space space, const PetscReal F[], const PetscReal U[], PetscReal V[]);

/* The tube (spacetube.c). SpacePlaceTube - the film, and what the tube adds to the vesicles' own S and K, of vesicles
   that have been placed at X[own][size]. Where the film is thinner than the least the step fails. SpaceMeasureFilm -
   the film of X, where the surfaces are placed, the least one and the spacing. SpaceAddTube - V[own][size] += what the
   tube makes of the forces F[own][size] on other vesicles, or of their velocities F in its part of the double layer.
   SpaceMeasureThrust - of the membranes' forces, minus work.F, and velocities work.V. Collective. */
PETSC_EXTERN PetscErrorCode SpacePlaceTube(Space space, const PetscReal X[]);
PETSC_EXTERN PetscErrorCode SpaceMeasureFilm(Space space, const PetscReal X[], PetscReal *film);
PETSC_EXTERN PetscErrorCode SpaceAddTube(Space space, NearKernel kernel, const PetscReal F[], PetscReal V[]);
PETSC_EXTERN PetscErrorCode SpaceMeasureThrust(Space space);

/* SpaceGuess - a first guess of x: Q that leads to X*, extrapolated tension and U. SpaceIterate - Y = Xhat + Q/a0 of x;
   moved: the largest root mean square of its change, over the radius. Collective. */
PETSC_EXTERN PetscErrorCode SpaceGuess(Space space, PetscReal a0);
PETSC_EXTERN PetscErrorCode SpaceIterate(Space space, PetscReal a0, PetscReal *moved);

/* SpaceSolverCreate - the solver of a space, which SpaceSolve asks for x; SpaceSolve - solve for x about Y, with x as
   the first guess, in one of the Newton steps of a step with a0, of which the first may make new factors, and set V to
   the vesicles' velocities; report.failure says so when it fails. Collective. */
PETSC_EXTERN PetscErrorCode SpaceSolverCreate(Space space);
PETSC_EXTERN PetscErrorCode SpaceSolverDestroy(Space space);
PETSC_EXTERN PetscErrorCode SpaceSolve(Space space, PetscReal a0, PetscInt pass);
