/* Vesicles in three dimensions: what they do to one another, and what a step solves for. */
#include "facts.h"
#include "space/space.h"
#include "sphere/shape.h"

/* Spheres of radii a and b at a distance r along x, where grids have their equator, or z, where they have a pole. A
   force F on a moves b by (1 + (a^2 + b^2)/(3 r^2)) F/(8 pi nu r) across, and by (2 - 2 (a^2 + b^2)/(3 r^2)) F/(8 pi nu
   r) along (Faxen). */
static void CheckSpheres(PetscInt p, PetscReal r, int along, PetscReal most) {
  const PetscInt count = HarmonicsCount(p), size = 3 * count;
  const PetscReal radius[2] = {1, 0.6}, nu = 0.7, one = PetscSqrtReal(4 * PETSC_PI);
  PetscMPIInt rank, ranks;
  Sphere sphere;
  CrossLayer cross;
  TestCall(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  const PetscInt first = 2 * rank / ranks, own = 2 * (rank + 1) / ranks - first;
  PetscReal *all = TestReals(2 * size), *F = TestReals(2 * size), *U = TestReals(2 * size), *sum = TestReals(2 * size);
  for (int v = 0; v < 2; v++) {
    SurfaceEllipsoid(p, (PetscReal[]){radius[v], radius[v], radius[v]}, all + v * size);
    all[v * size + along * count] += v * r * one;
  }
  TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
  TestCall(CrossLayerCreate(sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, nu, (Contact3Law){0}, &cross));
  TestCall(CrossLayerPlace(cross, all + first * size));
  CHECK(PetscAbsReal(cross->gap - (r - 1.6)) < 1e-2 * r, "degree %d: the gap of spheres %g apart is %.4f", (int)p, r,
        cross->gap);
  for (int d = 0; d < 3; d++) {
    const PetscReal a2 = (radius[0] * radius[0] + radius[1] * radius[1]) / (3 * r * r),
                    want = (d == along ? 2 - 2 * a2 : 1 + a2) / (8 * PETSC_PI * nu * r);
    for (PetscInt k = 0; k < 2 * size; k++) F[k] = U[k] = sum[k] = 0;
    if (first == 0 && own) F[d * count] = 1 / one; /* a unit force on the first sphere */
    TestCall(CrossLayerAdd(cross, F, U));
    for (PetscInt k = 0; k < own * size; k++) sum[first * size + k] = U[k];
    TestSum((PetscMPIInt)(2 * size), sum);
    const PetscReal off = PetscAbsReal(sum[size + d * count] / one / want - 1);
    CHECK(off < most, "degree %d, spheres %g apart along %c: velocity of the other along %c, relative error %.1e",
          (int)p, r, "xyz"[along], "xyz"[d], off);
  }
  TestCall(CrossLayerDestroy(&cross));
  TestCall(SphereDestroy(&sphere));
}

/* Contact of two spheres of radii a and b, distance R, gap g below the range D: the integral of psi over both areas is
   2 pi a b/R times that of the energy of planes beyond g, K (D - g)^3/(6 D) - W (D - g) - W B/2. Its slope along the
   line of centers is the force, opposite on both. */
static void CheckContact(PetscInt p, PetscReal gap, PetscReal W, PetscReal B) {
  const PetscInt count = HarmonicsCount(p), size = 3 * count;
  const PetscReal a = 1, b = 0.6, K = 2, D = 0.3, R = a + b + gap, one = PetscSqrtReal(4 * PETSC_PI), small = 1e-4;
  const Contact3Law law = {.stress = K, .range = D, .adhesion = W, .band = B};
  PetscMPIInt rank, ranks;
  Sphere sphere;
  CrossLayer cross;
  TestCall(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  const PetscInt first = 2 * rank / ranks, own = 2 * (rank + 1) / ranks - first;
  PetscReal *all = TestReals(2 * size), *G = TestReals(2 * size), *change = TestReals(2 * size), energy[3],
            force[2][3] = {{0}};
  TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
  TestCall(CrossLayerCreate(sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, 1, law, &cross));
  for (int k = 2; k >= 0; k--) { /* the second sphere a little nearer, a little farther, in its place */
    SurfaceEllipsoid(p, (PetscReal[]){a, a, a}, all);
    SurfaceEllipsoid(p, (PetscReal[]){b, b, b}, all + size);
    all[size] += (R + (k == 1 ? small : k == 2 ? -small : 0)) * one;
    TestCall(CrossLayerPlace(cross, all + first * size));
    TestCall(CrossLayerEnergy(cross, &energy[k]));
  }
  for (PetscInt k = 0; k < 2 * size; k++) G[k] = change[k] = 0;
  for (PetscInt v = 0; v < own; v++) change[v * size] = first + v ? small * one : 0;
  TestCall(CrossLayerAddRepulsion(cross, G));
  for (PetscInt v = 0; v < own; v++) force[0][first + v] = G[v * size] * one;
  for (PetscInt k = 0; k < 2 * size; k++) G[k] = 0;
  TestCall(CrossLayerAddStiffness(cross, change, G));
  for (PetscInt v = 0; v < own; v++) force[1][first + v] = G[v * size] * one;
  TestSum(3, force[0]);
  TestSum(3, force[1]);
  const PetscReal exact = 2 * PETSC_PI * a * b / R *
                          (K * PetscPowRealInt(D - gap, 3) / (6 * D) - W * (D - gap + B / 2)),
                  slope = (energy[1] - energy[2]) / (2 * small);
  CHECK(PetscAbsReal(energy[0] / exact - 1) < 2e-2, "gap %g: energy of contact %.6g, exact %.6g", gap, energy[0],
        exact);
  CHECK(PetscAbsReal(force[0][1] / slope - 1) < 5e-4, "gap %g: force %.6g, slope of the energy %.6g", gap, force[0][1],
        slope);
  CHECK(PetscAbsReal(force[0][0] + force[0][1]) < 1e-12, "gap %g: forces are opposite, %.1e", gap,
        force[0][0] + force[0][1]);
  CHECK(force[1][1] > 0 && PetscAbsReal(force[1][0] + force[1][1]) < 1e-12,
        "gap %g: a motion apart is resisted by %.3g on both", gap, force[1][1]);
  TestCall(CrossLayerDestroy(&cross));
  TestCall(SphereDestroy(&sphere));
}

static PetscErrorCode Shear(const void *rate, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  for (PetscInt i = 0; i < n; i++) {
    u[i] = *(const PetscReal *)rate * X[n + i];
    u[n + i] = u[2 * n + i] = 0;
  }
  return PETSC_SUCCESS;
}

/* Two vesicles in shear take three steps: what the rows say of the solution, and that forces do no work on M alone. */
static void CheckStep(PetscReal ratio) {
  const PetscInt p = 6, count = HarmonicsCount(p), size = 3 * count, vesicles = ratio == 1 ? 2 : 1;
  const PetscReal rate = 1, axes[3] = {1.5, 0.85, 0.8}, axis[3] = {1, 0.4, 0.1};
  PetscReal *X = TestReals(vesicles * size), *F = TestReals(2 * size), *G = TestReals(2 * size),
            *U = TestReals(2 * size), *V = TestReals(2 * size), work[2];
  Vesicle3Setting material[2];
  Sphere sphere;
  Surface surface;
  Space s;
  unsigned seed = 3;
  TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
  TestCall(SurfaceCreate(sphere, &surface));
  for (PetscInt v = 0; v < vesicles; v++) {
    SurfaceEllipsoid(p, axes, X + v * size);
    ShapeAlign(count, axis, (PetscReal[]){0, 0, v * 2.6}, X + v * size);
    material[v] = (Vesicle3Setting){.nu = 1, .bending = 0.2, .label_rate = 10, .ratio = ratio};
  }
  const SpaceSetting setting = {
      .p = p, .order = 3, .newton = 2, .rtol = 1e-11, .flow = Shear, .context = &rate, .policy = {.base = 0.1}};
  TestCall(SpaceCreate(PETSC_COMM_WORLD, &setting, vesicles, material, X, &s));
  TestCall(SpaceStart(s));
  for (int step = 0; step < 3; step++) TestCall(SpaceStep(s, PETSC_MAX_REAL));
  CHECK(!*s->report.failure && PetscAbsReal(s->state.t - 0.3) < 1e-12, "ratio %g: three steps are taken", ratio);
  CHECK(s->report.its <= 16, "ratio %g: two solves take %d iterations", ratio, (int)s->report.its);
  const PetscInt own = s->share.own;
  PetscReal error[3] = {0}, *y = TestReals(4 * count);
  for (PetscInt v = 0; v < own; v++) {
    TestCall(Vesicle3Rows(s->vesicle[v], NULL, s->state.U + v * size, y));
    for (PetscInt k = 1; k < count; k++) error[0] = PetscMax(error[0], PetscAbsReal(y[size + k]));
    TestCall(SurfacePlace(surface, s->state.X + v * size, PETSC_FALSE));
    error[1] = PetscMax(error[1], PetscAbsReal(surface->volume / s->vesicle[v]->volume - 1));
    error[2] = PetscMax(error[2], PetscAbsReal(surface->area / s->vesicle[v]->area - 1));
  }
  TestMost(3, error);
  CHECK(error[0] < 1e-8, "ratio %g: the membrane does not stretch, %.1e", ratio, error[0]);
  CHECK(error[1] < 1e-10 && error[2] < 2e-3, "ratio %g: volume off by %.1e, area by %.1e", ratio, error[1], error[2]);
  for (PetscInt k = 0; k < own * size; k++) {
    F[k] = TestRandom(&seed);
    G[k] = TestRandom(&seed);
  }
  TestCall(SpaceMobility(s, F, U));
  TestCall(SpaceMobility(s, G, V));
  work[0] = TestProduct(own * size, G, U);
  work[1] = TestProduct(own * size, F, V);
  TestSum(2, work);
  if (ratio == 1)
    CHECK(PetscAbsReal(work[0] - work[1]) < 1e-12, "the mobility of all vesicles is symmetric, %.1e",
          work[0] - work[1]);
  TestCall(SpaceDestroy(&s));
  TestCall(SurfaceDestroy(&surface));
  TestCall(SphereDestroy(&sphere));
}

static void CheckShapes(void) {
  for (int q = 0; q < 6; q++) {
    const PetscReal v = 0.6 + 0.07 * q;
    const PetscBool oblate = q % 2 ? PETSC_TRUE : PETSC_FALSE;
    const PetscInt p = 8, size = 3 * HarmonicsCount(p);
    PetscReal along, across, *X = TestReals(size), tilted[3] = {0.2, -0.5, 0.7}, center[3] = {1, 2, -3}, off = 0;
    Sphere sphere;
    Surface surface;
    ShapeMoments m;
    ShapeSpheroid(v, oblate, 1.1, &along, &across);
    SurfaceEllipsoid(p, (PetscReal[]){along, across, across}, X);
    ShapeAlign(size / 3, tilted, center, X);
    TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
    TestCall(SurfaceCreate(sphere, &surface));
    TestCall(SurfacePlace(surface, X, PETSC_FALSE));
    TestCall(ShapeMeasure(surface, &m));
    const PetscReal found = 6 * PetscSqrtReal(PETSC_PI) * surface->volume / PetscPowReal(surface->area, 1.5);
    CHECK(PetscAbsReal(found / v - 1) < 1e-4 && PetscAbsReal(surface->volume / (4 * PETSC_PI / 3 * 1.331) - 1) < 1e-12,
          "%s spheroid of reduced volume %g: %.6f", oblate ? "oblate" : "prolate", v, found);
    const PetscReal *axis = m.direction[oblate ? 0 : 2], length = PetscSqrtReal(0.78);
    for (int d = 0; d < 3; d++)
      off = PetscMax(off, PetscMax(PetscAbsReal(PetscAbsReal(axis[d]) - PetscAbsReal(tilted[d]) / length),
                                   PetscAbsReal(m.center[d] - center[d])));
    CHECK(off < 1e-10 && PetscAbsReal(m.axis[oblate ? 0 : 2] - along) < 1e-10,
          "axis and centre are those asked for, %.1e", off);
    TestCall(SurfaceDestroy(&surface));
    TestCall(SphereDestroy(&sphere));
  }
}

void Facts(void) {
  CheckShapes();
  CheckSpheres(8, 4, 0, 1e-10);
  CheckSpheres(8, 2, 0, 1e-4);
  for (int along = 0; along < 3; along += 2) {
    CheckSpheres(8, 1.7, along, 1e-4);
    CheckSpheres(8, 1.62, along, 1e-4);
  }
  CheckContact(8, 0.2, 0, 0);
  CheckContact(8, 0.08, 0, 0);
  CheckContact(8, 0.2, 0.3, 0.3);
  CheckStep(1);
  CheckStep(5);
}
