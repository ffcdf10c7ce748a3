/* The wall of a circular tube: the drag of a sphere on its axis, and what the fluid does far from it. */
#include "facts.h"
#include "numerics/blas.h"
#include "space/throat.h"
#include "sphere/spherelayer.h"

static Sphere sphere;
static Surface surface;

/* The mobility of a sphere of radius a at x, M[size][size], and its factor T. */
static void TubeSphere(Tube tube, PetscReal a, PetscReal x, PetscReal c[], PetscReal M[], PetscReal T[]) {
  for (PetscInt k = 0; k < sphere->size; k++) c[k] = 0;
  c[0] = x * PetscSqrtReal(4 * PETSC_PI);
  c[1] = a * PetscSqrtReal(4 * PETSC_PI / 3);
  c[sphere->p + 1] = a * PetscSqrtReal(8 * PETSC_PI / 3);
  TestCall(SphereSingleLayer(sphere, 1, c, M));
  TestCall(SurfacePlace(surface, c, PETSC_FALSE));
  TestCall(TubeFactor(tube, c, T));
  TestCall(TubeAddMobility(tube, sphere->size, T, M));
}

/* Drag over 6 pi a of a sphere: the force of a motion by 1, a least eigenvalue apart, which is the pressure inside. */
static PetscReal TubeDrag(PetscReal a, PetscReal M[]) {
  PetscReal *F = TestReals(sphere->size);
  PetscBLASInt *pivot = (PetscBLASInt *)TestReals(sphere->size);
  PetscBool factored;
  F[0] = PetscSqrtReal(4 * PETSC_PI);
  for (PetscInt k = 0; k < sphere->size; k++) M[k * (sphere->size + 1)] += 1e-12;
  TestCall(DenseFactor(sphere->size, M, pivot, &factored));
  TestCall(DenseSolve(sphere->size, M, pivot, PETSC_FALSE, 1, F));
  return F[0] * PetscSqrtReal(4 * PETSC_PI) / (6 * PETSC_PI * a);
}

/* The pressure drop of throats of a tube of radius 1 at the mean velocity 1, beside finite elements of second order in
   the velocity. */
static void ThroatDrops(void) {
  static const struct {
    ThroatSetting throat;
    PetscReal drop;
  } cases[] = {{{0.5, 1, 0, 1}, 96.4531}, {{0.7, -2, 1, 1}, 49.5044}, {{0.5, 0, 0.5, 0.5}, 131.5714}};
  for (int k = 0; k < 3; k++) {
    Tube tube;
    Throat throat;
    PetscReal drop;
    TestCall(TubeCreate(&(TubeSetting){.radius = 1}, 1, &tube));
    TestCall(ThroatCreate(&cases[k].throat, tube, &throat));
    TestCall(ThroatPlace(throat, sphere->p, &(TubeExtent){1, 1, 0, 0, 1}));
    TestCall(ThroatFlow(throat, TestReals(TubeRowCount(tube)), &drop));
    drop /= PETSC_PI;
    CHECK(PetscAbsReal(drop / cases[k].drop - 1) < 2e-3, "throat %d: pressure drop %.4f, %.4f wanted", k, drop,
          cases[k].drop);
    TestCall(ThroatDestroy(&throat));
    TestCall(TubeDestroy(&tube));
  }
}

void Facts(void) {
  static const PetscReal ratio[] = {0.1, 0.2, 0.3, 0.5}, drag[] = {1.26321, 1.67948, 2.37009, 5.94737};
  const PetscReal R = 1.7;
  Tube tube;
  TestCall(SphereCreate(16, SPHERE_REVOLVED, &sphere));
  TestCall(SurfaceCreate(sphere, &surface));
  PetscReal *c = TestReals(sphere->size), *M = TestReals(sphere->size * sphere->size),
            *T = TestReals(sphere->size * 641), *F = TestReals(sphere->size);
  TestCall(TubeCreate(&(TubeSetting){.radius = R}, 1, &tube));
  for (int q = 0; q < 4; q++) {
    const PetscReal a = ratio[q] * R;
    TestCall(TubePlace(tube, sphere->p, &(TubeExtent){R - a, a, -a, a, R - a}));
    TubeSphere(tube, a, 3, c, M, T);
    const PetscReal D = TubeDrag(a, M);
    CHECK(PetscAbsReal(D - drag[q]) < 1e-5 * drag[q], "sphere of %g of the tube's radius: drag %.6f, %.6f wanted",
          ratio[q], D, drag[q]);
  }
  TestCall(TubeDestroy(&tube));
  TestCall(TubeCreate(&(TubeSetting){.radius = R, .period = 1e-6}, 1, &tube));
  TestCall(TubePlace(tube, sphere->p,
                     &(TubeExtent){0.8 * R, 0.2 * R, 0, 0,
                                   0.8 * R})); /* so short a period lets the mean flow go: the sphere goes with it */
  TubeSphere(tube, 0.2 * R, 0, c, M, T);
  F[0] = 1;
  PetscReal thrust, *U = TestReals(sphere->size);
  TestCall(TubeThrust(tube, surface, F, &thrust));
  TestCall(DenseMultAdd(PETSC_FALSE, sphere->size, sphere->size, 1, M, F, U));
  const PetscReal mean = thrust / (8 * PETSC_PI * 1e-6);
  CHECK(PetscAbsReal(TestProduct(sphere->size, F, U) / (mean * thrust) - 1) < 1e-5,
        "over a short period forces drive the mean flow, %.1e", TestProduct(sphere->size, F, U) / (mean * thrust) - 1);
  TestCall(TubeDestroy(&tube));
  ThroatDrops();
  TestCall(SurfaceDestroy(&surface));
  TestCall(SphereDestroy(&sphere));
}
