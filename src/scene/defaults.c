#include "scene/defaults.h"
#include "scene/properties.h"

static PetscBool IsBiconcave(const void *scene) {
  return ((Scene)scene)->vesicles.shape == SHAPE_BICONCAVE;
}

static PetscBool IsSpace(const void *scene) {
  return ((Scene)scene)->dim != DIM_PLANE;
}

static PetscBool HasFormula(const void *scene) {
  const Scene s = (Scene)scene;
  return SceneGiven(s, "-flow_u") || SceneGiven(s, "-flow_v") || (s->dim != DIM_PLANE && SceneGiven(s, "-flow_w"));
}

static PetscBool IsProjection(const void *scene) {
  return SceneIsProjection((Scene)scene);
}

static PetscBool HasNoNearField(const void *scene) {
  return ((Scene)scene)->coupling.near_field == NEAR_NONE;
}

static PetscBool IsFree(const void *scene) {
  return FluidSpecIsFree(&((Scene)scene)->fluid);
}

#define LARGE_BOX 256 /* cells across */

static PetscBool IsLarge(const void *scene) {
  const IntList cells = ((Scene)scene)->domain.cells; /* not checked yet */
  if (HasNoNearField(scene) || IsFree(scene) || ((Scene)scene)->obstacles.shape != OBSTACLE_NONE) return PETSC_FALSE;
  return cells.n == 2 && PetscMin(cells.v[0], cells.v[1]) >= LARGE_BOX;
}

/* -scheme_auto has a largest step of its own. */
static PetscBool IsAdaptive(const void *scene) {
  const Scene s = (Scene)scene;
  return s->time.adapt != ADAPT_NONE && s->shape.vesicles && s->scheme.wanted == 0;
}

/* At rest for the error that the area target leaves there; a flow has steps of its own. */
static void LargestStep(const void *scene, char value[OPTION_MAX_NAME]) {
  const Scene s = (Scene)scene;
  const PetscBool rests = FlowShearRate(&s->flow) == 0 && !FlowIsCustom(&s->flow);
  const PetscReal most = rests ? SceneRestTime(s) : SceneFlowStep(s);
  if (most < PETSC_MAX_REAL) (void)snprintf(value, OPTION_MAX_NAME, "%.6g", (double)most);
}

#define MOST_FRAMES 100 /* the first included */

static PetscReal LeastOutputTime(const void *scene) {
  return ((Scene)scene)->time.end / (MOST_FRAMES - 1) * (1 - 1e-12);
}

static PetscBool IsLong(const void *scene) {
  return LeastOutputTime(scene) > 0.1;
}

static void OutputTime(const void *scene, char value[OPTION_MAX_NAME]) {
  static const int steps[3] = {1, 2, 5};
  for (int k = -1; !*value; k++)
    for (int s = 0; s < 3 && !*value; s++)
      if (steps[s] * PetscPowRealInt(10, k) >= LeastOutputTime(scene))
        (void)snprintf(value, OPTION_MAX_NAME, "%de%d", steps[s], k);
}

/* Between walls in y the Poiseuille flow vanishes on both. */
static PetscBool IsWalled(const void *scene) {
  const Scene s = (Scene)scene;
  if (s->dim != DIM_PLANE) return PETSC_FALSE;
  const RealList box = s->domain.box; /* not checked yet */
  if (s->flow.type != FLOW_POISEUILLE || s->fluid.bc[1] != BC_WALL || box.n != 4) return PETSC_FALSE;
  return box.v[2] < box.v[3];
}

static void HalfHeight(const void *scene, char value[OPTION_MAX_NAME]) {
  const PetscReal *box = ((Scene)scene)->domain.box.v;
  (void)snprintf(value, OPTION_MAX_NAME, "%.15g", (double)(box[3] - box[2]) / 2);
}

static void MiddleHeight(const void *scene, char value[OPTION_MAX_NAME]) {
  const PetscReal *box = ((Scene)scene)->domain.box.v;
  (void)snprintf(value, OPTION_MAX_NAME, "%.15g", (double)(box[2] + box[3]) / 2);
}

/* split and penalty are their papers' methods: one order, kernel ib6 and differences, none of the corrections of the
   coupled scheme. The box part is the grid's. */
/* clang-format off */
const OptionDefault scene_defaults[] = {
  {"-flow_type", HasFormula, "formula", NULL, "it is given by formulas", NULL},
  {"-fluid_gravity", IsSpace, "0,0,0", NULL, "three dimensions", NULL},
  {"-flow_velocity", IsSpace, "1,0,0", NULL, "three dimensions", NULL},
  {"-vesicle_center", IsSpace, "0,0,0", NULL, "three dimensions", NULL},
  {"-flow_half_width", IsWalled, NULL, HalfHeight, "poiseuille, from wall to wall", "between walls in y: half their distance"},
  {"-flow_center_y", IsWalled, NULL, MiddleHeight, "poiseuille, from wall to wall", "poiseuille between walls in y: their middle"},
  {"-vesicle_reduced_area", IsBiconcave, "0.65", NULL, "the outline is biconcave", "biconcave: 0.35 to 0.9, %s when not given"},
  {"-scheme_order", IsProjection, "1", NULL, "splitting errors and forward steps of markers are of first order", "split and penalty are of order %s"},
  {"-delta_type", IsProjection, "ib6", NULL, "the paper's kernel", "split, penalty: %s"},
  {"-membrane_derivative", IsProjection, "fd", NULL, "preconditioner and springs know chords only", "split, penalty: %s"},
  {"-coupling_near_field", IsProjection, "none", NULL, "the paper's method has none", NULL},
  {"-coupling_box_part", HasNoNearField, "false", NULL, "it is part of the exact near field", NULL},
  {"-coupling_box_part", IsFree, "false", NULL, "there is no box", NULL},
  {"-coupling_box_part", IsLarge, "false", NULL, "in a box so large it moves vesicles by 2e-5 of their speed at most", "default %s from 256 cells across on"},
  {"-time_adapt_max_step", IsAdaptive, NULL, LargestStep, "what this flow, or the shape at rest, bears", "not given: 1/(rate (1 + 0.03 chi)) in a flow, nu R0^3/c_b without one (time)"},
  {"-output_every", IsLong, NULL, OutputTime, "at most 100 frames", "not given: 0.1, or so many times more (1, 2, 5, 10 ...) that there are at most 100 (time)"},
  {NULL}};
/* clang-format on */
