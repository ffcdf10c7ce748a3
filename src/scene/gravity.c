/* What gravity and the drive of a channel need of a scene. */
#include "scene/mixture.h"

PetscReal SceneWeight(Scene scene, PetscInt vesicle, int dir) {
  const RealList *density = &scene->gravity.density;
  return ListEntry(density, 1, SceneKindOf(scene, vesicle), 0) * scene->gravity.g.v[dir];
}

PetscBool SceneHasGravity(Scene scene) {
  return scene->gravity.g.v[0] != 0 || scene->gravity.g.v[1] != 0 ? PETSC_TRUE : PETSC_FALSE;
}

PetscErrorCode SceneCheckGravity(Scene scene) {
  const RealList *g = &scene->gravity.g, *density = &scene->gravity.density;
  const PetscInt entries = scene->vesicles.kind ? scene->vesicles.mixture.n : scene->shape.vesicles;
  PetscFunctionBeginUser;
  PetscCheck(g->n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_gravity: %" PetscInt_FMT " numbers given; allowed: two, g_x,g_y", g->n);
  PetscCheck(density->n == 1 || density->n == entries, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_density_difference: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " vesicles; allowed: one for all or one a vesicle",
             density->n, scene->shape.vesicles);
  PetscCheck(!SceneHasGravity(scene) || !FluidSpecIsFree(&scene->fluid), scene->comm, PETSC_ERR_USER_INPUT,
             "-fluid_gravity %g,%g: not with -domain_bc_x free, where a body under a force has no finite velocity in "
             "two dimensions; allowed: walls, or periodic boundaries",
             (double)g->v[0], (double)g->v[1]);
  PetscCheck(scene->fluid.drive != DRIVE_FLUX || !strcmp(scene->scheme.type, "coupled"), scene->comm,
             PETSC_ERR_USER_INPUT, "-flow_drive flux: not with -scheme_type %s; allowed: pressure, or coupled",
             scene->scheme.type);
  PetscFunctionReturn(PETSC_SUCCESS);
}
