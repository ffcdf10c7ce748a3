/* A scene: what is simulated, as one struct. Nothing in here knows how it is computed. */
#pragma once
#include "curve/curve.h"
#include "scene/fluidspec.h"

typedef enum { DERIVATIVE_FD, DERIVATIVE_BENDING, DERIVATIVE_SPECTRAL } DerivativeType;
typedef enum { LAW_INEXTENSIBLE, LAW_HOOKE, LAW_GREEN, LAW_NEO_HOOKEAN } LawType;
typedef enum { MOMENT_QUADRATIC, MOMENT_ANGLE, MOMENT_HELFRICH } MomentType;
typedef enum { NEAR_EXACT, NEAR_NONE } NearFieldType;
#define NEAR_LEAST_SPACING 0.3 /* ds/h with the exact near field, in which neither kernel nor grid is felt */
#define SCENE_LEAST_GAP 0.3    /* marker spacings between obstacles, down to which their forces are right */
typedef enum { ADAPT_NONE, ADAPT_ERROR } AdaptType;
typedef enum { PRECISION_DOUBLE, PRECISION_SINGLE } PrecisionType;
typedef enum { STARTUP_EULER, STARTUP_GRADED } StartUp;
typedef enum { SHAPE_ELLIPSE, SHAPE_BICONCAVE, SHAPE_FILE, SHAPE_NONE } ShapeType;
typedef enum { OBSTACLE_NONE, OBSTACLE_POSTS, OBSTACLE_COUETTE, OBSTACLE_CONSTRICTION, OBSTACLE_FILE } ObstacleShape;
typedef enum { OBSTACLE_FACTOR_AUTO, OBSTACLE_FACTOR_DENSE, OBSTACLE_FACTOR_MODES } ObstacleFactor;
#define AUTO_SETTINGS 21
#define AUTO_TEXT 128 /* characters of a value or of a reason */
typedef enum { PACKING_RANDOM, PACKING_LATTICE } PackingType;

/* The domain as the user gives it: fluid.box and fluid.cells when their lengths are right. */
typedef struct {
  RealList box;
  IntList cells;
} SceneDomain;

typedef struct {
  PetscInt shape;               /* ShapeType */
  PetscInt count;               /* number of vesicles; a file has its own number */
  RealList axes, center, angle; /* semi-axes, centre, angle in degrees; one entry for all, or one a vesicle */
  RealList area, reduced_area;  /* of ellipses in place of semi-axes, and of biconcave outlines */
  PetscReal area_scale;         /* factor of the areas where a packing of -vesicle_count vesicles chooses it; else 1 */
  RealList mixture;             /* fraction of the vesicles that each kind has; one entry: no mixture */
  PetscInt *kind;               /* [count] with a mixture: which entry of the lists a vesicle takes; else NULL */
  PetscReal packing;            /* area fraction; 0: vesicles lie at their centres */
  PetscInt packing_type;        /* PackingType */
  PetscInt packing_seed;
  PetscReal packing_gap;         /* least distance in a packing (length); 0: by the grid */
  char file[PETSC_MAX_PATH_LEN]; /* curve file */
  PetscReal spacing;             /* ds/h; 0: by kernel */
  PetscInt markers;              /* 0: from spacing */
  PetscBool allow_close_markers; /* accept spacings where the tension problem is near singular */
} SceneVesicles;

/* The membrane of one vesicle. */
typedef struct {
  LawType law;         /* LAW_INEXTENSIBLE where the modulus is 0 */
  PetscReal bending;   /* c_b */
  PetscReal modulus;   /* E_s (length^3/time^2); 0 of one that does not stretch */
  PetscReal viscosity; /* (length^3/time), likewise */
  PetscReal memory;    /* part of the curvature at rest that bending prefers */
} Material;

/* MaterialsAlike - whether two membranes are equal in all. Not collective. */
static inline PetscBool MaterialsAlike(const Material *a, const Material *b) {
  return a->law == b->law && a->bending == b->bending && a->modulus == b->modulus && a->viscosity == b->viscosity &&
         a->memory == b->memory;
}

/* Lists have one entry for all vesicles, or one a vesicle or kind. */
typedef struct {
  RealList stiffness;            /* c_b */
  PetscReal bending;             /* the largest c_b */
  Material *material;            /* [vesicles] */
  RealList viscosity_ratio;      /* inside over outside */
  RealList stretching;           /* E_s, 0 of what does not stretch */
  RealList viscosity;            /* of membranes that stretch */
  PetscReal permeability;        /* for water; 0: none */
  RealList osmotic;              /* osmotic pressures inside and outside */
  IntList law;                   /* LawType */
  PetscInt moment;               /* MomentType of all membranes that stretch */
  RealList memory;               /* part of the curvature at rest that bending prefers */
  char rest[PETSC_MAX_PATH_LEN]; /* initial, circle, or a curve file */
  PetscReal *rest_X;             /* [2 shape.start[vesicles]] markers of the rest shapes, anywhere; NULL: initial */
  PetscInt derivative;           /* DerivativeType */
} SceneMembrane;

typedef enum { DIM_PLANE, DIM_SPACE, DIM_AXIAL } Dimension;

typedef enum { SPHEROID_PROLATE, SPHEROID_OBLATE, SPHEROID_CAPSULE } SpheroidType;

/* A circular tube about bodies of revolution. */
typedef struct {
  PetscReal radius;        /* 0: none (length) */
  PetscReal pressure_drop; /* over the period, in place of the flow's peak velocity (length^2/time^2) */
  PetscReal period;        /* 0: the flux is given (length) */
  PetscReal throat;        /* radius of a throat; 0: none (length) */
  PetscReal throat_center, throat_length, throat_mouth; /* x of its middle, of its narrow part, of a mouth (lengths) */
} SceneTube;

/* What only scenes in three dimensions have. */
typedef struct {
  PetscInt degree;                 /* of the spherical harmonics */
  PetscInt newton;                 /* steps on the bending energy within a time step */
  PetscReal label_rate;            /* (1/time) */
  PetscInt spheroid;               /* SpheroidType */
  RealList radius, reduced_volume; /* of spheroids, one for all or one a vesicle */
  RealList half_axes, axis;        /* three for all, or three a vesicle; half axes in place of radius */
  SceneTube tube;
  PetscReal *X, *R0; /* [count][3 harmonics] first shapes, [count] radii of their volumes */
} SceneSpace;

/* Gravity: a force on the membranes, the inertia of both fluids being the same (Boussinesq). */
typedef struct {
  RealList g;       /* g_x, g_y (length/time^2) */
  RealList density; /* difference over the outer density, one for all or one a vesicle */
} SceneGravity;

/* Obstacles that move as the fluid carries them. */
typedef struct {
  char which[PETSC_MAX_PATH_LEN]; /* their numbers from 1 on, or all; empty: none */
  RealList density;               /* over that of the fluid outside */
  RealList force, torque;         /* from outside (length^3/time^2), (length^4/time^2) */
  PetscBool *is;                  /* [curves] which move freely */
  PetscInt count;
} SceneFreeBodies;

/* Places of circles that have no -obstacle_center. */
typedef struct {
  IntList lattice;   /* columns and rows; 0, 0: none */
  PetscReal shift;   /* of a row against the one below, over the distance of columns */
  PetscInt count;    /* of circles that are packed into the box; 0: none */
  PetscReal *packed; /* [2 count] their centers, once the vesicles have been placed */
} ScenePosts;

/* Solid bodies in the fluid. */
typedef struct {
  PetscInt shape; /* ObstacleShape */
  RealList radius, center, move, rotation;
  PetscReal frequency; /* angular, of the surfaces' velocities (1/time); 0: steady */
  PetscBool moving;    /* closed curves go with their velocities */
  SceneFreeBodies free;
  ScenePosts posts;
  PetscReal throat, length;      /* of a constriction: narrowest width over the channel's; along x, 0: the width */
  char file[PETSC_MAX_PATH_LEN]; /* curve file */
  PetscReal spacing;             /* ds/h */
  PetscInt factor;               /* ObstacleFactor */
  PetscBool modes;               /* the block of each curve, as factor asks for or auto chooses */
  Shape outline;                 /* markers of the obstacles, equal on all ranks */
  PetscReal *velocity, *turn;    /* [2 curves] velocities and [curves] rates of rotation of the surfaces */
  PetscBool *container;          /* [curves] the fluid is inside the curve */
  PetscInt *holder;              /* [vesicles + curves] the container around each; -1: none */
  PetscInt *vesicle;             /* [curves] the vesicle around each; -1: none */
  PetscBool circles;             /* all curves are circles, which turns do not change */
  PetscInt *wall; /* [curves] 2 direction + side of the wall that an open curve is on; -1 of other curves */
} SceneObstacles;

/* SceneObstaclesMove - whether a curve may be where it was not at time 0. Not collective. */
static inline PetscBool SceneObstaclesMove(const SceneObstacles *obstacles) {
  return obstacles->moving || obstacles->free.count;
}

/* Passive points, src/plane/tracers.h. */
typedef struct {
  char file[PETSC_MAX_PATH_LEN];
  IntList grid; /* columns and rows */
} SceneTracers;

typedef struct {
  char kernel[OPTION_MAX_NAME]; /* between grid and markers */
  PetscInt near_field;          /* NearFieldType */
  PetscBool box_part;           /* the near field has the velocities that walls and images add, to fourth order */
  PetscReal ksp_rtol;           /* default of -coupled_ksp_rtol */
} SceneCoupling;

/* A force of short range between membranes, src/bodies/repulsion.h. */
typedef struct {
  PetscReal stress;   /* K (length^2/time^2); 0: none */
  PetscReal range;    /* D (length); 0: 1.5 times the longest mean edge */
  PetscReal adhesion; /* W, depth of the well (length^3/time^2) */
  PetscReal band;     /* B, its width (length); 0: D */
} SceneRepulsion;

/* A potential between the points of different membranes, src/bodies/potential.h. */
typedef struct {
  PetscReal strength; /* H (length^2/time^2); 0: none */
  PetscReal distance; /* d (length) */
  RealList exponents; /* m, n */
} ScenePotential;

typedef struct {
  char type[OPTION_MAX_NAME];
  PetscInt order;                        /* in time */
  PetscReal wanted;                      /* -scheme_auto: relative error; 0: off */
  char reason[AUTO_SETTINGS][AUTO_TEXT]; /* why -scheme_auto chose each setting; empty: no reason to print */
  PetscReal stiffness;                   /* penalty: sigma_0 of the springs */
  PetscBool length_target;               /* coupled: new edges get the length ds */
  PetscInt startup;                      /* StartUp */
} SceneScheme;

typedef struct {
  PetscReal dt, end;
  PetscInt adapt;                      /* AdaptType */
  PetscReal adapt_tol, adapt_max_move; /* error a step over R0; cells a marker may move in a step */
  PetscReal adapt_max_step;            /* largest step of -time_adapt error; 0: none */
  PetscReal cfl_limit;                 /* convective: largest dt max(|u| + |v|)/h */
  PetscReal steady_tol;                /* stop when max |u.n| falls below it */
  PetscReal wall_limit;                /* seconds after which to stop; 0: never */
} SceneTime;

typedef struct {
  char dir[PETSC_MAX_PATH_LEN];     /* every output file goes here */
  PetscReal every;                  /* time between saved fields */
  PetscInt precision;               /* PrecisionType, of saved velocity and pressure */
  PetscInt checkpoint_every;        /* steps between checkpoints; 0: only at the end */
  PetscInt checkpoint_keep;         /* checkpoints kept, the newest included */
  char restart[PETSC_MAX_PATH_LEN]; /* checkpoint to go on from; empty: none */
  PetscBool overwrite;
} SceneOutput;

/* The run stops above them, 0: no limit; and where membranes cross. */
typedef struct {
  PetscReal edge_ratio, area_error, length_error;
  PetscReal gap_loss; /* part of a thin film that a step may take */
  PetscBool crossing;
} SceneLimits;

struct _p_Scene {
  MPI_Comm comm;
  OptionTable options; /* the options, whose values are in this struct */
  PetscInt dim;        /* Dimension */
  SceneSpace space;
  SceneDomain domain;
  FluidSpec fluid;
  Flow flow;
  SceneVesicles vesicles;
  SceneMembrane membrane;
  SceneObstacles obstacles;
  SceneTracers tracers;
  SceneGravity gravity;
  SceneCoupling coupling;
  SceneRepulsion repulsion;
  ScenePotential potential;
  SceneScheme scheme;
  SceneTime time;
  SceneOutput output;
  SceneLimits limits;
  PetscBool view, allow_unused;
  Shape shape;                      /* the initial markers, equal on all ranks */
  PetscReal reynolds;               /* speed R0/nu, see docs/fluid.md; 0 without vesicles, NaN of a custom flow */
  const char *why_inertia;          /* the reason of fluid.inertia */
  char warning[PETVES_MAX_MESSAGE]; /* of the model chosen; empty when there is none */
};
typedef const struct _p_Scene *Scene; /* resolved: all defaults are chosen, it is only read */
typedef struct _p_Scene *Draft;       /* not resolved yet */

/* SceneGiven - whether the user gave this option ("-name"). Not collective. */
static inline PetscBool SceneGiven(Scene scene, const char name[]) {
  return OptionGiven(&scene->options, name);
}
