/* Which obstacles move freely, and what that needs. */
#include "scene/checks.h"
#include "scene/properties.h"
#include <stdlib.h>

/* Mark the obstacles that -obstacle_free names. */
static PetscErrorCode FreeBodiesRead(Draft scene) {
  SceneFreeBodies *own = &scene->obstacles.free;
  const PetscInt curves = scene->obstacles.outline.vesicles;
  const PetscBool all = strcmp(own->which, "all") ? PETSC_FALSE : PETSC_TRUE;
  char *end = own->which;
  PetscFunctionBeginUser;
  for (const char *p = own->which; *p && !all; p = *end ? end + 1 : end) {
    const long b = strtol(p, &end, 10);
    PetvesCheck(end != p && (*end == ',' || !*end) && b >= 1 && b <= curves, scene->comm,
                "-obstacle_free %s: %s; allowed: numbers from 1 to %" PetscInt_FMT " with commas between, or all",
                own->which, end != p && b > curves ? "there are not so many obstacles" : "not numbers of obstacles",
                curves);
    own->is[b - 1] = PETSC_TRUE;
  }
  for (PetscInt b = 0; b < curves; b++) {
    own->is[b] = own->is[b] || all;
    own->count += own->is[b];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
static PetscErrorCode FreeBodyCheck(Scene scene, PetscInt b) {
  const SceneObstacles *own = &scene->obstacles;
  const SceneFreeBodies *f = &own->free;
  const PetscBool pushed = f->force.n > 2 && (ListEntry(&f->force, 2, b, 0) != 0 || ListEntry(&f->force, 2, b, 1) != 0);
  const SceneRule held[] = {
    {pushed, "-obstacle_force {-obstacle_force}: obstacle %.0f does not move freely; allowed: 0,0 for it, or it among -obstacle_free", {b + 1}},
    {f->torque.n > 1 && ListEntry(&f->torque, 1, b, 0) != 0,
     "-obstacle_torque {-obstacle_torque}: obstacle %.0f does not move freely; allowed: 0 for it, or it among -obstacle_free", {b + 1}}};
  const SceneRule rules[] = {
    {own->outline.kind[b].type != CURVE_CLOSED,
     "-obstacle_free {-obstacle_free}: obstacle %.0f is no closed curve; allowed: closed ones", {b + 1}},
    {own->container[b],
     "-obstacle_free {-obstacle_free}: obstacle %.0f is a container of the fluid; allowed: bodies in the fluid", {b + 1}},
    {own->velocity[2 * b] != 0 || own->velocity[2 * b + 1] != 0 || own->turn[b] != 0,
     "-obstacle_free {-obstacle_free}: obstacle %.0f has a velocity or rotation given; allowed: free ones without", {b + 1}}};
  return f->is[b] ? REFUSE(scene, rules) : REFUSE(scene, held);
}

static PetscErrorCode FreeBodiesCheckScene(Scene s) {
  const SceneFreeBodies *own = &s->obstacles.free;
  const PetscInt inertia = s->fluid.inertia;
  const PetscBool strains = inertia == INERTIA_CONVECTIVE && s->flow.type == FLOW_EXTENSION;
  PetscReal sum[2] = {0, 0}, most = 0;
  for (PetscInt b = 0; b < s->obstacles.outline.vesicles; b++)
    for (int c = 0; c < 2; c++) {
      sum[c] += ListEntry(&own->force, 2, b, c);
      most = PetscMax(most, PetscAbsReal(ListEntry(&own->force, 2, b, c)));
    }
  const SceneRule rules[] = {
    {strains || (inertia != INERTIA_AUTO && inertia != INERTIA_NONE && FlowIsCustom(&s->flow)),
     "-obstacle_free {-obstacle_free}: not with -flow_type {-flow_type} and -fluid_inertia {-fluid_inertia}, which leave out how this flow itself accelerates the fluid in a body; allowed: -fluid_inertia none, or another flow"},
    {FluidSpecIsFree(&s->fluid) && PetscMax(PetscAbsReal(sum[0]), PetscAbsReal(sum[1])) > 1e-9 * most,
     "-obstacle_force {-obstacle_force}: adds up to (%g, %g) with -domain_bc_x free, where bodies under a force have no finite velocity in two dimensions; allowed: forces that add up to 0", {sum[0], sum[1]}}};
  return REFUSE(s, rules);
}
/* clang-format on */

PetscErrorCode SceneChooseFreeBodies(Draft scene) {
  const SceneFreeBodies *own = &scene->obstacles.free;
  const PetscInt curves = scene->obstacles.outline.vesicles;
  PetscFunctionBeginUser;
  PetscCall(FreeBodiesRead(scene));
  if (!own->count) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneCheckList(scene, "-obstacle_density", 1, curves, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_force", 2, curves, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_torque", 1, curves, "obstacles", "each"));
  PetscCall(FreeBodiesCheckScene(scene));
  for (PetscInt b = 0; b < curves; b++) PetscCall(FreeBodyCheck(scene, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
