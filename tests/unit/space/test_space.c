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
  TestCall(CrossLayerCreate(sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, nu, (Contact3Law){0}, NEAR_KERNELS,
                            &cross));
  TestCall(CrossLayerPlace(cross, all + first * size));
  CHECK(PetscAbsReal(cross->gap - (r - 1.6)) < 1e-2 * r, "degree %d: the gap of spheres %g apart is %.4f", (int)p, r,
        cross->gap);
  for (int d = 0; d < 3; d++) {
    const PetscReal a2 = (radius[0] * radius[0] + radius[1] * radius[1]) / (3 * r * r),
                    want = (d == along ? 2 - 2 * a2 : 1 + a2) / (8 * PETSC_PI * nu * r);
    for (PetscInt k = 0; k < 2 * size; k++) F[k] = U[k] = sum[k] = 0;
    if (first == 0 && own) F[d * count] = 1 / one; /* a unit force on the first sphere */
    TestCall(CrossLayerAdd(cross, STOKESLET, F, U));
    for (PetscInt k = 0; k < own * size; k++) sum[first * size + k] = U[k];
    TestSum((PetscMPIInt)(2 * size), sum);
    const PetscReal off = PetscAbsReal(sum[size + d * count] / one / want - 1);
    CHECK(off < most, "degree %d, spheres %g apart along %c: velocity of the other along %c, relative error %.1e",
          (int)p, r, "xyz"[along], "xyz"[d], off);
  }
  TestCall(CrossLayerDestroy(&cross));
  TestCall(SphereDestroy(&sphere));
}

/* What the flow U = A x + B of a fluid inside the first of two ellipsoids, without divergence, does to the other by its
   double layer and by the single layer of its tractions nu (A + A^T) n, which are nothing together; that of a rigid
   motion is nothing alone. apart: the distance of the centers. */
static void CheckDoubleLayer(PetscInt p, PetscReal apart, PetscReal most) {
  static const PetscReal flow[3][3][3] = {{{0, 0.5, -0.3}, {-0.5, 0, 0.8}, {0.3, -0.8, 0}},
                                          {{1, 0.2, 0}, {0.6, -0.3, 0.4}, {0, 0.7, -0.7}},
                                          {{0.3, 0, 0.9}, {-0.2, 0.5, 0}, {0, 0.1, -0.8}}};
  const PetscInt count = HarmonicsCount(p), size = 3 * count;
  const PetscReal nu = 0.7, one = PetscSqrtReal(4 * PETSC_PI);
  PetscMPIInt rank, ranks;
  Sphere sphere;
  Surface surface;
  CrossLayer cross;
  TestCall(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  const PetscInt first = 2 * rank / ranks, own = 2 * (rank + 1) / ranks - first;
  PetscReal *all = TestReals(2 * size);
  SurfaceEllipsoid(p, (PetscReal[]){1.3, 0.9, 0.85}, all);
  SurfaceEllipsoid(p, (PetscReal[]){1.2, 0.8, 0.9}, all + size);
  ShapeAlign(count, (PetscReal[]){1, 0.3, 0.2}, (PetscReal[]){0, 0, apart}, all + size);
  TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
  TestCall(SurfaceCreate(sphere, &surface));
  TestCall(CrossLayerCreate(sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, nu, (Contact3Law){0}, NEAR_KERNELS,
                            &cross));
  TestCall(CrossLayerPlace(cross, all + first * size));
  TestCall(SurfacePlace(surface, all, PETSC_FALSE));
  const PetscInt n = surface->n;
  PetscReal *f = TestReals(3 * n), *F = TestReals(2 * size), *V = TestReals(2 * size), *U = TestReals(2 * size);
  for (int q = 0; q < 3; q++) {
    PetscReal off[2] = {0};
    for (PetscInt k = 0; k < 2 * size; k++) F[k] = V[k] = U[k] = 0;
    for (PetscInt i = 0; i < n; i++)
      for (int d = 0; d < 3; d++) {
        f[d * n + i] = 0;
        for (int e = 0; e < 3; e++)
          f[d * n + i] += nu * (flow[q][d][e] + flow[q][e][d]) * surface->normal[e * n + i] * surface->J[i];
      }
    if (first == 0 && own) {
      TestCall(SphereFieldProject(&sphere->fine, f, F));
      for (int d = 0; d < 3; d++) {
        for (int e = 0; e < 3; e++)
          for (PetscInt k = 0; k < count; k++) V[d * count + k] += flow[q][d][e] * all[e * count + k];
        V[d * count] += 0.4 * one;
      }
    }
    TestCall(CrossLayerAdd(cross, STRESSLET, V, U));
    for (PetscInt k = 0; k < own * size; k++) off[0] = PetscMax(off[0], PetscAbsReal(U[k]));
    TestCall(CrossLayerAdd(cross, STOKESLET, F, U));
    for (PetscInt k = 0; k < own * size; k++) off[1] = PetscMax(off[1], PetscAbsReal(U[k]));
    TestMost(2, off);
    CHECK(off[1] < most && (q || off[0] < most),
          "degree %d, gap %.3f, flow %d: double layer %.1e, with the single one %.1e", (int)p, cross->gap, q, off[0],
          off[1]);
  }
  TestCall(CrossLayerDestroy(&cross));
  TestCall(SurfaceDestroy(&surface));
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
  TestCall(CrossLayerCreate(sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, 1, law, 1, &cross));
  for (int k = 2; k >= 0; k--) { /* the second sphere a little nearer, a little farther, in its place */
    SurfaceEllipsoid(p, (PetscReal[]){a, a, a}, all);
    SurfaceEllipsoid(p, (PetscReal[]){b, b, b}, all + size);
    all[size] += (R + (k == 1 ? small : k == 2 ? -small : 0)) * one;
    TestCall(CrossLayerPlace(cross, all + first * size));
    TestCall(CrossLayerEnergy(cross, &energy[k]));
  }
  for (PetscInt k = 0; k < 2 * size; k++) G[k] = change[k] = 0;
  TestCall(CrossLayerAddContact(cross, PETSC_TRUE, change, G));
  for (PetscInt v = 0; v < own; v++) change[v * size] = first + v ? small * one : 0;
  for (PetscInt v = 0; v < own; v++) force[0][first + v] = G[v * size] * one;
  for (PetscInt k = 0; k < 2 * size; k++) G[k] = 0;
  TestCall(CrossLayerAddContact(cross, PETSC_FALSE, change, G));
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
  TestCall(SpaceMobility(s, F, F, U));
  TestCall(SpaceMobility(s, G, G, V));
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

/* Two spheres of fluid 1e5 times as viscous that sink beside one another are solid: along the line of centers they have
   the drag of Stimson and Jeffery over Stokes's, across it with s = r/a the mobility 1 + 3/(4s) + 1/(2s^3) - 17/(16s^6)
   of reflections. */
static void CheckSolidPair(PetscInt p, PetscReal s, int along, PetscReal most) {
  const PetscInt count = HarmonicsCount(p), size = 3 * count;
  const PetscReal one = PetscSqrtReal(4 * PETSC_PI), rate = 0, alpha = PetscAcoshReal(s / 2), weight = 3;
  PetscReal *X = TestReals(2 * size), sinking[2] = {0}, want[3], drag = 0;
  Vesicle3Setting material[2];
  Space space;
  for (PetscInt n = 1; n < 200; n++) {
    const PetscReal m = 2 * (PetscReal)n + 1, over = 2 * PetscSinhReal(m * alpha) + m * PetscSinhReal(2 * alpha),
                    part = 4 * PetscSqr(PetscSinhReal(m * alpha / 2)) - PetscSqr(m * PetscSinhReal(alpha));
    drag += 4. / 3 * PetscSinhReal(alpha) * (PetscReal)(n * (n + 1)) / ((m - 2) * (m + 2)) * (1 - part / over);
  }
  for (int d = 0; d < 3; d++) want[d] = 1 + 0.75 / s + 0.5 / (s * s * s) - 17. / 16 / PetscPowRealInt(s, 6);
  want[along] = 1 / drag;
  for (int d = 0; d < 3; d++) {
    for (int v = 0; v < 2; v++) {
      SurfaceEllipsoid(p, (PetscReal[]){1, 1, 1}, X + v * size);
      X[v * size + along * count] += v * s * one;
      material[v] = (Vesicle3Setting){.nu = 0.7, .bending = 0.2, .label_rate = 1, .ratio = 1e5};
      material[v].weight[d] = weight;
    }
    const SpaceSetting setting = {
        .p = p, .order = 1, .newton = 1, .rtol = 1e-11, .flow = Shear, .context = &rate, .policy = {.base = 0.1}};
    TestCall(SpaceCreate(PETSC_COMM_WORLD, &setting, 2, material, X, &space));
    TestCall(SpaceStart(space));
    for (PetscInt v = 0; v < 2; v++) sinking[v] = 0;
    for (PetscInt v = 0; v < space->share.own; v++)
      sinking[space->share.first + v] = space->state.U[v * size + d * count] / one / (weight * 2 / (9 * 0.7));
    TestSum(2, sinking);
    CHECK(PetscAbsReal(sinking[0] / want[d] - 1) < most && PetscAbsReal(sinking[1] / sinking[0] - 1) < 1e-4,
          "degree %d, viscous spheres %g apart along %c sink along %c %.6f times as fast as one, solid ones %.6f",
          (int)p, s, "xyz"[along], "xyz"[d], sinking[0], want[d]);
    TestCall(SpaceDestroy(&space));
  }
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
  for (PetscInt p = 8; p <= 12; p += 4)
    for (int q = 0; q < 6; q++) CheckDoubleLayer(p, 1.75 + 0.04 * (1 << q), p == 8 ? 3e-3 : 1.5e-3);
  CheckContact(8, 0.2, 0, 0);
  CheckContact(8, 0.08, 0, 0);
  CheckContact(8, 0.2, 0.3, 0.3);
  CheckSolidPair(8, 4, 0, 1e-4);
  CheckSolidPair(8, 6, 2, 1e-4);
  CheckStep(1);
  CheckStep(5);
}
