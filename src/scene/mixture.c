/* Lists with an entry for all, a vesicle or a kind. */
#include "scene/mixture.h"

PetscReal ListEntry(const RealList *list, PetscInt each, PetscInt entry, PetscInt component) {
  return list->v[list->n > each ? each * entry + component : component];
}

PetscInt SceneKindOf(Scene scene, PetscInt v) {
  return scene->vesicles.kind ? scene->vesicles.kind[v] : v;
}

PetscErrorCode SceneMixKinds(Draft scene) {
  const RealList *part = &scene->vesicles.mixture;
  const PetscInt n = scene->vesicles.count;
  PetscInt *have;
  PetscFunctionBeginUser;
  if (part->n < 2 || scene->vesicles.shape >= SHAPE_FILE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &scene->vesicles.kind));
  PetscCall(PetscCalloc1(part->n, &have));
  for (PetscInt v = 0; v < n; v++) {
    PetscInt next = 0;
    for (PetscInt k = 1; k < part->n; k++)
      if (part->v[k] * (v + 1) - have[k] > part->v[next] * (v + 1) - have[next] + 1e-9) next = k;
    have[next]++;
    scene->vesicles.kind[v] = next;
  }
  PetscCall(PetscFree(have));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SceneViscosityRatio(Scene scene, PetscInt v) {
  return ListEntry(&scene->membrane.viscosity_ratio, 1, SceneKindOf(scene, v), 0);
}

PetscBool SceneHasContrast(Scene scene) {
  const RealList *ratio = &scene->membrane.viscosity_ratio;
  for (PetscInt k = 0; k < ratio->n && scene->vesicles.shape != SHAPE_NONE; k++)
    if (ratio->v[k] != 1) return PETSC_TRUE;
  return PETSC_FALSE;
}
