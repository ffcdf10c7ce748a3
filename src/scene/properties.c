#include "scene/properties.h"

PetscInt SceneKindOf(Scene scene, PetscInt v) {
  return scene->vesicles.kind ? scene->vesicles.kind[v] : v;
}

CurveRoom SceneRoom(Scene scene) {
  const FluidSpec *f = &scene->fluid;
  CurveRoom room;
  for (int k = 0; k < 4; k++) room.box[k] = f->box[k];
  FluidSpecPeriods(f, room.period);
  for (int d = 0; d < 2; d++) room.wall[d] = f->bc[d] == BC_WALL;
  return room;
}

PetscBool SceneByArea(Scene scene) {
  const PetscBool packed = scene->vesicles.packing > 0 && !SceneGiven(scene, "-vesicle_semi_axes");
  if (scene->vesicles.shape == SHAPE_BICONCAVE) return PETSC_TRUE;
  return SceneGiven(scene, "-vesicle_area") || SceneGiven(scene, "-vesicle_reduced_area") || packed;
}

PetscBool SceneHasGravity(Scene scene) {
  for (PetscInt d = 0; d < scene->gravity.g.n; d++)
    if (scene->gravity.g.v[d] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscReal SceneWeight(Scene scene, PetscInt vesicle, int dir) {
  return ListEntry(&scene->gravity.density, 1, SceneKindOf(scene, vesicle), 0) * scene->gravity.g.v[dir];
}

PetscBool SceneHasContrast(Scene scene) {
  const RealList *ratio = &scene->membrane.viscosity_ratio;
  for (PetscInt k = 0; k < ratio->n && scene->vesicles.shape != SHAPE_NONE; k++)
    if (ratio->v[k] != 1) return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscReal SceneViscosityRatio(Scene scene, PetscInt v) {
  return ListEntry(&scene->membrane.viscosity_ratio, 1, SceneKindOf(scene, v), 0);
}

PetscBool SceneIsProjection(Scene scene) {
  const char *const name = scene->scheme.type;
  return !strcmp(name, "split") || !strcmp(name, "penalty");
}

PetscBool SceneHasAreaTarget(Scene scene) {
  const PetscBool papers = scene->membrane.derivative == DERIVATIVE_FD || SceneIsProjection(scene);
  return scene->shape.vesicles && !papers && scene->membrane.permeability == 0;
}

PetscBool SceneHasBoxPart(Scene scene) {
  const FluidSpec *f = &scene->fluid;
  if (!scene->coupling.box_part || scene->coupling.near_field != NEAR_EXACT || FluidSpecIsFree(f)) return PETSC_FALSE;
  for (int d = 0; d < 2; d++)
    if (f->bc[d] == BC_PERIODIC && f->cells[d] > FLUID_LONGEST_PERIOD * f->cells[1 - d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscReal SceneSmallestRadius(Scene scene) {
  PetscReal R0 = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) R0 = PetscMin(R0, ShapeRadius(&scene->shape, v));
  return R0;
}

PetscReal SceneLargestRadius(Scene scene) {
  PetscReal R0 = 0;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) R0 = PetscMax(R0, ShapeRadius(&scene->shape, v));
  return R0;
}

PetscReal SceneMembraneTime(Scene scene, PetscInt v) {
  const PetscReal c_b = scene->membrane.material[v].bending;
  return c_b > 0 ? scene->fluid.nu * PetscPowRealInt(ShapeRadius(&scene->shape, v), 3) / c_b : PETSC_MAX_REAL;
}

PetscReal SceneRestTime(Scene scene) {
  PetscReal time = PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) time = PetscMin(time, SceneMembraneTime(scene, v));
  return time;
}

/* From here on the largest step falls more slowly than 1/chi: 0.125 over the rate at chi = 1000. */
#define MOST_CHI 250

PetscReal SceneFlowStep(Scene scene) {
  const PetscReal rate = FlowShearRate(&scene->flow);
  PetscReal largest = 0;
  if (rate == 0) return PETSC_MAX_REAL;
  for (PetscInt v = 0; v < scene->shape.vesicles; v++) largest = PetscMax(largest, SceneMembraneTime(scene, v));
  return 1 / (rate * (1 + 0.03 * PetscMin(rate * largest, MOST_CHI)));
}
