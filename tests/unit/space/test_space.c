/* Vesicles in three dimensions: what they do to one another, and what a step solves for. */
#include "facts.h"
#include "space/space.h"
#include "sphere/shape.h"

#define ONE PetscSqrtReal(4 * PETSC_PI) /* the coefficient of 1 */

/* Two surfaces, each of one rank, and the layers between them; what ranks have of both stands in the front. */
typedef struct {
  Sphere sphere;
  CrossLayer cross;
  PetscInt count, size, first, own;
  PetscReal nu, *all; /* [2][size] */
} Pair;

static void PairDestroy(Pair *q) {
  TestCall(CrossLayerDestroy(&q->cross));
  TestCall(SphereDestroy(&q->sphere));
}
TestScoped(Sphere, SphereDestroy);
TestScoped(Surface, SurfaceDestroy);
TestScoped(Space, SpaceDestroy);
#define ScopedPair __attribute__((cleanup(PairDestroy))) Pair

static void PairCreate(PetscInt p, Contact3Law law, PetscReal fine, Pair *q) {
  PetscMPIInt rank, ranks;
  TestCall(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  TestCall(MPI_Comm_size(PETSC_COMM_WORLD, &ranks));
  const PetscInt count = HarmonicsCount(p), first = 2 * rank / ranks, own = 2 * (rank + 1) / ranks - first;
  *q = (Pair){.count = count, .size = 3 * count, .first = first, .own = own, .nu = 0.7, .all = TestReals(6 * count)};
  TestCall(SphereCreate(p, SPHERE_WHOLE, &q->sphere));
  TestCall(CrossLayerCreate(q->sphere, (VesicleShare){PETSC_COMM_WORLD, 2, first, own}, q->nu, law, fine, &q->cross));
}

/* Spheres of radii 1 and 0.6 at the distance r along x, y or z. */
static void PlaceSpheres(Pair *q, PetscReal r, int along) {
  for (int v = 0; v < 2; v++) {
    const PetscReal a = v ? 0.6 : 1;
    SurfaceEllipsoid(q->sphere->p, (PetscReal[]){a, a, a}, q->all + v * q->size);
    q->all[v * q->size + along * q->count] += v * r * ONE;
  }
  TestCall(CrossLayerPlace(q->cross, q->all + q->first * q->size));
}

/* What coefficient k of both surfaces is on every rank. */
static void Share(const Pair *q, const PetscReal x[], PetscInt k, PetscReal value[2]) {
  for (PetscInt v = 0; v < 2; v++)
    value[v] = v >= q->first && v < q->first + q->own ? x[(v - q->first) * q->size + k] : 0;
  TestSum(2, value);
}

/* Spheres along x, where grids have their equator, or z, where they have a pole. A force F on a moves b by
   (1 + (a^2 + b^2)/(3 r^2)) F/(8 pi nu r) across, and by (2 - 2 (a^2 + b^2)/(3 r^2)) F/(8 pi nu r) along (Faxen). */
static void CheckSpheres(PetscInt p, PetscReal r, int along, PetscReal most) {
  ScopedPair q;
  PairCreate(p, (Contact3Law){0}, NEAR_KERNELS, &q);
  PlaceSpheres(&q, r, along);
  TestAbout("degree %d, spheres %g apart along %c", (int)p, r, "xyz"[along]);
  CheckBelow((q.cross->gap - (r - 1.6)) / r, 1e-2, "their gap is %.4f", q.cross->gap);
  for (int d = 0; d < 3; d++) {
    const PetscReal a2 = 1.36 / (3 * r * r), want = (d == along ? 2 - 2 * a2 : 1 + a2) / (8 * PETSC_PI * q.nu * r);
    PetscReal *F = TestReals(2 * q.size), *U = TestReals(2 * q.size), moved[2];
    if (q.first == 0 && q.own) F[d * q.count] = 1 / ONE; /* a unit force on the first sphere */
    TestCall(CrossLayerAdd(q.cross, STOKESLET, F, U));
    Share(&q, U, d * q.count, moved);
    CheckBelow(moved[1] / ONE / want - 1, most, "velocity of the other along %c, relative error", "xyz"[d]);
  }
}

/* What the flow U = A x + B of a fluid inside the first of two ellipsoids, without divergence, does to the other by its
   double layer and by the single layer of its tractions nu (A + A^T) n, which are nothing together; that of a rigid
   motion is nothing alone. apart: the distance of the centers. */
static void CheckDoubleLayer(PetscInt p, PetscReal apart, PetscReal most) {
  static const PetscReal flow[3][3][3] = {{{0, 0.5, -0.3}, {-0.5, 0, 0.8}, {0.3, -0.8, 0}},
                                          {{1, 0.2, 0}, {0.6, -0.3, 0.4}, {0, 0.7, -0.7}},
                                          {{0.3, 0, 0.9}, {-0.2, 0.5, 0}, {0, 0.1, -0.8}}};
  Scoped(Surface) surface;
  ScopedPair q;
  PairCreate(p, (Contact3Law){0}, NEAR_KERNELS, &q);
  const PetscInt count = q.count, size = q.size;
  SurfaceEllipsoid(p, (PetscReal[]){1.3, 0.9, 0.85}, q.all);
  SurfaceEllipsoid(p, (PetscReal[]){1.2, 0.8, 0.9}, q.all + size);
  ShapeAlign(count, (PetscReal[]){1, 0.3, 0.2}, (PetscReal[]){0, 0, apart}, q.all + size);
  TestCall(SurfaceCreate(q.sphere, &surface));
  TestCall(CrossLayerPlace(q.cross, q.all + q.first * size));
  TestCall(SurfacePlace(surface, q.all, PETSC_FALSE));
  const PetscInt n = surface->n;
  for (int k = 0; k < 3; k++) {
    PetscReal *f = TestReals(3 * n), *F = TestReals(2 * size), *V = TestReals(2 * size), *U = TestReals(2 * size);
    for (PetscInt i = 0; i < 3 * n; i++)
      for (int e = 0; e < 3; e++)
        f[i] += q.nu * (flow[k][i / n][e] + flow[k][e][i / n]) * surface->normal[e * n + i % n] * surface->J[i % n];
    if (q.first == 0 && q.own) {
      TestCall(SphereFieldProject(&q.sphere->fine, f, F));
      for (PetscInt i = 0; i < size; i++)
        for (int e = 0; e < 3; e++) V[i] += flow[k][i / count][e] * q.all[e * count + i % count];
      for (int d = 0; d < 3; d++) V[d * count] += 0.4 * ONE;
    }
    TestAbout("degree %d, gap %.3f, flow %d", (int)p, q.cross->gap, k);
    TestCall(CrossLayerAdd(q.cross, STRESSLET, V, U));
    if (!k) CheckBelow(TestFar(q.own * size, U, NULL), most, "double layer");
    TestCall(CrossLayerAdd(q.cross, STOKESLET, F, U));
    CheckBelow(TestFar(q.own * size, U, NULL), most, "double layer with the single one");
  }
}

/* Contact of two spheres of radii a and b, distance R, gap g below the range D: the integral of psi over both areas is
   2 pi a b/R times that of the energy of planes beyond g, K (D - g)^3/(6 D) - W (D - g) - W B/2. Its slope along the
   line of centers is the force, opposite on both. */
static void CheckContact(PetscInt p, PetscReal gap, PetscReal W, PetscReal B) {
  const PetscReal K = 2, D = 0.3, R = 1.6 + gap, small = 1e-4;
  PetscReal energy[3], force[2], stiff[2];
  ScopedPair q;
  PairCreate(p, (Contact3Law){.stress = K, .range = D, .adhesion = W, .band = B}, 1, &q);
  for (int k = 2; k >= 0; k--) { /* the second sphere a little nearer, a little farther, in its place */
    PlaceSpheres(&q, R + (k == 1 ? small : k == 2 ? -small : 0), 0);
    TestCall(CrossLayerEnergy(q.cross, &energy[k]));
  }
  PetscReal *G = TestReals(2 * q.size), *H = TestReals(2 * q.size), *change = TestReals(2 * q.size);
  for (PetscInt v = 0; v < q.own; v++) change[v * q.size] = q.first + v ? small * ONE : 0;
  TestCall(CrossLayerAddContact(q.cross, PETSC_TRUE, H, G));
  TestCall(CrossLayerAddContact(q.cross, PETSC_FALSE, change, H));
  Share(&q, G, 0, force);
  Share(&q, H, 0, stiff);
  const PetscReal planes = K * PetscPowRealInt(D - gap, 3) / (6 * D) - W * (D - gap + B / 2);
  const PetscReal exact = 2 * PETSC_PI * 0.6 / R * planes, slope = (energy[1] - energy[2]) / (2 * small);
  TestAbout("gap %g", gap);
  CheckBelow(energy[0] / exact - 1, 2e-2, "energy of contact %.6g, exact %.6g", energy[0], exact);
  CheckBelow(force[1] * ONE / slope - 1, 5e-4, "force %.6g, slope of the energy %.6g", force[1] * ONE, slope);
  CheckBelow((force[0] + force[1]) * ONE, 1e-12, "forces are opposite");
  CHECK(stiff[1] > 0 && PetscAbsReal(stiff[0] + stiff[1]) * ONE < 1e-12, "a motion apart is resisted by %.3g on both",
        stiff[1] * ONE);
}

static PetscErrorCode Shear(const void *rate, PetscReal t, PetscInt n, const PetscReal X[], PetscReal u[]) {
  for (PetscInt i = 0; i < n; i++) {
    u[i] = *(const PetscReal *)rate * X[n + i];
    u[n + i] = u[2 * n + i] = 0;
  }
  return PETSC_SUCCESS;
}

/* A space of n vesicles at X in shear. */
static void SpaceOf(PetscInt p, PetscInt n, const Vesicle3Setting material[], const PetscReal X[], int order,
                    const PetscReal *rate, Space *s) {
  const SpaceSetting setting = {.p = p,
                                .order = order,
                                .newton = order > 1 ? 2 : 1,
                                .rtol = 1e-11,
                                .flow = Shear,
                                .context = rate,
                                .policy = {.base = 0.1}};
  TestCall(SpaceCreate(PETSC_COMM_WORLD, &setting, n, material, X, s));
  TestCall(SpaceStart(*s));
}

/* Two vesicles in shear take three steps: what the rows say of the solution, and that forces do no work on M alone. */
static void CheckStep(PetscReal ratio) {
  const PetscInt p = 6, count = HarmonicsCount(p), size = 3 * count, vesicles = ratio == 1 ? 2 : 1;
  const PetscReal rate = 1, axes[3] = {1.5, 0.85, 0.8}, axis[3] = {1, 0.4, 0.1};
  PetscReal *X = TestReals(vesicles * size), error[3] = {0};
  Vesicle3Setting material[2];
  Scoped(Sphere) sphere;
  Scoped(Surface) surface;
  Scoped(Space) s;
  unsigned seed = 3;
  TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
  TestCall(SurfaceCreate(sphere, &surface));
  for (PetscInt v = 0; v < vesicles; v++) {
    SurfaceEllipsoid(p, axes, X + v * size);
    ShapeAlign(count, axis, (PetscReal[]){0, 0, v * 2.6}, X + v * size);
    material[v] = (Vesicle3Setting){.nu = 1, .bending = 0.2, .label_rate = 10, .ratio = ratio};
  }
  SpaceOf(p, vesicles, material, X, 3, &rate, &s);
  for (int step = 0; step < 3; step++) TestCall(SpaceStep(s, PETSC_MAX_REAL));
  TestAbout("ratio %g", ratio);
  CHECK(!*s->report.failure && PetscAbsReal(s->state.t - 0.3) < 1e-12, "three steps are taken");
  CHECK(s->report.its <= 16, "two solves take %d iterations", (int)s->report.its);
  const PetscInt own = s->share.own;
  PetscReal *y = TestReals(4 * count);
  for (PetscInt v = 0; v < own; v++) {
    TestCall(Vesicle3Rows(s->vesicle[v], NULL, s->state.U + v * size, y));
    TestWorse(&error[0], TestFar(count - 1, y + size + 1, NULL));
    TestCall(SurfacePlace(surface, s->state.X + v * size, PETSC_FALSE));
    TestWorse(&error[1], surface->volume / s->vesicle[v]->volume - 1);
    TestWorse(&error[2], surface->area / s->vesicle[v]->area - 1);
  }
  CheckBelow(error[0], 1e-8, "the membrane does not stretch");
  CheckBelow(error[1], 1e-10, "the volume stays");
  CheckBelow(error[2], 2e-3, "the area stays");
  if (ratio != 1) return;
  PetscReal *F = TestRandoms(2 * size, &seed), *G = TestRandoms(2 * size, &seed), *U = TestReals(2 * size),
            *V = TestReals(2 * size), work;
  TestCall(SpaceMobility(s, F, F, U));
  TestCall(SpaceMobility(s, G, G, V));
  work = TestProduct(own * size, G, U) - TestProduct(own * size, F, V);
  TestSum(1, &work);
  CheckBelow(work, 1e-12, "the mobility of all vesicles is symmetric");
}

/* Two spheres of fluid 1e5 times as viscous that sink beside one another are solid: along the line of centers they have
   the drag of Stimson and Jeffery over Stokes's, across it with s = r/a the mobility 1 + 3/(4s) + 1/(2s^3) - 17/(16s^6)
   of reflections. */
static void CheckSolidPair(PetscInt p, PetscReal s, int along, PetscReal most) {
  const PetscInt count = HarmonicsCount(p), size = 3 * count;
  const PetscReal rate = 0, alpha = PetscAcoshReal(s / 2), weight = 3;
  PetscReal *X = TestReals(2 * size), drag = 0;
  for (PetscInt n = 1; n < 200; n++) {
    const PetscReal m = 2 * (PetscReal)n + 1, over = 2 * PetscSinhReal(m * alpha) + m * PetscSinhReal(2 * alpha),
                    part = 4 * PetscSqr(PetscSinhReal(m * alpha / 2)) - PetscSqr(m * PetscSinhReal(alpha));
    drag += 4. / 3 * PetscSinhReal(alpha) * (PetscReal)(n * (n + 1)) / ((m - 2) * (m + 2)) * (1 - part / over);
  }
  for (int v = 0; v < 2; v++) {
    SurfaceEllipsoid(p, (PetscReal[]){1, 1, 1}, X + v * size);
    X[v * size + along * count] += v * s * ONE;
  }
  TestAbout("degree %d, viscous spheres %g apart along %c that sink", (int)p, s, "xyz"[along]);
  for (int d = 0; d < 3; d++) {
    const PetscReal across = 1 + 0.75 / s + 0.5 / (s * s * s) - 17. / 16 / PetscPowRealInt(s, 6);
    const PetscReal want = d == along ? 1 / drag : across;
    Vesicle3Setting one = {.nu = 0.7, .bending = 0.2, .label_rate = 1, .ratio = 1e5};
    PetscReal sinking[2] = {0};
    Scoped(Space) space;
    one.weight[d] = weight;
    SpaceOf(p, 2, (Vesicle3Setting[]){one, one}, X, 1, &rate, &space);
    for (PetscInt v = 0; v < space->share.own; v++)
      sinking[space->share.first + v] = space->state.U[v * size + d * count] / ONE / (weight * 2 / (9 * 0.7));
    TestSum(2, sinking);
    CheckBelow(sinking[0] / want - 1, most, "along %c are %.6f times as fast as one, solid ones %.6f", "xyz"[d],
               sinking[0], want);
    CheckBelow(sinking[1] / sinking[0] - 1, 1e-4, "both are equally fast");
  }
}

static void CheckShapes(void) {
  for (int q = 0; q < 6; q++) {
    const PetscReal v = 0.6 + 0.07 * q;
    const PetscBool oblate = q % 2;
    const PetscInt p = 8, size = 3 * HarmonicsCount(p);
    PetscReal along, across, *X = TestReals(size), tilted[3] = {0.2, -0.5, 0.7}, center[3] = {1, 2, -3}, off = 0;
    Scoped(Sphere) sphere;
    Scoped(Surface) surface;
    ShapeMoments m;
    ShapeSpheroid(v, oblate, 1.1, &along, &across);
    SurfaceEllipsoid(p, (PetscReal[]){along, across, across}, X);
    ShapeAlign(size / 3, tilted, center, X);
    TestCall(SphereCreate(p, SPHERE_WHOLE, &sphere));
    TestCall(SurfaceCreate(sphere, &surface));
    TestCall(SurfacePlace(surface, X, PETSC_FALSE));
    TestCall(ShapeMeasure(surface, &m));
    const PetscReal found = 6 * PetscSqrtReal(PETSC_PI) * surface->volume / PetscPowReal(surface->area, 1.5);
    TestAbout("%s spheroid", oblate ? "oblate" : "prolate");
    CheckBelow(found / v - 1, 1e-4, "reduced volume %g: %.6f", v, found);
    CheckBelow(surface->volume / (4 * PETSC_PI / 3 * 1.331) - 1, 1e-12, "volume");
    const PetscReal *axis = m.direction[oblate ? 0 : 2], length = PetscSqrtReal(0.78);
    for (int d = 0; d < 3; d++) {
      TestWorse(&off, PetscAbsReal(axis[d]) - PetscAbsReal(tilted[d]) / length);
      TestWorse(&off, m.center[d] - center[d]);
    }
    CheckBelow(off, 1e-10, "axis and centre are those asked for");
    CheckBelow(m.axis[oblate ? 0 : 2] - along, 1e-10, "half axis");
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
