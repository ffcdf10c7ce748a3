/* The times of a scene: of its flow and of its membranes. */
#include "scene/resolve.h"

/* From here on the largest step falls more slowly than 1/chi: .125 over the rate at chi = 1000. */
#define MOST_CHI 250

/* The fastest rate at which the flow shears a vesicle. */
static PetscReal Rate(Scene scene) {
  const Flow *flow = &scene->flow;
  if (flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION) return PetscAbsReal(flow->rate);
  if (flow->type == FLOW_POISEUILLE) return 2 * PetscAbsReal(flow->peak) / flow->half_width;
  return 0;
}

PetscReal SceneSmallestRadius(Scene scene) {
  PetscReal R0 = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) R0 = PetscMin(R0, ShapeRadius(&scene->shape, v));
  return R0;
}

PetscReal SceneMembraneTime(Scene scene, PetscInt v) {
  const PetscReal c_b = scene->membrane.each[v];
  return c_b > 0 ? scene->fluid.nu * PetscPowRealInt(ShapeRadius(&scene->shape, v), 3) / c_b : PETSC_MAX_REAL;
}

static PetscReal ShortestMembraneTime(Scene scene) {
  PetscReal time = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) time = PetscMin(time, SceneMembraneTime(scene, v));
  return time;
}

void SceneTimes(Scene scene, PetscReal *slow, PetscReal *fast) {
  const PetscReal rate = Rate(scene);
  *slow = ShortestMembraneTime(scene);
  *fast = rate > 0 ? PetscMin(*slow, 1 / rate) : *slow;
}

PetscReal SceneFlowStep(Scene scene) {
  const PetscReal rate = Rate(scene);
  PetscReal largest = 0;
  if (rate == 0) return PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) largest = PetscMax(largest, SceneMembraneTime(scene, v));
  return 1 / (rate * (1 + 0.03 * PetscMin(rate * largest, MOST_CHI)));
}

/* Of a fluid at rest; a flow has steps of its own. */
static PetscReal MembraneTimeAtRest(Scene scene) {
  return Rate(scene) == 0 ? ShortestMembraneTime(scene) : PETSC_MAX_REAL;
}

PetscErrorCode SceneChooseLargestStep(Draft scene) {
  PetscReal most = SceneFlowStep(scene);
  char value[64];
  PetscFunctionBeginUser;
  if (scene->time.adapt == ADAPT_NONE || !scene->shape.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->scheme.wanted > 0) PetscFunctionReturn(PETSC_SUCCESS); /* has its own */
  if (scene->flow.type != FLOW_CUSTOM) most = PetscMin(most, MembraneTimeAtRest(scene));
  if (most == PETSC_MAX_REAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(value, sizeof(value), "%.6g", (double)most));
  PetscCall(SceneChoose(scene, "-time_adapt_max_step", value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MOST_FRAMES 100

PetscErrorCode SceneChooseOutput(Draft scene) {
  static const int steps[3] = {1, 2, 5};
  const PetscReal least = scene->time.end / (MOST_FRAMES - 1) * (1 - 1e-12);
  char value[64] = "";
  PetscFunctionBeginUser;
  if (scene->output.every >= least) PetscFunctionReturn(PETSC_SUCCESS); /* 0.1 */
  for (int k = -1; !*value; k++)
    for (int s = 0; s < 3 && !*value; s++)
      if (steps[s] * PetscPowRealInt(10, k) >= least)
        PetscCall(PetscSNPrintf(value, sizeof(value), "%de%d", steps[s], k));
  PetscCall(SceneChoose(scene, "-output_every", value));
  PetscFunctionReturn(PETSC_SUCCESS);
}
