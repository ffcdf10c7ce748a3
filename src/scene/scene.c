/* A scene resolved from its options: all defaults in one order. */
#include "scene/scene.h"
#include "kernel/kernel.h"
#include "scene/checks.h"
#include "scene/space.h"
#include "scene/vesicles.h"

/* Penalty's springs, where none are given: half of what the step bears. */
static void SceneChooseStiffness(Draft s) {
  const PetscReal h = FluidSpecCellSize(&s->fluid), dt = s->time.dt;
  const PetscReal *bound = KernelFind(s->coupling.kernel)->spring;
  if (strcmp(s->scheme.type, "penalty") || s->scheme.stiffness > 0) return;
  s->scheme.stiffness = 0.5 * (bound[0] * s->fluid.nu * h / dt + bound[1] * h * PetscSqr(h / dt));
}

/* The function of a caller's flow, or of formulas. */
static PetscErrorCode SceneSetFlow(Draft s, PetvesFlow flow, void *ctx) {
  PetscFunctionBeginUser;
  PetvesCheck(
      flow || s->flow.type != FLOW_CUSTOM, s->comm,
      "-flow_type custom: no function given; allowed: from Python (flow=) or C (SimulationCreateWithFlow) only");
  s->flow.function = flow;
  s->flow.ctx = ctx;
  if (s->flow.type == FLOW_FORMULA) PetscCall(FlowReadFormulas(s->comm, s->dim != DIM_PLANE ? 3 : 2, &s->flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneCreate(MPI_Comm comm, PetvesFlow flow, void *ctx, Scene *out) {
  Draft s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->comm = comm;
  s->coupling.ksp_rtol = 1e-6;
  s->vesicles.area_scale = 1;
  /* 1  what the user gives, or the table's defaults */
  PetscCall(SceneReadOptions(comm, s));
  if (s->dim != DIM_PLANE) {
    PetscCall(OptionsDepend(&s->options, s));
    PetscCall(SceneSetFlow(s, flow, ctx));
    PetscCall(SceneResolveSpace(s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  /* 2  -scheme_auto: all but box, grid and steps */
  PetscCall(SceneChooseByError(s, AUTO_FIRST));
  /* 3  defaults that depend on what is known by now */
  PetscCall(OptionsDepend(&s->options, s));
  /* 4  mistakes that involve more than one option */
  PetscCall(SceneCheck(s));
  /* 5  -scheme_auto: the box and the grid */
  PetscCall(SceneChooseByError(s, AUTO_DOMAIN));
  PetscCall(OptionsDepend(&s->options, s));
  PetscCall(SceneCheckCells(s));
  PetscCall(SceneSetFlow(s, flow, ctx));
  s->fluid.comm = s->comm;
  s->fluid.flow = &s->flow;
  for (int k = 0; k < 4; k++) s->fluid.box[k] = s->domain.box.v[k]; /* a list whose length has been checked */
  for (int d = 0; d < 2; d++) s->fluid.cells[d] = s->domain.cells.v[d];
  /* 6  the vesicles, the obstacles, the flow from numbers that go by their size, the markers with the kernel's spacing
   * if none is given
   */
  PetscCall(SceneMakeShape(s));
  PetscCall(SceneChooseMarkers(s));
  PetscCall(SceneMakeObstacles(s));
  PetscCall(SceneCheckBodies(s));
  /* 7  the steps, which go by the vesicles' size */
  PetscCall(SceneChooseByError(s, AUTO_STEPS));
  PetscCall(OptionsDepend(&s->options, s));
  s->fluid.dt = s->time.dt;
  /* 8  Reynolds number, model of the fluid, warning */
  PetscCall(SceneChooseInertia(s));
  /* 9  penalty's springs, which go by the step */
  SceneChooseStiffness(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDestroy(Scene *scene) {
  Draft s = (Draft)*scene;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FlowDropFormulas(&s->flow));
  PetscCall(PetscFree2(s->space.X, s->space.R0));
  PetscCall(SceneDropShape(s));
  PetscCall(SceneDropObstacles(s));
  PetscCall(OptionsDestroy(&s->options, s));
  PetscCall(PetscFree(s));
  *scene = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}
