/* The wall of a circular tube: the drag of a sphere on its axis, what the fluid does far from it, and other fluid
   inside of bodies. */
#include "facts.h"
#include "numerics/blas.h"
#include "space/throat.h"
#include "sphere/spherelayer.h"

TestScoped(Tube, TubeDestroy);
TestScoped(Throat, ThroatDestroy);

static Sphere sphere;
static Surface surface;

/* A tube, ready for a body of half axes `along` and a on its axis where a > 0. */
static Tube TubeOf(PetscReal R, PetscReal period, PetscReal nu, PetscReal along, PetscReal a) {
  Tube tube;
  TestCall(TubeCreate(&(TubeSetting){.radius = R, .period = period}, nu, &tube));
  if (a > 0) TestCall(TubePlace(tube, sphere->p, &(TubeExtent){R - a, along, -along, along, R - a}));
  return tube;
}

/* X = A^-1 X of a matrix of the sphere's coefficients, which is overwritten. */
static void SolveDense(PetscReal A[], PetscReal X[]) {
  PetscBLASInt *pivot = (PetscBLASInt *)TestReals(sphere->size);
  PetscBool factored;
  TestCall(DenseFactor(sphere->size, A, pivot, &factored));
  TestCall(DenseSolve(sphere->size, A, pivot, PETSC_FALSE, 1, X));
}

/* The mobility of a sphere of radius a at x, M[size][size], and its factor T. */
static void TubeSphere(Tube tube, PetscReal a, PetscReal x, PetscReal c[], PetscReal M[], PetscReal T[]) {
  for (PetscInt k = 0; k < sphere->size; k++) c[k] = 0;
  c[0] = x * PetscSqrtReal(4 * PETSC_PI);
  c[1] = a * PetscSqrtReal(4 * PETSC_PI / 3);
  c[sphere->p + 1] = a * PetscSqrtReal(8 * PETSC_PI / 3);
  TestCall(SphereSingleLayer(sphere, 1, c, M));
  TestCall(SurfacePlace(surface, c, PETSC_FALSE));
  TestCall(TubeFactor(tube, c, T, NULL));
  TestCall(TubeAddProduct(tube, sphere->size, T, 1, T, M));
}

/* Drag over 6 pi a of a sphere: the force of a motion by 1, a least eigenvalue apart, which is the pressure inside. */
static PetscReal TubeDrag(PetscReal a, PetscReal M[]) {
  PetscReal *F = TestReals(sphere->size);
  F[0] = PetscSqrtReal(4 * PETSC_PI);
  for (PetscInt k = 0; k < sphere->size; k++) M[k * (sphere->size + 1)] += 1e-12;
  SolveDense(M, F);
  return F[0] * PetscSqrtReal(4 * PETSC_PI) / (6 * PETSC_PI * a);
}

/* The pressure drop of a throat of a tube of radius 1 at the mean velocity 1. */
static PetscReal ThroatDrop(ThroatSetting setting) {
  Scoped(Tube) tube = TubeOf(1, 0, 1, 0, 0);
  Scoped(Throat) throat;
  TestCall(ThroatCreate(&setting, tube, &throat));
  TestCall(ThroatPlace(throat, sphere->p, &(TubeExtent){1, 1, 0, 0, 1}));
  return ThroatResistance(throat) / PETSC_PI;
}

/* Throats beside finite elements of second order in the velocity. A long narrow part has the drop of a tube,
   8 L (R_t^-4 - 1) at R = V = 1, more than a throat without it; 2.8 and 6 are the longest ones of these radii that a
   scene may have. */
static void CheckThroats(void) {
  static const struct {
    ThroatSetting throat;
    PetscReal drop;
  } cases[] = {{{0.5, 1, 0, 1}, 96.4531}, {{0.7, -2, 1, 1}, 49.5044}, {{0.5, 0, 0.5, 0.5}, 131.5714}};
  static const PetscReal parts[][2] = {{0.3, 2}, {0.3, 2.8}, {0.5, 6}};
  for (int k = 0; k < 3; k++) {
    const PetscReal drop = ThroatDrop(cases[k].throat), R = parts[k][0], length = parts[k][1];
    const PetscReal slope = (ThroatDrop((ThroatSetting){R, 0, length, 1}) - ThroatDrop((ThroatSetting){R, 0, 0, 1})) /
                            length;
    const PetscReal exact = 8 * (PetscPowRealInt(R, -4) - 1);
    CheckBelow(drop / cases[k].drop - 1, 2e-3, "throat %d: pressure drop %.4f, %.4f wanted", k, drop, cases[k].drop);
    CheckBelow(slope / exact - 1, 1e-2, "throat of %g, length %g: drop a length %.4f, %.4f wanted", R, length, slope,
               exact);
  }
}

/* Of a flow inside a body, by a unit force on the axis outside of it, what the wall has of its velocities and of its
   tractions is the same in each row, as in the reciprocal theorem. */
static void CheckTraction(Tube tube, PetscReal nu, const PetscReal T[], const PetscReal Theta[]) {
  const PetscInt n = surface->n, rows = TubeRowCount(tube);
  const PetscReal *X = surface->D[HARMONIC], x0 = X[0] + 0.9;
  PetscReal *u = TestReals(3 * n), *f = TestReals(3 * n), *U = TestReals(sphere->size), *F = TestReals(sphere->size),
            *row = TestReals(rows), *other = TestReals(rows);
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal d[3] = {X[i] - x0, X[n + i], 0}, r = PetscSqrtReal(d[0] * d[0] + d[1] * d[1]);
    const PetscReal along = d[0] * surface->normal[i] + d[1] * surface->normal[n + i];
    for (int k = 0; k < 2; k++) {
      u[k * n + i] = ((k ? 0 : 1 / r) + d[0] * d[k] / (r * r * r)) / (8 * PETSC_PI * nu);
      f[k * n + i] = -3 * d[0] * d[k] * along / (4 * PETSC_PI * PetscPowRealInt(r, 5)) * surface->J[i];
    }
  }
  TestCall(SphereFieldProject(&sphere->fine, u, U));
  TestCall(SphereFieldProject(&sphere->fine, f, F));
  TestCall(DenseMultAdd(PETSC_FALSE, rows, sphere->size, 1, T, F, row));
  TestCall(DenseMultAdd(PETSC_FALSE, rows, sphere->size, 1, Theta, U, other));
  CheckBelow(TestFar(rows, row, other) / TestFar(rows, row, NULL), 1e-7, "tractions of the wall's flows");
}

/* A body of fluid of another viscosity that forces pull: the sphere of a very viscous one has the drag of a solid, and
   the forces that would move the fluid outside alone as the body does have its thrust. */
static void CheckFluidInside(PetscReal R, PetscReal a, PetscReal aspect, PetscReal ratio, PetscReal drag) {
  const PetscInt size = sphere->size;
  const PetscReal nu = 0.7, along = a * aspect;
  Scoped(Tube) tube = TubeOf(R, drag > 0 ? 0 : 4, nu, along, a);
  const PetscInt rows = TubeRowCount(tube);
  PetscReal *c = TestReals(size), *S = TestReals(size * size), *K = TestReals(size * size), *T = TestReals(size * rows),
            *Theta = TestReals(size * rows), *F = TestReals(size), *U = TestReals(size), *outside = TestReals(size);
  TestAbout("a body of half axes %g and %g, viscosity %g times inside", along, a, ratio);
  SurfaceSpheroid(sphere->p, along, a, c);
  c[0] = 3 * PetscSqrtReal(4 * PETSC_PI);
  TestCall(SurfacePlace(surface, c, PETSC_FALSE));
  TestCall(SphereSingleLayer(sphere, nu, c, S));
  TestCall(SphereLayerMatrix(sphere, &Stresslet3, c, K));
  TestCall(TubeFactor(tube, c, T, Theta));
  CheckTraction(tube, nu, T, Theta);
  TestCall(TubeAddProduct(tube, size, T, 1, T, S));
  TestCall(TubeAddProduct(tube, size, T, -1, Theta, K));
  for (PetscInt k = 0; k < size * size; k++) K[k] = (1 - ratio) * K[k] + (k % (size + 1) ? 0 : (1 + ratio) / 2);
  F[0] = 1;
  F[2] = 0.3;
  F[sphere->p + 2] = -0.4;
  TestCall(DenseMultAdd(PETSC_FALSE, size, size, 1, S, F, U));
  SolveDense(K, U);
  if (drag > 0) CheckBelow(F[0] * 4 * PETSC_PI / U[0] / (6 * PETSC_PI * nu * a) / drag - 1, 1e-4, "drag %.6f", drag);
  TestCall(PetscArraycpy(outside, U, size));
  for (PetscInt k = 0; k < size; k++) S[k * (size + 1)] += 1e-12; /* the pressure inside does nothing */
  SolveDense(S, outside);
  const PetscReal thrust = TubeThrust(tube, size, T, F) + (1 - ratio) * TubeThrust(tube, size, Theta, U),
                  known = TubeThrust(tube, size, T, outside);
  CheckBelow(thrust / known - 1, 1e-5, "thrust %.8f, by forces outside %.8f", thrust, known);
}

/* Spheres on the axis have the drags of the literature. A short period lets the mean flow go, and the sphere goes with
   it. */
static void CheckSpheres(PetscReal R, const PetscReal ratio[], const PetscReal drag[]) {
  PetscReal *c = TestReals(sphere->size), *M = TestReals(sphere->size * sphere->size),
            *T = TestReals(sphere->size * 641), *F = TestReals(sphere->size), *U = TestReals(sphere->size);
  for (int q = 0; q < 4; q++) {
    const PetscReal a = ratio[q] * R;
    Scoped(Tube) tube = TubeOf(R, 0, 1, a, a);
    TubeSphere(tube, a, 3, c, M, T);
    CheckBelow(TubeDrag(a, M) / drag[q] - 1, 1e-5, "sphere of %g of the tube's radius: drag %.6f", ratio[q], drag[q]);
  }
  Scoped(Tube) tube = TubeOf(R, 1e-6, 1, 0, 0);
  TestCall(TubePlace(tube, sphere->p, &(TubeExtent){0.8 * R, 0.2 * R, 0, 0, 0.8 * R}));
  TubeSphere(tube, 0.2 * R, 0, c, M, T);
  F[0] = 1;
  const PetscReal thrust = TubeThrust(tube, sphere->size, T, F);
  TestCall(DenseMultAdd(PETSC_FALSE, sphere->size, sphere->size, 1, M, F, U));
  CheckBelow(TestProduct(sphere->size, F, U) * (8 * PETSC_PI * 1e-6) / PetscSqr(thrust) - 1, 1e-5,
             "over a short period forces drive the mean flow");
}

void Facts(void) {
  static const PetscReal ratio[] = {0.1, 0.2, 0.3, 0.5}, drag[] = {1.26321, 1.67948, 2.37009, 5.94737};
  const PetscReal R = 1.7;
  TestCall(SphereCreate(16, SPHERE_REVOLVED, &sphere));
  TestCall(SurfaceCreate(sphere, &surface));
  CheckSpheres(R, ratio, drag);
  CheckThroats();
  for (int q = 0; q < 3; q++) CheckFluidInside(R, ratio[q] * R, 1, 1e5, drag[q]);
  CheckFluidInside(R, 0.6 * R, 1.4, 5, 0);
  CheckFluidInside(R, 0.6 * R, 0.7, 0.2, 0);
  TestCall(SurfaceDestroy(&surface));
  TestCall(SphereDestroy(&sphere));
}
