/* A scene: what is simulated, as the user's options say it. Nothing in here knows how it is computed. */
#pragma once
#include "base/base.h"

#define SCENE_MAX_LIST 32
#define SCENE_MAX_NAME 32

typedef struct {
  PetscInt n;
  PetscReal v[SCENE_MAX_LIST];
} RealList;

typedef struct {
  PetscInt n;
  PetscInt v[SCENE_MAX_LIST];
} IntList;

typedef enum { BC_WALL, BC_PERIODIC } BoundaryType;
typedef enum { FLOW_QUIESCENT, FLOW_SHEAR, FLOW_POISEUILLE, FLOW_EXTENSION, FLOW_CUSTOM } FlowType;
typedef enum { FORM_DISTURBANCE, FORM_TOTAL } FlowForm;
typedef enum { INERTIA_AUTO, INERTIA_NONE, INERTIA_UNSTEADY, INERTIA_CONVECTIVE } InertiaType;
typedef enum { DERIVATIVE_FD, DERIVATIVE_BENDING, DERIVATIVE_SPECTRAL } DerivativeType;
typedef enum { SELF_NONE, SELF_LOCAL, SELF_SYMBOL } SelfMobilityType;
typedef enum { BENDING_IMPLICIT, BENDING_EXPLICIT } BendingType;
typedef enum { ADAPT_NONE, ADAPT_ERROR } AdaptType;
typedef enum { STARTUP_EULER, STARTUP_GRADED } StartUp;
typedef enum { SHAPE_ELLIPSE, SHAPE_FILE, SHAPE_NONE } ShapeType;

/* Background flow u_inf, an exact solution of the Stokes equations (DESIGN section 2), or of a caller's own. Lengths
   and times are in the user's units. */
typedef struct {
  PetscInt type; /* FlowType */
  PetscInt form; /* FlowForm */
  PetscReal rate, peak, half_width, center[2];
  PetvesFlow function; /* FLOW_CUSTOM: the caller's, with its context */
  void *ctx;
  PetscReal time; /* at which u_inf is asked, for FLOW_CUSTOM: whoever asks sets it */
} Flow;

/* Closed curves as equal-edge markers, counter-clockwise. X holds x0,y0,x1,y1,... of all vesicles one after another;
   vesicle v owns markers start[v] .. start[v+1]-1. */
typedef struct {
  PetscInt vesicles;
  PetscInt *start; /* [vesicles+1] */
  PetscReal *X;    /* [2*start[vesicles]] */
} Shape;

typedef struct _p_Scene *Scene;
struct _p_Scene {
  MPI_Comm comm;
  PetscBool *given;                     /* one flag per row of the option table */
  RealList box;                         /* x_min, x_max, y_min, y_max */
  IntList cells;                        /* cells in x and y */
  PetscInt bc[2];                       /* BoundaryType in x and y */
  Flow flow;                            /* background flow */
  PetscReal viscosity;                  /* nu (density is 1) */
  PetscInt inertia;                     /* InertiaType */
  PetscInt shape;                       /* ShapeType */
  PetscInt count;                       /* vesicles */
  RealList axes, center, angle;         /* semi-axes, centre, angle in degrees; one entry for all, or one a vesicle */
  RealList area, reduced_area;          /* of the ellipses, instead of semi-axes */
  char file[PETSC_MAX_PATH_LEN];        /* curve file */
  PetscReal bending;                    /* c_b */
  PetscReal spacing;                    /* ds/h; 0: by kernel */
  PetscInt markers;                     /* 0: from spacing */
  PetscBool allow_close_markers;        /* accept spacings where the tension problem is near singular */
  char delta[SCENE_MAX_NAME];           /* kernel */
  char scheme[SCENE_MAX_NAME];          /* time-stepping scheme */
  PetscInt order;                       /* order in time */
  PetscReal wanted;                     /* -scheme_auto: relative error; 0: off */
  PetscReal ksp_rtol;                   /* default of -coupled_ksp_rtol */
  PetscInt bending_at;                  /* BendingType */
  PetscReal stiffness;                  /* penalty: sigma_0 of the springs; 0 until the scheme chooses it */
  PetscBool length_target;              /* coupled: new edges get the length ds */
  PetscBool area_target;                /* coupled: markers shifted to their first area after each step */
  PetscInt self_mobility;               /* SelfMobilityType */
  PetscInt derivative;                  /* DerivativeType */
  PetscInt startup;                     /* StartUp */
  PetscInt mobility;                    /* index in -mobility_type's list */
  PetscInt adapt;                       /* AdaptType */
  PetscReal adapt_tol, adapt_max_move;  /* error a step over R0; cells a marker may move in a step */
  PetscReal adapt_max_step;             /* largest step of -time_adapt error; 0: none */
  PetscReal cfl_limit;                  /* convective: largest dt max(|u| + |v|)/h */
  PetscReal dt, t_end, steady_tol;      /* time step, end time, stop when max |u.n| falls below steady_tol */
  char helmholtz[SCENE_MAX_NAME];       /* back end of the Helmholtz solves */
  char poisson[SCENE_MAX_NAME];         /* back end of the Poisson solves */
  PetscInt fftw_plan;                   /* 0 estimate, 1 measure, 2 patient */
  char fftw_wisdom[PETSC_MAX_PATH_LEN]; /* file of FFTW's wisdom; empty: none */
  char output_dir[PETSC_MAX_PATH_LEN];  /* every output file goes here */
  PetscReal output_every;               /* time between saved fields */
  PetscInt checkpoint_every;            /* steps between checkpoints; 0: only at the end */
  PetscInt checkpoint_keep;             /* checkpoints kept, the newest included */
  char restart[PETSC_MAX_PATH_LEN];     /* checkpoint to go on from; empty: none */
  PetscReal wall_limit;                 /* seconds after which to stop; 0: never */
  PetscReal limit_edge_ratio, limit_area_error, limit_length_error; /* stop above; 0: no limit */
  PetscBool overwrite, view, allow_unused;
  PetscReal reynolds;               /* set by SceneSetInertia */
  char warning[PETVES_MAX_MESSAGE]; /* of the model chosen; empty when there is none */
};

/* SceneCreate - read and check every option of the options database. Collective. An option with a bad value ends with
   PETSC_ERR_USER_INPUT after one line that names it. Also fills in -help. */
PETSC_EXTERN PetscErrorCode SceneCreate(MPI_Comm comm, Scene *scene);
PETSC_EXTERN PetscErrorCode SceneDestroy(Scene *scene);

/* SceneGiven - whether the user gave this option ("-name"). */
PETSC_EXTERN PetscBool SceneGiven(Scene scene, const char name[]);

/* SceneCheckUnused - stop when the options database holds an option that nothing has read, naming it and the nearest
   known option. Call when all solvers are set up. Collective. */
PETSC_EXTERN PetscErrorCode SceneCheckUnused(Scene scene);

/* SceneWriteOptions - write every option of the table in force, defaults included, one "-name value" a line. */
PETSC_EXTERN PetscErrorCode SceneWriteOptions(Scene scene, FILE *file);

/* SceneOptionName, SceneOptionValue - name and value in force (as text) of the i-th option of the table; name is NULL
   past the last one. */
PETSC_EXTERN const char *SceneOptionName(PetscInt i);
PETSC_EXTERN PetscErrorCode SceneOptionValue(Scene scene, PetscInt i, char value[], size_t length);

/* SceneOptionMayChange - whether a restart may have another value of this option than its checkpoint: the end,
   tolerances, output, limits and back ends may change; the grid, the fluid, the vesicles and the scheme may not. */
PETSC_EXTERN PetscBool SceneOptionMayChange(const char name[]);

/* SceneValidate - checks that involve more than one option. Called by SceneCreate. */
PETSC_EXTERN PetscErrorCode SceneValidate(Scene scene);

/* SceneView - print the model in force: which parts are on, and their numbers. Collective. */
PETSC_EXTERN PetscErrorCode SceneView(Scene scene, const Shape *shape, PetscViewer viewer);

/* SceneChoose - give an option of the table a value that the user has not given: what was given stays. */
PETSC_EXTERN PetscErrorCode SceneChoose(Scene scene, const char name[], const char value[]);

/* SceneAuto - with -scheme_auto: scheme, order, tolerances, kernel and spacing for the error wanted. SceneAutoSteps -
   what depends on the vesicles: the steps; and print all that was chosen, and why. What the user gives stays.
   Collective. Errors: PETSC_ERR_USER_INPUT outside of what was measured, and for schemes that have no error control. */
PETSC_EXTERN PetscErrorCode SceneAuto(Scene scene);
PETSC_EXTERN PetscErrorCode SceneAutoSteps(Scene scene, const Shape *shape);

/* SceneIsProjection - whether the scheme is one of the baselines, split or penalty, which stand on a projection step.
 */
PETSC_EXTERN PetscBool SceneIsProjection(Scene scene);

/* SceneCellSize - h, the edge of the square cells. */
PETSC_EXTERN PetscReal SceneCellSize(Scene scene);

/* FlowVelocity - u_inf[2] at (x, y) and flow->time; NaN when a custom flow's function fails. */
PETSC_EXTERN void FlowVelocity(const Flow *flow, PetscReal x, PetscReal y, PetscReal u[2]);

/* FlowVelocities - u_inf at n points X[2n] and flow->time, u[2n]: one call of a custom flow's function, whose error is
   returned; a value that is not finite is the user's mistake. */
PETSC_EXTERN PetscErrorCode FlowVelocities(const Flow *flow, PetscInt n, const PetscReal X[], PetscReal u[]);

/* FlowPressureGradient - grad p_inf[2] at any point (uniform for the flows offered) for viscosity nu. */
PETSC_EXTERN void FlowPressureGradient(const Flow *flow, PetscReal nu, PetscReal g[2]);

/* FlowGradient - gradient[a][b] = d(u_inf)_a/dx_b at (x, y). */
PETSC_EXTERN void FlowGradient(const Flow *flow, PetscReal x, PetscReal y, PetscReal gradient[2][2]);

/* SceneReynolds - speed R0/nu with R0 of the largest vesicle and the speed of the scene: rate R0 of shear and
   extension, u_max of poiseuille, c_b/(nu R0^2) of a quiescent fluid. 0 without vesicles. */
PETSC_EXTERN PetscReal SceneReynolds(Scene scene, const Shape *shape);

/* SceneSetInertia - the Reynolds number, the model that -fluid_inertia auto stands for, and the warning that goes with
   it. Stops with the user's message when the model does not fit the scene. Collective. */
PETSC_EXTERN PetscErrorCode SceneSetInertia(Scene scene, const Shape *shape);

/* ShapeCreate - the initial markers of the scene's vesicles, all edges of a vesicle equal to 1e-12. Every rank gets
   all markers. Collective; stops with the user's message on a bad file, spacing or position.
   default_spacing and least_spacing: ds/h that the kernel wants, and below which it is refused. */
PETSC_EXTERN PetscErrorCode ShapeCreate(Scene scene, PetscReal default_spacing, PetscReal least_spacing, Shape *shape);
PETSC_EXTERN PetscErrorCode ShapeDestroy(Shape *shape);

/* ShapeRadius - R0 of vesicle v, its length over 2 pi. */
PETSC_EXTERN PetscReal ShapeRadius(const Shape *shape, PetscInt v);

/* Closed curves (curve.c): X(t), t in [0,1), with X(t+1) = X(t). */
typedef struct {
  PetscInt n;          /* 0: ellipse; else number of spline knots */
  PetscReal axes[2];   /* ellipse */
  PetscReal *t, *x[2]; /* knots [n+1], values [n+1] */
  PetscReal *m[2];     /* second derivatives [n+1] */
} Curve;
PETSC_EXTERN void CurveEvaluate(const Curve *curve, PetscReal t, PetscReal X[2]);
PETSC_EXTERN PetscReal CurveLength(const Curve *curve);
PETSC_EXTERN PetscReal CurveArea(const Curve *curve);

/* CurveEqualChords - place M points on the curve so that all M chords are equal; X[2M], first point at t = 0. */
PETSC_EXTERN PetscErrorCode CurveEqualChords(const Curve *curve, PetscInt M, PetscReal X[]);

/* CurveEqualArcs - the same with M equal arcs: the edges of the spectral derivative. */
PETSC_EXTERN PetscErrorCode CurveEqualArcs(const Curve *curve, PetscInt M, PetscReal X[]);

/* CurveFit - move M markers X[2M] as little as possible (least squares) until all their edges, chords or spectral ones
   dX/dk, are length/M long and the polygon or the spectral curve encloses the area: Newton, at most `most` steps. left:
   the largest relative error of squared edges and area. A circle, which has no freedom left, stays. */
PETSC_EXTERN PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[],
                                     PetscInt most, PetscReal *left);

/* CurveFromPoints - closed periodic cubic spline through n points xy[2n], by chord length. */
PETSC_EXTERN PetscErrorCode CurveFromPoints(PetscInt n, const PetscReal xy[], Curve *curve);

/* CurvesFromFile - the closed curves of a text file ("x y" a line, # starts a comment, an empty line ends a curve),
   turned counter-clockwise. Collective: rank 0 reads. */
PETSC_EXTERN PetscErrorCode CurvesFromFile(MPI_Comm comm, const char file[], PetscInt *curves,
                                           Curve curve[SCENE_MAX_LIST]);
PETSC_EXTERN PetscErrorCode CurveDestroy(Curve *curve);

/* EllipseAxes - semi-axes a >= b of the ellipse with the given area and reduced area V = 4 pi area / perimeter^2. */
PETSC_EXTERN PetscErrorCode EllipseAxes(PetscReal area, PetscReal reduced_area, PetscReal axes[2]);
