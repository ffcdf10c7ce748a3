/* A steady body of revolution, put into three dimensions, stays: the equations of both are the same. */
#include "facts.h"
#include "numerics/blas.h"
#include "space/space.h"
#include "sphere/shape.h"

TestScoped(Space, SpaceDestroy);

/* Extension along x. */
static PetscErrorCode AxialExtension(const void *rate, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  const PetscReal e = *(const PetscReal *)rate;
  for (PetscInt k = 0; k < 3 * n; k++) u[k] = e * X[k] * (k < n ? 1 : -0.5);
  return PETSC_SUCCESS;
}

/* The largest coefficient of the normal part of the velocity. */
static PetscReal AxialNormalSpeed(Space s) {
  PetscReal *N = TestReals(s->size * s->size), *un = TestReals(s->size);
  TestCall(SurfacePlace(s->vesicle[0]->at, s->state.X, PETSC_FALSE));
  TestCall(SurfaceNormals(s->vesicle[0]->at, N));
  TestCall(DenseMultAdd(PETSC_FALSE, s->size, s->size, 1, N, s->state.U, un));
  return TestFar(s->size, un, NULL);
}

void Facts(void) {
  const PetscReal rate = 0.2, ratio[] = {1, 4};
  for (int q = 0; q < 2; q++) {
    const SpaceSetting setting = {.p = 10,
                                  .symmetry = SPHERE_REVOLVED,
                                  .order = 2,
                                  .newton = 1,
                                  .rtol = 1e-12,
                                  .flow = AxialExtension,
                                  .context = &rate,
                                  .policy = {.base = 0.2}};
    SpaceSetting whole = setting;
    const Vesicle3Setting material = {.nu = 1, .bending = 0.3, .label_rate = 3, .ratio = ratio[q]};
    PetscReal along, across, *folded = TestReals(2 * setting.p + 1), *X = TestReals(3 * HarmonicsCount(setting.p));
    Sphere revolved;
    Scoped(Space) axial, space;
    ShapeSpheroid(0.95, PETSC_FALSE, 1, &along, &across);
    SurfaceSpheroid(setting.p, along, across, folded);
    TestCall(SphereCreate(setting.p, SPHERE_REVOLVED, &revolved));
    SphereUnfold(revolved, 3, folded, X);
    TestCall(SphereDestroy(&revolved));
    TestCall(SpaceCreate(PETSC_COMM_WORLD, &setting, 1, &material, X, &axial));
    for (PetscInt k = 0; k < 400; k++) TestCall(SpaceStep(axial, 1000));
    CheckBelow(AxialNormalSpeed(axial), 1e-7, "ratio %g: a body of revolution comes to rest", ratio[q]);
    SphereUnfold(axial->sphere, 3, axial->state.X, X);
    whole.symmetry = SPHERE_WHOLE;
    TestCall(SpaceCreate(PETSC_COMM_WORLD, &whole, 1, &material, X, &space));
    TestCall(SpaceStart(space));
    CheckBelow(AxialNormalSpeed(space), 1e-6, "ratio %g: and stays in three dimensions", ratio[q]);
  }
}
