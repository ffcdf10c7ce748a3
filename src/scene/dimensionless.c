/* Flows given by dimensionless numbers: what they stand for. */
#include "scene/resolve.h"

/* What a number stands for: `unit` c_b/(nu R0^power), of the largest vesicle. */
static PetscErrorCode Choose(Draft scene, const char name[], PetscReal number, const char stands_for[], int power,
                             PetscReal *value) {
  const PetscReal R0 = scene->shape.longest / (2 * PETSC_PI);
  PetscFunctionBeginUser;
  PetscCheck(!SceneGiven(scene, stands_for), scene->comm, PETSC_ERR_USER_INPUT,
             "%s %g: given together with %s; allowed: one of them", name, (double)number, stands_for);
  PetscCheck(R0 > 0 && scene->membrane.bending > 0, scene->comm, PETSC_ERR_USER_INPUT,
             "%s %g: without vesicles that bend there is no time nu R0^3/c_b; allowed: vesicles with -vesicle_bending "
             "above 0, or %s",
             name, (double)number, stands_for);
  *value = number * scene->membrane.bending / (scene->fluid.nu * PetscPowRealInt(R0, power));
  PetscCheck(!PetscIsInfOrNanReal(*value), scene->comm, PETSC_ERR_USER_INPUT,
             "%s %g: stands for a %s of %g; allowed: a finite one", name, (double)number, stands_for + 1,
             (double)*value);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneChooseFlow(Draft scene) {
  Flow *flow = &scene->flow;
  const PetscBool strain = flow->type == FLOW_SHEAR || flow->type == FLOW_EXTENSION ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (strain && SceneGiven(scene, "-flow_chi"))
    PetscCall(Choose(scene, "-flow_chi", flow->chi, "-flow_rate", 3, &flow->rate));
  if (flow->type == FLOW_POISEUILLE && SceneGiven(scene, "-flow_ca"))
    PetscCall(Choose(scene, "-flow_ca", flow->ca, "-flow_peak_velocity", 2, &flow->peak));
  PetscFunctionReturn(PETSC_SUCCESS);
}
