/* Bodies of revolution on one meridian are those of the whole sphere, in the coefficients that they have. */
#include "facts.h"
#include "numerics/blas.h"
#include "sphere/shape.h"
#include "sphere/spherelayer.h"

TestScoped(Sphere, SphereDestroy);
TestScoped(Surface, SurfaceDestroy);

/* Any smooth body of revolution. */
static PetscReal *RevolvedSurface(Sphere s) {
  PetscReal *c = TestReals(s->size);
  unsigned seed = 5;
  for (PetscInt k = 1; k < s->size; k++) c[k] = TestRandom(&seed) / PetscPowReal(5, (PetscReal)s->degree[k]);
  c[1] += 2.4;
  c[s->p + 1] += 1.9;
  return c;
}

/* R[size][size] = E^T M E of M on the whole sphere, E the unfolding. */
static PetscReal *Restricted(Sphere revolved, PetscInt whole, const PetscReal M[]) {
  PetscReal *E = TestReals(whole * revolved->size), *R = TestReals(revolved->size * revolved->size),
            *unit = TestReals(revolved->size), *column = TestReals(whole);
  for (PetscInt l = 0; l < revolved->size; l++) {
    for (PetscInt k = 0; k < revolved->size; k++) unit[k] = k == l;
    SphereUnfold(revolved, 3, unit, E);
    for (PetscInt k = 0; k < whole; k++) column[k] = 0;
    TestCall(DenseMultAdd(PETSC_FALSE, whole, whole, 1, M, E, column));
    SphereFold(revolved, column, R + l * revolved->size);
  }
  return R;
}

static void CheckRevolved(PetscInt p) {
  Scoped(Sphere) one, all;
  Scoped(Surface) meridian, surface;
  TestCall(SphereCreate(p, SPHERE_REVOLVED, &one));
  TestCall(SphereCreate(p, SPHERE_WHOLE, &all));
  TestCall(SurfaceCreate(one, &meridian));
  TestCall(SurfaceCreate(all, &surface));
  PetscReal *c = RevolvedSurface(one), *whole = TestReals(all->size), *folded = TestReals(one->size),
            *M = TestReals(all->size * all->size), *m = TestReals(one->size * one->size);
  SphereUnfold(one, 3, c, whole);
  SphereFold(one, whole, folded);
  TestAbout("body of revolution of degree %d", (int)p);
  CheckBelow(TestFar(one->size, folded, c), 1e-15, "what is unfolded folds back");
  TestCall(SurfacePlace(meridian, c, PETSC_TRUE));
  TestCall(SurfacePlace(surface, whole, PETSC_TRUE));
  CheckBelow(meridian->area / surface->area - 1, 1e-13, "area");
  CheckBelow(meridian->volume / surface->volume - 1, 1e-13, "volume");
  CheckBelow(meridian->energy / surface->energy - 1, 1e-12, "energy");
  ShapeMoments moments[2];
  TestCall(ShapeMeasure(meridian, &moments[0]));
  TestCall(ShapeMeasure(surface, &moments[1]));
  CheckBelow(TestFar(3, moments[0].axis, moments[1].axis), 1e-13, "axes");
  CheckBelow(TestFar(3, moments[0].center, moments[1].center), 1e-13, "middle");
  for (int q = 0; q < 4; q++) {
    static const char *const what[] = {"single layer", "double layer", "bending", "normals"};
    const Kernel3 *kernel = q ? &Stresslet3 : &Stokeslet3;
    if (q < 2) TestCall(SphereLayerMatrix(one, kernel, c, m));
    if (q < 2) TestCall(SphereLayerMatrix(all, kernel, whole, M));
    if (q >= 2) TestCall((q == 2 ? SurfaceBending : SurfaceNormals)(meridian, m));
    if (q >= 2) TestCall((q == 2 ? SurfaceBending : SurfaceNormals)(surface, M));
    CheckBelow(TestFar(one->size * one->size, m, Restricted(one, all->size, M)) /
                   TestFar(one->size * one->size, m, NULL),
               1e-12, "%s", what[q]);
  }
}

void Facts(void) {
  CheckRevolved(6);
  CheckRevolved(10);
}
