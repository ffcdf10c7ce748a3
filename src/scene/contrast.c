/* What two viscosities need of a scene. */
#include "scene/mixture.h"

/* The double layer is of quasi-steady flow: with inertia the inner fluid's velocity obeys another equation than the
   outer one's. It stands on the unsplit step and its near field. */
static PetscErrorCode CheckMethod(Scene scene, PetscReal ratio) {
  const PetscInt inertia = scene->fluid.inertia;
  PetscFunctionBeginUser;
  PetscCheck(!SceneIsProjection(scene), scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -scheme_type %s, which is its paper's method; allowed: 1, or "
             "-scheme_type coupled",
             (double)ratio, scene->scheme.type);
  PetscCheck(inertia == INERTIA_AUTO || inertia == INERTIA_NONE, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -fluid_inertia %s, because with inertia the fluid inside obeys "
             "another equation than the one outside; allowed: 1, or -fluid_inertia none",
             (double)ratio, inertia == INERTIA_UNSTEADY ? "unsteady" : "convective");
  PetscCheck(scene->coupling.near_field == NEAR_EXACT && !strcmp(scene->coupling.kernel, "cbs54"), scene->comm,
             PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio %g: not with -delta_type %s and this -coupling_near_field, whose sums are of "
             "cbs54 and exact; allowed: 1, or -delta_type cbs54 -coupling_near_field exact",
             (double)ratio, scene->coupling.kernel);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCheckContrast(Scene scene) {
  const RealList *ratio = &scene->membrane.viscosity_ratio;
  const PetscInt entries = scene->vesicles.kind ? scene->vesicles.mixture.n : scene->shape.vesicles;
  PetscReal other = 1;
  PetscFunctionBeginUser;
  if (!scene->shape.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCheck(ratio->n == 1 || ratio->n == entries, scene->comm, PETSC_ERR_USER_INPUT,
             "-vesicle_viscosity_ratio: %" PetscInt_FMT " numbers given for %" PetscInt_FMT
             " vesicles; allowed: one for all or one a vesicle or kind",
             ratio->n, scene->shape.vesicles);
  for (PetscInt k = 0; k < ratio->n; k++)
    if (ratio->v[k] != 1) other = ratio->v[k];
  if (!SceneHasContrast(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CheckMethod(scene, other));
  PetscFunctionReturn(PETSC_SUCCESS);
}
