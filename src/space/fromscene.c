#include "space/fromscene.h"
#include "scene/flow3.h"
#include "sphere/shape.h"

static PetscErrorCode SceneFlow3(const void *flow, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  PetscFunctionBeginUser;
  PetscCall(Flow3Velocities((const Flow *)flow, t, n, X, u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Coefficients of a vesicle's first shape. */
static void SceneFirstShape(Scene s, PetscInt v, PetscReal X[]) {
  const SceneSpace *own = &s->space;
  PetscReal axes[3], axis[3], center[3];
  for (int d = 0; d < 3; d++) {
    axes[d] = ListEntry(&own->half_axes, 3, v, d);
    axis[d] = ListEntry(&own->axis, 3, v, d);
    center[d] = ListEntry(&s->vesicles.center, 3, v, d);
  }
  if (!SceneGiven(s, "-vesicle_half_axes")) {
    ShapeSpheroid(ListEntry(&own->reduced_volume, 1, v, 0), own->oblate ? PETSC_TRUE : PETSC_FALSE,
                  ListEntry(&own->radius, 1, v, 0), &axes[0], &axes[1]);
    axes[2] = axes[1];
  }
  SurfaceEllipsoid(own->degree, axes, X);
  ShapeAlign(HarmonicsCount(own->degree), axis, center, X);
}

PetscErrorCode SpaceFromScene(Scene s, Space *space) {
  const PetscInt count = s->vesicles.count, size = 3 * HarmonicsCount(s->space.degree);
  const SpaceSetting setting = {.p = s->space.degree,
                                .order = s->scheme.order,
                                .newton = s->space.newton,
                                .rtol = 1e-8,
                                .flow = SceneFlow3,
                                .context = &s->flow,
                                .policy = {.adaptive = (PetscBool)(s->time.adapt == ADAPT_ERROR),
                                           .base = s->time.dt,
                                           .tolerance = s->time.adapt_tol,
                                           .max_step = s->time.adapt_max_step},
                                .repulsion = {.stress = s->repulsion.stress, .range = s->repulsion.range}};
  Vesicle3Setting *material;
  PetscReal *X;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(count, &material, count * size, &X));
  for (PetscInt v = 0; v < count; v++) {
    SceneFirstShape(s, v, X + v * size);
    material[v] = (Vesicle3Setting){.nu = s->fluid.nu,
                                    .bending = ListEntry(&s->membrane.stiffness, 1, v, 0),
                                    .label_rate = s->space.label_rate,
                                    .ratio = SceneViscosityRatio(s, v)};
    for (int d = 0; d < 3; d++) material[v].weight[d] = SceneWeight(s, v, d);
  }
  PetscCall(SpaceCreate(s->comm, &setting, count, material, X, space));
  PetscCall(PetscFree2(material, X));
  if (!(*space)->cross) PetscFunctionReturn(PETSC_SUCCESS);
  const CrossLayer cross = (*space)->cross;
  PetscCall(CrossLayerMeasure(cross, (*space)->state.X));
  PetvesCheck(cross->gap > 0, s->comm,
              "-vesicle_center: vesicles %" PetscInt_FMT " and %" PetscInt_FMT
              " overlap by %.3g; allowed: centers farther from one another",
              cross->nearest[0] + 1, cross->nearest[1] + 1, (double)-cross->gap);
  PetscFunctionReturn(PETSC_SUCCESS);
}
