#include "scene/relevance.h"
#include "scene/properties.h"

static PetscBool HasVesicles(const void *scene) {
  return ((Scene)scene)->shape.vesicles > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool HasBodies(const void *scene) {
  return HasVesicles(scene) || ((Scene)scene)->obstacles.shape != OBSTACLE_NONE ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsPacked(const void *scene) {
  const SceneVesicles *vesicles = &((Scene)scene)->vesicles;
  return vesicles->shape == SHAPE_ELLIPSE && vesicles->packing > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsPackedRandomly(const void *scene) {
  return IsPacked(scene) && ((Scene)scene)->vesicles.packing_type == PACKING_RANDOM ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool HasCenters(const void *scene) {
  return HasVesicles(scene) && !IsPacked(scene) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool HasAngles(const void *scene) {
  return HasVesicles(scene) && !IsPackedRandomly(scene) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsCoupled(const void *scene) {
  return HasVesicles(scene) && !strcmp(((Scene)scene)->scheme.type, "coupled") ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool HasRepulsion(const void *scene) {
  return HasVesicles(scene) && ((Scene)scene)->repulsion.stress > 0 ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool HasAdhesion(const void *scene) {
  return ((Scene)scene)->repulsion.adhesion > 0 ? PETSC_TRUE : PETSC_FALSE;
}

/* The 0 that stands for no springs is right for all schemes. */
static PetscBool HasSprings(const void *scene) {
  const SceneScheme *scheme = &((Scene)scene)->scheme;
  return scheme->stiffness == 0 || (HasVesicles(scene) && !strcmp(scheme->type, "penalty")) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsAdaptable(const void *scene) {
  return HasVesicles(scene) || ((Scene)scene)->time.adapt == ADAPT_NONE ? PETSC_TRUE : PETSC_FALSE;
}

/* The 0 that stands for no difference is right for all scenes. */
static PetscBool HasWeight(const void *scene) {
  const RealList *density = &((Scene)scene)->gravity.density;
  const PetscBool none = density->n == 1 && density->v[0] == 0 ? PETSC_TRUE : PETSC_FALSE;
  return none || (HasVesicles(scene) && SceneHasGravity((Scene)scene)) ? PETSC_TRUE : PETSC_FALSE;
}

static PetscBool IsChannel(const void *scene) {
  const PetscInt *bc = ((Scene)scene)->fluid.bc;
  return bc[0] == BC_PERIODIC && bc[1] == BC_WALL ? PETSC_TRUE : PETSC_FALSE;
}

#define AT(member) offsetof(struct _p_Scene, member)
#define IS(value) (1u << (value))
/* clang-format off */
const OptionNeed
  need_strain = {"-flow_type shear or extension", AT(flow.type), IS(FLOW_SHEAR) | IS(FLOW_EXTENSION)},
  need_channel = {"-flow_type poiseuille", AT(flow.type), IS(FLOW_POISEUILLE)},
  need_extension = {"-flow_type extension", AT(flow.type), IS(FLOW_EXTENSION)},
  need_sheared = {"-flow_type shear, poiseuille or extension", AT(flow.type), IS(FLOW_SHEAR) | IS(FLOW_POISEUILLE) | IS(FLOW_EXTENSION) | IS(FLOW_UNIFORM)},
  need_flow = {"a -flow_type that is not quiescent", AT(flow.type), ~(IS(FLOW_QUIESCENT))},
  need_uniform = {"-flow_type uniform", AT(flow.type), IS(FLOW_UNIFORM)},
  need_vesicles = {"vesicles (-vesicle_shape)", .met = HasVesicles},
  need_ellipses = {"-vesicle_shape ellipse", AT(vesicles.shape), IS(SHAPE_ELLIPSE)},
  need_sizes = {"-vesicle_shape ellipse or biconcave", AT(vesicles.shape), IS(SHAPE_ELLIPSE) | IS(SHAPE_BICONCAVE)},
  need_file = {"-vesicle_shape file", AT(vesicles.shape), IS(SHAPE_FILE)},
  need_packing = {"-vesicle_packing", .met = IsPacked},
  need_random = {"-vesicle_packing and -vesicle_packing_type random", .met = IsPackedRandomly},
  need_centers = {"vesicles that are not packed (-vesicle_packing 0)", .met = HasCenters},
  need_angles = {"vesicles that are not packed at random (-vesicle_packing)", .met = HasAngles},
  need_coupled = {"vesicles and -scheme_type coupled", .met = IsCoupled},
  need_repulsion = {"-contact_repulsion", .met = HasRepulsion},
  need_adhesion = {"-contact_adhesion", .met = HasAdhesion},
  need_penalty = {"vesicles and -scheme_type penalty", .met = HasSprings},
  need_order = {"-scheme_order 2 or 3", AT(scheme.order), IS(2) | IS(3)},
  need_adapt = {"-time_adapt error", AT(time.adapt), IS(ADAPT_ERROR)},
  need_adaptable = {"vesicles; without, steps are fixed", .met = IsAdaptable},
  need_convection = {"-fluid_inertia convective", AT(fluid.inertia), IS(INERTIA_CONVECTIVE)},
  need_grid = {"walls or periodic boundaries (-domain_bc_x)", AT(fluid.bc[0]), IS(BC_WALL) | IS(BC_PERIODIC)},
  need_gravity = {"a -fluid_gravity that is not 0,0", .met = HasWeight},
  need_period = {"-domain_bc_x periodic and -domain_bc_y wall", .met = IsChannel},
  need_bodies = {"vesicles (-vesicle_shape) or obstacles (-obstacle_shape)", .met = HasBodies},
  need_obstacles = {"obstacles (-obstacle_shape)", AT(obstacles.shape), ~(IS(OBSTACLE_NONE))},
  need_circles = {"-obstacle_shape posts or couette", AT(obstacles.shape), IS(OBSTACLE_POSTS) | IS(OBSTACLE_COUETTE)},
  need_posts = {"-obstacle_shape posts", AT(obstacles.shape), IS(OBSTACLE_POSTS)},
  need_constriction = {"-obstacle_shape constriction", AT(obstacles.shape), IS(OBSTACLE_CONSTRICTION)},
  need_solid_centers = {"-obstacle_shape posts, couette or constriction", AT(obstacles.shape), ~(IS(OBSTACLE_NONE) | IS(OBSTACLE_FILE))},
  need_obstacle_file = {"-obstacle_shape file", AT(obstacles.shape), IS(OBSTACLE_FILE)};
/* clang-format on */
