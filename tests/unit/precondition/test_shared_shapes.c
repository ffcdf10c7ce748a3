/* SharedShapes of many vesicles (docs/suspensions.md, Many vesicles): how a curve lies, the exact mobility of one
   curve, and a vesicle's problem solved by another's shape. */
#include "precondition/sharedshapes.h"
#include "layers/layerpairs.h"
#include "facts.h"
#include "bodies/bending.h"

#define VESICLES 7
#define N 45 /* markers of a vesicle */

TestScoped(SharedShapes, SharedShapesDestroy);

/* Curves of one shape, each turned and with its labels shifted. */
#define OPTIONS                                                                                                        \
  EXACT "-scheme_type coupled -fluid_inertia none -delta_type cbs54 -vesicle_count 7 -vesicle_center "                 \
        "1,1,3,1,5,1,7,1,1,3,3,3,5,3 -vesicle_angle 0,10,20,40,80,120,170 -vesicle_markers 45 -domain_box 0,8,0,4 "    \
        "-vesicle_bending 0.1 "

/* Seven side by side, gaps of 1.2 cells but for the last. */
#define CLOSE                                                                                                          \
  "-domain_cells 96,48 -domain_bc_x periodic -vesicle_semi_axes 0.35,0.8 -vesicle_center "                             \
  "0.6,2,1.4,2,2.2,2,3.0,2,3.8,2,4.6,2,6.8,2 -vesicle_angle 0 -time_step 0.05 -vesicle_bending 0.5 "

static void TurnCurve(PetscReal angle, PetscInt shift, const PetscReal X[], PetscReal Y[]) {
  for (PetscInt k = 0; k < N; k++) {
    const PetscReal *x = X + 2 * ((k + shift) % N);
    Y[2 * k] = 3 + cos(angle) * x[0] - sin(angle) * x[1];
    Y[2 * k + 1] = 4 + sin(angle) * x[0] + cos(angle) * x[1];
  }
}

/* A curve without symmetry is found again wherever it lies. */
static void CheckPose(PetscReal angle, PetscInt shift) {
  PetscReal X[2 * N], Y[2 * N], x[2 * N], y[2 * N], z[2 * N], a[RIGIDFIT_SIZES], b[RIGIDFIT_SIZES], most = 0;
  for (PetscInt k = 0; k < N; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / N;
    Y[2 * k] = cos(t) + 0.1 * cos(2 * t + 1);
    Y[2 * k + 1] = 0.5 * sin(t) + 0.05 * sin(3 * t);
  }
  TurnCurve(angle, shift, Y, X);
  RigidFitCentre(N, X, x);
  RigidFitCentre(N, Y, y);
  RigidFit p = RigidFitCurves(N, PETSC_TRUE, x, y);
  CHECK((p.shift + shift) % N == 0, "labels shifted by %d are shifted back by %d", (int)shift, (int)p.shift);
  CheckBelow(fabs(p.turn[0] - cos(angle)) + fabs(p.turn[1] - sin(angle)), 1e-13, "a turn of %g is found", angle);
  CheckBelow(p.distance, 1e-7, "nothing is left");
  RigidFitInto(&p, 2, N, x, z);
  for (PetscInt k = 0; k < 2 * N; k++) TestWorse(&most, z[k] - y[k]);
  CheckBelow(most, 1e-13, "the curve is the other one in its frame");
  RigidFitBack(&p, 2, N, y, z);
  for (PetscInt k = 0; k < 2 * N; k++) TestWorse(&most, z[k] - x[k]);
  RigidFitInto(&p, 1, N, x, z);
  RigidFitBack(&p, 1, N, z, z + N);
  CHECK(most < 1e-13 && !memcmp(z + N, x, N * sizeof(*x)), "there and back, %.1e", most);
  RigidFitSizes(N, x, a);
  RigidFitSizes(N, y, b);
  CheckBelow(RigidFitLeast(a, b), 1e-13, "sizes know no turn and no labels");
  for (PetscInt k = 0; k < N; k++) x[2 * k] += k % 2 ? 0.01 : -0.01;
  p = RigidFitCurves(N, PETSC_TRUE, x, y);
  RigidFitSizes(N, x, a);
  CHECK(RigidFitLeast(a, b) > 1e-3 && RigidFitLeast(a, b) <= p.distance,
        "the distance is not less than that of the sizes");
  CHECK(fabs(p.distance - 0.01) < 5e-4, "a zigzag of 0.01 is left, %.4f", p.distance);
}

/* The best shift of random points is that of all sums, one by one. */
static void CheckFit(PetscInt n) {
  PetscReal most = -1;
  PetscInt best = 0;
  unsigned seed = (unsigned)n;
  const PetscReal *x = TestRandoms(2 * n, &seed), *y = TestRandoms(2 * n, &seed);
  for (PetscInt j = 0; j < n; j++) {
    PetscReal c[2] = {0, 0};
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal *a = x + 2 * ((k + j) % n), *b = y + 2 * k;
      c[0] += b[0] * a[0] + b[1] * a[1];
      c[1] += b[0] * a[1] - b[1] * a[0];
    }
    if (TestProduct(2, c, c) > most) best = j;
    most = PetscMax(most, TestProduct(2, c, c));
  }
  const RigidFit p = RigidFitCurves(n, PETSC_TRUE, x, y);
  CHECK(p.shift == best, "%d points: shifted by %d, the best is %d", (int)n, (int)p.shift, (int)best);
}

/* S is the near field of unbounded fluid, where that is all of the mobility. */
static void CheckSelfLayer(PetscInt n) {
  ScopedWorld t;
  PetscReal *S = TestReals(4 * n * n), *F = TestReals(2 * n), *U = TestReals(2 * n), error = 0;
  TestWorldCreate(&t,
                  EXACT "-scheme_type coupled -delta_type cbs54 -fluid_inertia none -domain_bc_x free "
                        "-domain_bc_y free -vesicle_markers %d",
                  (int)n);
  TestCall(LayerSelf(&stokeslet, &t.coupling->mobility->near->set, t.membrane->spectral[0], n, t.coupling->markers->X,
                     NULL, S));
  for (PetscInt i = 0; i < 2 * n; i++) F[i] = sin(1.0 + 0.3 * i);
  TestCall(NearFieldApply(t.coupling->mobility->near, 1, F, U));
  for (PetscInt i = 0; i < 2 * t.layout->n; i++) {
    PetscReal sum = 0;
    for (PetscInt j = 0; j < 2 * n; j++) sum += S[j * 2 * n + i] * F[j];
    TestWorse(&error, U[i] - sum);
  }
  CheckBelow(error / PetscMax(TestFar(2 * n, U, NULL), 1e-30), 1e-12, "%d markers: S of one curve is the near field's",
             (int)n);
}

/* r_V and r_s of V and sigma of one vesicle in unbounded fluid: V + S F, Dm V/h^2, F = Dm^T sigma + (c_b ds/a0) D4 V.
 */
static void Multiply(TestWorld *t, PetscInt v, const PetscScalar V[], const PetscScalar sigma[], PetscScalar U[],
                     PetscScalar s[]) {
  const Membrane m = t->membrane;
  const PetscReal *X = t->coupling->markers->X + 2 * t->layout->start[v];
  PetscReal F[2 * N] = {0};
  MembraneLaw law;
  PetscReal *S = TestReals(4 * N * N);
  TestCall(LayerSelf(&stokeslet, &t->coupling->mobility->near->set, m->spectral[v], N, X, NULL, S));
  TestCall(LawCreate(m, t->fluid->grid->h, v, v + 1, &law));
  LawPlace(law, 1, X);
  LawForce(law, 1, sigma, F);
  MembraneVesicleBending(m, v, m->bending / t->fluid->a0, V, F);
  for (PetscInt i = 0; i < 2 * N; i++) {
    U[i] = V[i];
    for (PetscInt j = 0; j < 2 * N; j++) U[i] += S[j * 2 * N + i] * F[j];
  }
  LawRows(law, V, sigma, s);
  TestCall(LawDestroy(&law));
}

/* All vesicles take the first one's shape, and each gets its own solution by it. */
static void CheckSolve(void) {
  ScopedWorld t;
  Scoped(SharedShapes) s;
  PetscBool failed;
  PetscScalar V[VESICLES * 2 * N], sigma[VESICLES * N], U[VESICLES * 2 * N], r[VESICLES * N];
  TestWorldCreate(&t, OPTIONS "-domain_cells 64,32 -domain_bc_x free -domain_bc_y free -vesicle_semi_axes 0.4,0.8");
  TestCall(SharedShapesCreate(&t.scene->fluid, t.coupling, &s));
  TestCall(SharedShapesFollow(s, &failed));
  CHECK(!failed && s->count == 1, "equal vesicles have one shape, %d", (int)s->count);
  CHECK(!s->coarse, "no coarse grid in unbounded fluid");
  const PetscInt own = t.layout->end - t.layout->own;
  for (PetscInt i = 0; i < own * 2 * N; i++) V[i] = sin(1.0 + 0.37 * i);
  for (PetscInt i = 0; i < own * N; i++) sigma[i] = cos(0.2 * i * i);
  for (PetscInt v = 0; v < own; v++)
    Multiply(&t, t.layout->own + v, V + 2 * N * v, sigma + N * v, U + 2 * N * v, r + N * v);
  TestCall(SharedShapesSolve(s, U, r));
  CheckBelow(TestFar(own * 2 * N, U, V) / TestFar(own * 2 * N, V, NULL), 1e-6, "each vesicle's V comes back");
}

/* r_V and r_s of V and sigma in a box with walls, where velocity comes from the grid and the near field. */
static void MultiplyAll(TestWorld *t, Vec V, Vec sigma, Vec U, Vec s) {
  Vec F;
  TestVecs(V, &F, NULL);
  TestCall(ForcesRate(t->coupling->forces, 1 / t->fluid->a0, TestArray(V), TestArray(F)));
  LawForce(t->coupling->law, 1, TestArray(sigma), TestArray(F));
  TestWorldRespond(t, PETSC_TRUE, F, U);
  TestCall(VecAXPY(U, 1, V));
  TestCall(CouplingStretching(t->coupling, V, s));
}

/* Vesicles next to one another: the shapes with what vesicles do to one another, coarse grid and near
   markers, give V back but for some per cent. */
static void CheckCross(void) {
  ScopedWorld t;
  Scoped(SharedShapes) s;
  PetscBool failed;
  Vec V, sigma, U, r;
  TestWorldCreate(&t, OPTIONS CLOSE);
  TestCall(SharedShapesCreate(&t.scene->fluid, t.coupling, &s));
  TestCall(SharedShapesFollow(s, &failed));
  CHECK(!failed && s->cross, "a coarse grid in a channel");
  TestMarkerVecs(t.layout, 2, &V, &U, NULL);
  TestMarkerVecs(t.layout, 1, &sigma, &r, NULL);
  PetscScalar *v = TestArray(V), *g = TestArray(sigma);
  for (PetscInt k = 0; k < t.layout->n; k++) {
    const PetscReal at = 2 * PETSC_PI * (PetscReal)((t.layout->first + k) % N) / N;
    v[2 * k] = cos(2 * at);
    v[2 * k + 1] = sin(at) + cos(3 * at);
    g[k] = cos(2 * at + 1);
  }
  MultiplyAll(&t, V, sigma, U, r);
  TestCall(SharedShapesSolve(s, TestArray(U), TestArray(r)));
  CheckBelow(TestApart(NORM_2, U, V), 0.05, "V comes back");
}

/* The memory makes the same shapes again, and is refused where it is of other vesicles. */
static void CheckMemory(void) {
  ScopedWorld t;
  Scoped(SharedShapes) s, again;
  PetscBool failed, valid;
  TestWorldCreate(&t, OPTIONS "-domain_cells 64,32 -domain_bc_x periodic -vesicle_reduced_area "
                              "0.7,0.8,0.9,0.7,0.8,0.9,0.7 -vesicle_area 1");
  const PetscInt size = SharedShapesMemorySize(t.layout);
  TestCall(SharedShapesCreate(&t.scene->fluid, t.coupling, &s));
  TestCall(SharedShapesCreate(&t.scene->fluid, t.coupling, &again));
  TestCall(SharedShapesFollow(s, &failed));
  CHECK(!failed && s->count == 3, "three kinds of vesicles have three shapes, %d", (int)s->count);
  PetscReal *memory = TestReals(size), *second = TestReals(size);
  SharedShapesGetMemory(s, memory);
  TestCall(SharedShapesSetMemory(again, memory, &valid));
  TestCall(SharedShapesFollow(again, &failed));
  SharedShapesGetMemory(again, second);
  CHECK(valid && !memcmp(memory, second, (size_t)size * sizeof(PetscReal)), "the memory makes the same shapes again");
  memory[1 + 2 * t.layout->M + 1] = 0; /* vesicle 1 after vesicle 0, whose edges are longer */
  TestCall(SharedShapesSetMemory(again, memory, &valid));
  CHECK(!valid, "a memory of other vesicles is refused");
}

void Facts(void) {
  const PetscReal angle[] = {2.1, -0.3, 0, 3.1};
  const PetscInt shift[] = {17, 44, 0, 1};
  for (int k = 0; k < 4; k++) CheckPose(angle[k], shift[k]);
  for (PetscInt n = 8; n < 16; n++) CheckFit(n);
  CheckSelfLayer(45);
  CheckSelfLayer(44);
  CheckSolve();
  CheckCross();
  CheckMemory();
}
