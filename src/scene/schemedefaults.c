/* Defaults that go by the scheme. */
#include "kernel/kernel.h"
#include "scene/resolve.h"

#define LARGE_BOX 256 /* cells across: from here on the box part moves vesicles by 2e-5 of their speed at most */

PetscBool SceneIsProjection(Scene scene) {
  const char *const name = scene->scheme.type;
  return !strcmp(name, "split") || !strcmp(name, "penalty") ? PETSC_TRUE : PETSC_FALSE;
}

/* split and penalty are their papers' methods: one order, kernel ib6 and differences, none of the corrections of the
   coupled scheme; all forces of penalty are explicit. */
static PetscErrorCode ChooseProjection(Draft scene) {
  PetscFunctionBeginUser;
  PetscCall(SceneChoose(scene, "-scheme_order", "1"));
  PetscCall(SceneChoose(scene, "-delta_type", "ib6"));
  PetscCall(SceneChoose(scene, "-membrane_derivative", "fd"));
  PetscCall(SceneChoose(scene, "-coupling_near_field", "none"));
  PetscCall(SceneChoose(scene, "-scheme_area_target", "false"));
  if (!strcmp(scene->scheme.type, "penalty")) PetscCall(SceneChoose(scene, "-scheme_bending", "explicit"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscBool IsLarge(Scene scene) {
  const IntList cells = scene->domain.cells; /* not checked yet */
  return cells.n == 2 && PetscMin(cells.v[0], cells.v[1]) >= LARGE_BOX ? PETSC_TRUE : PETSC_FALSE;
}

/* It is the grid's, nothing without the rest of the near field, and small in a large box. */
PetscErrorCode SceneChooseBoxPart(Draft scene) {
  PetscFunctionBeginUser;
  if (scene->coupling.near_field == NEAR_NONE || FluidSpecIsFree(&scene->fluid) ||
      (IsLarge(scene) && scene->obstacles.shape == OBSTACLE_NONE))
    PetscCall(SceneChoose(scene, "-coupling_box_part", "false"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneChooseByScheme(Draft scene) {
  PetscFunctionBeginUser;
  if (scene->vesicles.shape == SHAPE_BICONCAVE) PetscCall(SceneChoose(scene, "-vesicle_reduced_area", "0.65"));
  if (SceneIsProjection(scene)) PetscCall(ChooseProjection(scene));
  /* labels are shifted by the spectral derivative's trigonometric polynomials, which keep the lengths of its edges */
  if (SceneIsProjection(scene) || scene->membrane.derivative != DERIVATIVE_SPECTRAL)
    PetscCall(SceneChoose(scene, "-time_frame", "none"));
  PetscCall(SceneChooseBoxPart(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether a box part can be made. */
static PetscBool IsServed(Scene scene) {
  const FluidSpec *f = &scene->fluid;
  PetscBool served = scene->coupling.near_field == NEAR_EXACT && !FluidSpecIsFree(f) ? PETSC_TRUE : PETSC_FALSE;
  for (int d = 0; d < 2; d++)
    if (f->bc[d] == BC_PERIODIC && f->cells[d] > FLUID_LONGEST_PERIOD * f->cells[1 - d]) served = PETSC_FALSE;
  return served;
}

PetscBool SceneHasBoxPart(Scene scene) {
  return scene->coupling.box_part ? IsServed(scene) : PETSC_FALSE;
}

PetscBool SceneDipolesMayBeApart(Scene scene) {
  const PetscBool refused = !scene->coupling.box_part && SceneGiven(scene, "-coupling_box_part");
  if (scene->coupling.grid_dipoles || refused || strcmp(scene->scheme.type, "coupled")) return PETSC_FALSE;
  return scene->shape.vesicles == 1 && scene->obstacles.shape == OBSTACLE_NONE ? IsServed(scene) : PETSC_FALSE;
}

PetscErrorCode SceneChooseStiffness(Draft scene) {
  const PetscReal h = FluidSpecCellSize(&scene->fluid), dt = scene->time.dt;
  const PetscReal *bound = KernelFind(scene->coupling.kernel)->spring;
  PetscFunctionBeginUser;
  if (strcmp(scene->scheme.type, "penalty") || scene->scheme.stiffness > 0) PetscFunctionReturn(PETSC_SUCCESS);
  scene->scheme.stiffness = 0.5 * (bound[0] * scene->fluid.nu * h / dt + bound[1] * h * PetscSqr(h / dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}
