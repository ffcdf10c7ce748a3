/* Which options a scene uses: one that says something about what is not there is refused. */
#include "scene/resolve.h"

/* What has to be there for an option to mean something. */
typedef enum {
  BY_STRAIN,
  BY_CHANNEL,
  BY_EXTENSION,
  BY_SHEARED,
  BY_FLOW,
  BY_VESICLES,
  BY_ELLIPSES,
  BY_SIZES,
  BY_FILE,
  BY_PACKING,
  BY_RANDOM,
  BY_CENTERS,
  BY_ANGLES,
  BY_UNSPLIT,
  BY_COUPLED,
  BY_REPULSION,
  BY_ADHESION,
  BY_PENALTY,
  BY_ORDER,
  BY_ADAPT,
  BY_ADAPTABLE,
  BY_CONVECTION,
  BY_GRID,
  BY_GRAVITY,
  BY_PERIOD,
  BY_UNIFORM,
  BY_BODIES,
  BY_OBSTACLES,
  BY_CIRCLES,
  BY_POSTS,
  BY_CONSTRICTION,
  BY_SOLID_CENTERS,
  BY_OBSTACLE_FILE
} Need;

static const char *const needs[] = {"-flow_type shear or extension",
                                    "-flow_type poiseuille",
                                    "-flow_type extension",
                                    "-flow_type shear, poiseuille or extension",
                                    "a -flow_type that is not quiescent",
                                    "vesicles (-vesicle_shape)",
                                    "-vesicle_shape ellipse",
                                    "-vesicle_shape ellipse or biconcave",
                                    "-vesicle_shape file",
                                    "-vesicle_packing",
                                    "-vesicle_packing and -vesicle_packing_type random",
                                    "vesicles that are not packed (-vesicle_packing 0)",
                                    "vesicles that are not packed at random (-vesicle_packing)",
                                    "vesicles and -scheme_type coupled",
                                    "vesicles and -scheme_type coupled",
                                    "-contact_repulsion",
                                    "-contact_adhesion",
                                    "vesicles and -scheme_type penalty",
                                    "-scheme_order 2 or 3",
                                    "-time_adapt error",
                                    "vesicles; without, steps are fixed",
                                    "-fluid_inertia convective",
                                    "walls or periodic boundaries (-domain_bc_x)",
                                    "a -fluid_gravity that is not 0,0",
                                    "-domain_bc_x periodic and -domain_bc_y wall",
                                    "-flow_type uniform",
                                    "vesicles (-vesicle_shape) or obstacles (-obstacle_shape)",
                                    "obstacles (-obstacle_shape)",
                                    "-obstacle_shape posts or couette",
                                    "-obstacle_shape posts",
                                    "-obstacle_shape constriction",
                                    "-obstacle_shape posts, couette or constriction",
                                    "-obstacle_shape file"};

/* Options that are not listed are used by every scene. */
static const struct {
  const char *name;
  Need need;
} rules[] = {{"-flow_rate", BY_STRAIN},
             {"-flow_chi", BY_STRAIN},
             {"-flow_ca", BY_CHANNEL},
             {"-flow_peak_velocity", BY_CHANNEL},
             {"-flow_half_width", BY_CHANNEL},
             {"-flow_center_x", BY_EXTENSION},
             {"-flow_center_y", BY_SHEARED},
             {"-flow_form", BY_FLOW},
             {"-flow_drive", BY_PERIOD},
             {"-flow_velocity", BY_UNIFORM},
             {"-fluid_gravity", BY_UNSPLIT},
             {"-vesicle_count", BY_VESICLES},
             {"-vesicle_semi_axes", BY_ELLIPSES},
             {"-vesicle_area", BY_SIZES},
             {"-vesicle_reduced_area", BY_SIZES},
             {"-vesicle_center", BY_CENTERS},
             {"-vesicle_angle", BY_ANGLES},
             {"-vesicle_mixture", BY_SIZES},
             {"-vesicle_packing", BY_ELLIPSES},
             {"-vesicle_packing_type", BY_PACKING},
             {"-vesicle_packing_seed", BY_RANDOM},
             {"-vesicle_packing_gap", BY_PACKING},
             {"-vesicle_file", BY_FILE},
             {"-vesicle_bending", BY_VESICLES},
             {"-vesicle_density_difference", BY_GRAVITY},
             {"-vesicle_viscosity_ratio", BY_VESICLES},
             {"-vesicle_spacing", BY_VESICLES},
             {"-vesicle_markers", BY_VESICLES},
             {"-vesicle_allow_close_markers", BY_VESICLES},
             {"-obstacle_radius", BY_CIRCLES},
             {"-obstacle_center", BY_SOLID_CENTERS},
             {"-obstacle_lattice", BY_POSTS},
             {"-obstacle_shift", BY_POSTS},
             {"-obstacle_throat", BY_CONSTRICTION},
             {"-obstacle_length", BY_CONSTRICTION},
             {"-obstacle_velocity", BY_CIRCLES},
             {"-obstacle_rotation", BY_CIRCLES},
             {"-obstacle_frequency", BY_OBSTACLES},
             {"-obstacle_moving", BY_OBSTACLES},
             {"-obstacle_file", BY_OBSTACLE_FILE},
             {"-obstacle_spacing", BY_OBSTACLES},
             {"-obstacle_factor", BY_OBSTACLES},
             {"-delta_type", BY_BODIES},
             {"-scheme_auto", BY_VESICLES},
             {"-scheme_bending", BY_VESICLES},
             {"-penalty_stiffness", BY_PENALTY},
             {"-scheme_length_target", BY_UNSPLIT},
             {"-scheme_area_target", BY_VESICLES},
             {"-coupling_near_field", BY_BODIES},
             {"-coupling_box_part", BY_BODIES},
             {"-coupling_grid_dipoles", BY_COUPLED},
             {"-contact_repulsion", BY_UNSPLIT},
             {"-contact_repulsion_range", BY_REPULSION},
             {"-contact_adhesion", BY_REPULSION},
             {"-contact_adhesion_range", BY_ADHESION},
             {"-membrane_derivative", BY_VESICLES},
             {"-scheme_startup", BY_ORDER},
             {"-time_adapt", BY_ADAPTABLE},
             {"-time_adapt_tol", BY_ADAPT},
             {"-time_adapt_max_move", BY_ADAPT},
             {"-time_adapt_max_step", BY_ADAPT},
             {"-time_cfl_limit", BY_CONVECTION},
             {"-time_steady_tol", BY_VESICLES},
             {"-helmholtz_type", BY_GRID},
             {"-poisson_type", BY_GRID},
             {"-limit_edge_ratio", BY_VESICLES},
             {"-limit_area_error", BY_VESICLES},
             {"-limit_length_error", BY_VESICLES},
             {"-limit_gap_loss", BY_VESICLES},
             {"-limit_crossing", BY_VESICLES}};
#define RULES (sizeof(rules) / sizeof(rules[0]))

static PetscBool IsFlow(Scene s, FlowType a, FlowType b) {
  return s->flow.type == (PetscInt)a || s->flow.type == (PetscInt)b ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsScheme(Scene s, const char name[]) {
  return s->shape.vesicles && !strcmp(s->scheme.type, name) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool MetByFlow(Scene s, Need need) {
  if (need == BY_STRAIN) return IsFlow(s, FLOW_SHEAR, FLOW_EXTENSION);
  if (need == BY_CHANNEL) return IsFlow(s, FLOW_POISEUILLE, FLOW_POISEUILLE);
  if (need == BY_EXTENSION) return IsFlow(s, FLOW_EXTENSION, FLOW_EXTENSION);
  return !IsFlow(s, FLOW_QUIESCENT, need == BY_SHEARED ? FLOW_CUSTOM : FLOW_QUIESCENT);
}

static PetscBool MetByShape(Scene s, Need need) {
  const PetscInt shape = s->vesicles.shape;
  if (need == BY_FILE) return shape == SHAPE_FILE;
  return shape == SHAPE_ELLIPSE || (need == BY_SIZES && shape == SHAPE_BICONCAVE) ? PETSC_TRUE : PETSC_FALSE;
}

/* What depends on how vesicles come to their places. */
static PetscBool MetByPlaces(Scene s, Need need) {
  const PetscBool packed = s->vesicles.shape == SHAPE_ELLIPSE && s->vesicles.packing > 0 ? PETSC_TRUE : PETSC_FALSE;
  const PetscBool random = packed && s->vesicles.packing_type == PACKING_RANDOM ? PETSC_TRUE : PETSC_FALSE;
  if (need == BY_PACKING) return packed;
  if (need == BY_RANDOM) return random;
  return s->shape.vesicles && !(need == BY_ANGLES ? random : packed) ? PETSC_TRUE : PETSC_FALSE;
}

/* The 0 that stands for none is right for all. */
static PetscBool UsesDensity(Scene s) {
  const RealList *density = &s->gravity.density;
  return (s->shape.vesicles && SceneHasGravity(s)) || (density->n == 1 && density->v[0] == 0) ? PETSC_TRUE
                                                                                              : PETSC_FALSE;
}

static PetscBool MetByObstacles(Scene s, Need need) {
  const PetscInt shape = s->obstacles.shape;
  if (need == BY_BODIES) return s->shape.vesicles > 0 || shape != OBSTACLE_NONE ? PETSC_TRUE : PETSC_FALSE;
  if (need == BY_OBSTACLES) return shape != OBSTACLE_NONE ? PETSC_TRUE : PETSC_FALSE;
  if (need == BY_OBSTACLE_FILE) return shape == OBSTACLE_FILE ? PETSC_TRUE : PETSC_FALSE;
  if (need == BY_CONSTRICTION) return shape == OBSTACLE_CONSTRICTION ? PETSC_TRUE : PETSC_FALSE;
  if (need == BY_SOLID_CENTERS) return shape != OBSTACLE_NONE && shape != OBSTACLE_FILE ? PETSC_TRUE : PETSC_FALSE;
  return shape == OBSTACLE_POSTS || (need == BY_CIRCLES && shape == OBSTACLE_COUETTE) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool Met(Scene s, Need need) {
  const PetscBool any = s->shape.vesicles > 0 ? PETSC_TRUE : PETSC_FALSE;
  if (need <= BY_FLOW) return MetByFlow(s, need);
  if (need >= BY_ELLIPSES && need <= BY_FILE) return MetByShape(s, need);
  if (need >= BY_PACKING && need <= BY_ANGLES) return MetByPlaces(s, need);
  if (need >= BY_BODIES) return MetByObstacles(s, need);
  switch (need) {
  case BY_UNIFORM:
    return IsFlow(s, FLOW_UNIFORM, FLOW_UNIFORM);
  case BY_UNSPLIT:
  case BY_COUPLED:
    return IsScheme(s, "coupled");
  case BY_REPULSION:
    return s->repulsion.stress > 0 && s->shape.vesicles ? PETSC_TRUE : PETSC_FALSE;
  case BY_ADHESION:
    return s->repulsion.adhesion > 0 ? PETSC_TRUE : PETSC_FALSE;
  case BY_PENALTY: /* the 0 that stands for none is right for all */
    return IsScheme(s, "penalty") || s->scheme.stiffness == 0;
  case BY_ORDER:
    return s->scheme.order > 1;
  case BY_ADAPT:
    return s->time.adapt == ADAPT_ERROR;
  case BY_ADAPTABLE:
    return any || s->time.adapt == ADAPT_NONE;
  case BY_CONVECTION:
    return s->fluid.inertia == INERTIA_CONVECTIVE;
  case BY_GRID:
    return !FluidSpecIsFree(&s->fluid);
  case BY_GRAVITY:
    return UsesDensity(s);
  case BY_PERIOD:
    return s->fluid.bc[0] == BC_PERIODIC && s->fluid.bc[1] == BC_WALL;
  default:
    return any;
  }
}

PetscBool SceneUses(Scene scene, const char name[]) {
  for (size_t k = 0; k < RULES; k++)
    if (!strcmp(rules[k].name, name)) return Met(scene, rules[k].need);
  return PETSC_TRUE;
}

PetscErrorCode SceneCheckUsed(Scene scene) {
  PetscFunctionBeginUser;
  for (size_t k = 0; k < RULES && !scene->allow_unused; k++) {
    const char *value = NULL; /* as it was typed */
    if (!OptionGiven(&scene->options, rules[k].name) || Met(scene, rules[k].need)) continue;
    PetscCall(PetscOptionsFindPair(NULL, NULL, rules[k].name, &value, NULL));
    SETERRQ(scene->comm, PETSC_ERR_USER_INPUT,
            "%s %.128s: not used by this scene; allowed: with %s (-allow_unused_options goes on)", rules[k].name,
            value ? value : "", needs[rules[k].need]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
