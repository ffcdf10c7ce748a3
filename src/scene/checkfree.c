/* Unbounded fluid: what a scene with -domain_bc_x free may ask for. */
#include "scene/resolve.h"

/* The step is dense work on the markers alone; there is no grid on which a fluid with inertia or a projection could
   be. */
static PetscErrorCode CheckMethod(Scene scene) {
  PetscFunctionBeginUser;
  PetscCheck(!strcmp(scene->scheme.type, "coupled"), scene->comm, PETSC_ERR_USER_INPUT,
             "-scheme_type %s: not with -domain_bc_x free, where no fluid is solved for on a grid; allowed: coupled",
             scene->scheme.type);
  PetscCheck(scene->coupling.near_field == NEAR_EXACT, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_near_field none: not with -domain_bc_x free, where it is all that moves the markers; allowed: "
             "exact");
  PetscCheck(scene->fluid.inertia == INERTIA_AUTO || scene->fluid.inertia == INERTIA_NONE, scene->comm,
             PETSC_ERR_USER_INPUT,
             "-fluid_inertia %s: not with -domain_bc_x free, which is quasi-steady; allowed: none",
             scene->fluid.inertia == INERTIA_UNSTEADY ? "unsteady" : "convective");
  PetscCheck(!scene->coupling.box_part, scene->comm, PETSC_ERR_USER_INPUT,
             "-coupling_box_part true: not with -domain_bc_x free, where there is no box; allowed: false");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckFree(Scene scene) {
  const PetscBool free = FluidSpecIsFree(&scene->fluid);
  PetscFunctionBeginUser;
  PetscCheck(free == (scene->fluid.bc[1] == BC_FREE), scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_bc_%c free: with a boundary in %c; allowed: free in x and y, or in neither", free ? 'x' : 'y',
             free ? 'y' : 'x');
  if (!free) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckMethod(scene));
  PetscCheck(scene->shape.vesicles <= SCENE_MOST_FREE, scene->comm, PETSC_ERR_USER_INPUT,
             "-domain_bc_x free: %" PetscInt_FMT " vesicles, every pair of which is summed; allowed: up to %d, or a "
             "large -domain_box with walls",
             scene->shape.vesicles, SCENE_MOST_FREE);
  PetscFunctionReturn(PETSC_SUCCESS);
}
