#include "scene/checks.h"
#include "scene/properties.h"

/* Reynolds number below which a channel or a strain flow is quasi-steady by default. */
#define SMALL_REYNOLDS 0.01
/* Reynolds number above which a vesicle that unsteady Stokes flow carries along goes astray. */
#define CARRIED_REYNOLDS 0.05

static PetscReal SceneReynolds(Scene scene, PetscReal R0) {
  const Flow *flow = &scene->flow;
  PetscReal speed = 0;
  if (R0 == 0) return 0;
  if (FlowIsCustom(flow)) return NAN;
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION) speed = PetscAbsReal(flow->rate) * R0;
  if (flow->type == FLOW_POISEUILLE) speed = PetscAbsReal(flow->peak);
  if (flow->type == FLOW_UNIFORM) speed = PetscHypotReal(flow->velocity.v[0], flow->velocity.v[1]);
  if (flow->type == FLOW_QUIESCENT) speed = scene->membrane.bending / (scene->fluid.nu * PetscSqr(R0));
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) /* settling */
    speed = PetscMax(speed, PetscHypotReal(SceneWeight(scene, v, 0), SceneWeight(scene, v, 1)) * PetscSqr(R0) /
                                scene->fluid.nu);
  return speed * R0 / scene->fluid.nu;
}

/* Largest Reynolds number of a vesicle's own way through the fluid: |u_inf| at its centre, times R0/nu. */
static PetscReal SceneCarriedReynolds(Scene scene) {
  const Shape *shape = &scene->shape;
  PetscReal most = 0;
  for (PetscInt v = 0; v < shape->vesicles; v++) {
    PetscReal X[2], u[2];
    ShapeMiddle(shape, v, X);
    FlowVelocity(&scene->flow, 0, X[0], X[1], u);
    most = PetscMax(most, PetscSqrtReal(PetscSqr(u[0]) + PetscSqr(u[1])));
  }
  return most * SceneLargestRadius(scene) / scene->fluid.nu;
}

/* FALSE if u_inf differs across a periodic boundary; dir: the first direction in which it does. */
static PetscBool FlowIsSeamless(Scene scene, int *dir) {
  const PetscReal *b = scene->fluid.box, d = FluidSpecCellSize(&scene->fluid);
  PetscReal jump = 0, most = 0, u[2], v[2];
  for (*dir = 0; *dir < 2; (*dir)++) {
    for (int k = 0; k < 4 && scene->fluid.bc[*dir] == BC_PERIODIC; k++) {
      PetscReal X[2] = {b[0], b[2]}, Y[2];
      X[1 - *dir] = b[2 * (1 - *dir) + k % 2];
      X[*dir] += k / 2 ? d : -d;
      Y[0] = X[0], Y[1] = X[1];
      Y[*dir] += b[2 * *dir + 1] - b[2 * *dir];
      FlowVelocity(&scene->flow, 0, X[0], X[1], u);
      FlowVelocity(&scene->flow, 0, Y[0], Y[1], v);
      for (int c = 0; c < 2; c++) {
        jump = PetscMax(jump, PetscAbsReal(u[c] - v[c]));
        most = PetscMax(most, PetscAbsReal(u[c]));
      }
    }
    if (jump > 1e-9 * most) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Steps over the membrane's own time from which on no step was seen to succeed: rounding is all that is left. */
#define MOST_STIFF 1e10

/* clang-format off */
/* Check that the step is not too long for the membrane's own time. The membrane is resisted by viscosity, or, without
   the exact near field, by the inertia of a step. */
static PetscErrorCode SceneCheckStiffness(Scene scene) {
  const PetscReal R0 = SceneLargestRadius(scene), dt = scene->time.dt, inertia = R0 * R0 / dt;
  const PetscBool viscous = scene->coupling.near_field == NEAR_EXACT;
  const PetscReal resists = viscous ? scene->fluid.nu : PetscMax(scene->fluid.nu, inertia);
  const PetscReal own = resists * R0 * R0 * R0 / scene->membrane.bending;
  return SCENE_REFUSE_IF(scene, R0 > 0 && scene->membrane.bending > 0 && dt >= MOST_STIFF * own,
    "-vesicle_bending %g: with -fluid_viscosity %g the membrane's own time is %.3g, -time_step %g is %.1g of them; allowed: up to %g of them, by less bending, more viscosity or a smaller step",
    {scene->membrane.bending, scene->fluid.nu, own, dt, dt / own, MOST_STIFF});
}
/* clang-format on */

/* At rest, or steady in the end: scenes of the paper, whose model does them no harm (a vesicle off the middle of a
   shear flow gets the warning). */
static PetscBool FlowIsPaper(Scene scene) {
  const PetscInt type = scene->flow.type;
  return type == FLOW_QUIESCENT || type == FLOW_SHEAR || FlowIsCustom(&scene->flow);
}

/* The first of these that holds decides. */
PetscBool SceneHasInertia(Scene s, PetscReal R0, const char **why) {
  const struct {
    PetscInt holds;
    PetscBool has;
    const char *why;
  } rules[] = {{s->fluid.inertia != INERTIA_AUTO, s->fluid.inertia != INERTIA_NONE, "-fluid_inertia"},
               {FluidSpecIsFree(&s->fluid), PETSC_FALSE, "default: unbounded fluid"},
               {SceneHasContrast(s), PETSC_FALSE, "default: two viscosities"},
               {s->obstacles.shape != OBSTACLE_NONE, PETSC_FALSE, "default: obstacles"},
               {SceneIsProjection(s), PETSC_TRUE, "default of split and penalty"},
               {R0 == 0, PETSC_TRUE, "default without vesicles"},
               {FlowIsCustom(&s->flow), PETSC_TRUE, "default of a flow of your own"},
               {FlowIsPaper(s), PETSC_TRUE, "default at rest and in shear"},
               {SceneReynolds(s, R0) < SMALL_REYNOLDS, PETSC_FALSE, "default at Re below 0.01"},
               {PETSC_TRUE, PETSC_TRUE, "default at Re from 0.01 on"}},
    *rule = rules;
  while (!rule->holds) rule++;
  *why = rule->why;
  return rule->has;
}

void SceneModel(Scene s, char text[SCENE_MODEL]) {
  static const char *const names[] = {"", "quasi-steady Stokes", "unsteady Stokes",
                                      "Navier-Stokes, convection explicit"};
  (void)snprintf(text, SCENE_MODEL, "%s (%s)", names[s->fluid.inertia], s->why_inertia);
}

/* Cells between markers, from which on fluid with inertia passes between them; the default has 2. */
#define SPARSE 2.2

/* clang-format off */
/* Warn of the vesicle whose markers are the farthest apart. */
static PetscErrorCode SceneWarnOfSparse(Draft scene) {
  const Shape *shape = &scene->shape;
  PetscReal most = 0;
  PetscInt widest = 0, markers = 0;
  for (PetscInt v = 0; v < shape->vesicles; v++) {
    const PetscInt n = shape->start[v + 1] - shape->start[v];
    const PetscReal apart = 2 * PETSC_PI * ShapeRadius(shape, v) / n / FluidSpecCellSize(&scene->fluid);
    if (apart <= most) continue;
    most = apart;
    widest = v;
    markers = n;
  }
  const SceneRule rules[] = {
    {scene->fluid.inertia != INERTIA_NONE && !SceneIsProjection(scene) && most > SPARSE,
     "%.0f markers of vesicle %.0f are %.2g cells apart: with inertia the fluid passes between markers more than 2 cells apart, and small steps do not converge; take -vesicle_markers %.0f", {markers, widest + 1, most, (PetscInt)PetscCeilReal(markers * most / 2) | 1}}};
  return SCENE_TEXT(scene, rules, scene->warning);
}

PetscErrorCode SceneChooseInertia(Draft scene) {
  const PetscReal carried = SceneCarriedReynolds(scene), R0 = SceneLargestRadius(scene);
  const PetscBool custom = FlowIsCustom(&scene->flow);
  const PetscBool baseline = SceneIsProjection(scene), inertia = SceneHasInertia(scene, R0, &scene->why_inertia);
  PetscBool seamless;
  int dir;
  PetscFunctionBeginUser;
  PetscCall(SceneCheckStiffness(scene));
  seamless = FlowIsSeamless(scene, &dir);
  /* A copy beyond a periodic boundary moves as its vesicle does. Where the flow there is another one, the copies of a
     packing, which fills the box, run into vesicles at once. */
  PetscCall(SCENE_REFUSE_IF(scene, !seamless && scene->vesicles.packing > 0,
    "-vesicle_packing {-vesicle_packing}: the background flow is not periodic in %c, so vesicles and the copies of others across that boundary would run into each other; allowed: -domain_bc_%c wall", {"xy"[dir % 2], "xy"[dir % 2]}));
  scene->reynolds = SceneReynolds(scene, R0);
  if (scene->fluid.inertia == INERTIA_AUTO) {
    const PetscBool carries = !baseline && R0 > 0 && !FlowIsPaper(scene) && scene->scheme.order > 1 && seamless;
    scene->fluid.inertia = !inertia ? INERTIA_NONE : carries ? INERTIA_CONVECTIVE : INERTIA_UNSTEADY;
  }
  PetscCall(SCENE_REFUSE_IF(scene, !seamless && scene->fluid.inertia == INERTIA_CONVECTIVE,
    "-fluid_inertia convective: the background flow is not periodic in %c, so it cannot carry the disturbance across that boundary; allowed: -domain_bc_%c wall, or -fluid_inertia none or unsteady", {"xy"[dir % 2], "xy"[dir % 2]}));
  const SceneRule astray[] = {
    {scene->fluid.inertia == INERTIA_UNSTEADY && !(scene->reynolds <= CARRIED_REYNOLDS) && carried > CARRIED_REYNOLDS,
     "-fluid_inertia unsteady at Re = %.3g with a vesicle that the flow carries along: without convection the flow is not Galilean invariant, the vesicle drags the fluid that it displaces behind it and may drift the wrong way; use %s%s",
     {custom ? carried : scene->reynolds}, {custom ? "none" : "convective", baseline ? " with -scheme_type coupled" : ""}}};
  PetscCall(SCENE_TEXT(scene, astray, scene->warning));
  if (!*scene->warning) PetscCall(SceneWarnOfSparse(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */
