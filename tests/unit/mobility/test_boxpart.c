/* The box part D of the near field: symmetric, of second order in h, free of a net flux through a membrane; with it the
   markers' velocity on a coarse grid is that on a finer one. A product of it and of the double layer's is that of the
   table's vectors. */
#include "facts.h"
#include "scheme/scheme.h"

typedef struct {
  TestWorld world;
  PetscReal *D;              /* [2M][2M] */
  PetscReal *normal, *force; /* [2M] */
  PetscReal *U[2];           /* [2M] velocities without and with D */
} World;

/* Normals of unit size in all, and the forces c + k (1, 2) of the cosines of the markers' numbers. */
static void SetVectors(World *w) {
  const PetscInt M = w->world.layout->M;
  const PetscReal *X = w->world.coupling->markers->X;
  PetscReal *normal = w->normal, *force = w->force;
  for (PetscInt v = 0; v < w->world.layout->bodies; v++) {
    const PetscInt first = w->world.layout->start[v], n = LayoutCount(w->world.layout, v);
    for (PetscInt k = 0; k < n; k++) {
      const PetscInt next = first + (k + 1) % n, before = first + (k + n - 1) % n, at = first + k;
      normal[2 * at] = X[2 * next + 1] - X[2 * before + 1];
      normal[2 * at + 1] = X[2 * before] - X[2 * next];
      force[2 * at] = PetscCosReal(2 * PETSC_PI * k / n) + 0.3 * PetscSinReal(4 * PETSC_PI * k / n);
      force[2 * at + 1] = 0.5 * PetscSinReal(2 * PETSC_PI * k / n) - 0.2 * PetscCosReal(6 * PETSC_PI * k / n);
    }
  }
  const PetscReal size = PetscSqrtReal(TestProduct(2 * M, normal, normal));
  for (PetscInt k = 0; k < 2 * M; k++) normal[k] /= size;
}

static void WorldCreate(const char options[], PetscInt cells, PetscBool box, World *w) {
  TestWorld *world = &w->world;
  TestScene(&world->scene, EXACT "-delta_type cbs54 -fluid_inertia none -vesicle_markers 45 -domain_cells %d,%d %s",
            (int)cells, (int)cells, options);
  const CouplingSetting setting = {
      .mobility = {
          .kernel = world->scene->coupling.kernel, .near = NEAR_EXACT, .spec = &world->scene->fluid, .box_part = box}};
  TestWorldBuildFor(&setting, world);
  TestWorldPlace(world->fluid->a0, world);
  const PetscInt n = 2 * world->layout->M;
  w->D = TestReals(n * n);
  w->normal = TestReals(n);
  w->force = TestReals(n);
  for (int k = 0; k < 2; k++) w->U[k] = TestReals(n);
  SetVectors(w);
  const MarkerRange all = {0, n / 2};
  if (box) TestCall(BoxPartAdd(world->coupling->mobility->near->box, 1, &all, &all, w->D));
  TestSum((PetscMPIInt)(n * n), w->D);
}

/* x.D y of vectors of all markers. */
static PetscReal Form(World *w, const PetscReal x[], const PetscReal y[]) {
  const PetscInt n = 2 * w->world.layout->M;
  PetscReal sum = 0;
  for (PetscInt j = 0; j < n; j++) sum += TestProduct(n, x, w->D + j * n) * y[j];
  return sum;
}

/* Root of the sum of squares of a - factor b, over that of a. */
static PetscReal Difference(PetscInt n, const PetscReal a[], PetscReal factor, const PetscReal b[]) {
  PetscReal sum = 0;
  for (PetscInt k = 0; k < n; k++) sum += PetscSqr(a[k] - factor * b[k]);
  return PetscSqrtReal(sum / TestProduct(n, a, a));
}

/* A pair that the end of its block destroys. */
#define ScopedPair __attribute__((cleanup(PairDestroy))) World
static void PairDestroy(World (*pair)[2]) {
  for (int k = 0; k < 2; k++) TestWorldDestroy(&(*pair)[k].world);
}

/* The same markers on a grid and on one twice as fine, with the box part. */
static void PairCreate(const char options[], World w[2]) {
  for (int k = 0; k < 2; k++) WorldCreate(options, k ? 64 : 32, PETSC_TRUE, &w[k]);
}

/* The table itself. At walls n.D n is minus what the images leave; over a period the flux is that of C + D. */
static void CheckTable(const char options[], PetscBool walls) {
  ScopedPair w[2] = {{{0}}};
  PairCreate(options, w);
  const PetscInt n = 2 * w[0].world.layout->M;
  for (int k = 0; k < 2; k++) {
    CHECK(TestAsymmetry(n, w[k].D) == 0, "D is symmetric to the bit, rank %d",
          (int)w[k].world.coupling->mobility->near->box->at->rank);
    if (walls) CheckBelow(Form(&w[k], w[k].normal, w[k].normal), 2e-5, "n.D n");
  }
  CheckBelow(Difference(n * n, w[0].D, 4, w[1].D), walls ? 0.05 : 0.03, "D at h is 4 D at h/2");
}

/* 189 x 192 cells, which no coarser square ones fit: nearly the D of 63 x 64 cells, whose pair is their own. */
static void CheckUnlike(const char own[], const char unlike[]) {
  ScopedPair w[2] = {{{0}}};
  for (int k = 0; k < 2; k++) WorldCreate(k ? unlike : own, 63, PETSC_TRUE, &w[k]);
  const PetscReal off = Difference(PetscSqr(2 * w[0].world.layout->M), w[0].D, 9, w[1].D),
                  H = w[1].world.coupling->mobility->near->box->at->H / w[1].world.fluid->grid->h;
  CHECK(off < 0.05 && H > 2 && H < 3, "189 x 192 cells: from cells %.2f times as large, D within %.3f", H, off);
}

/* U = (E A^-1 E^T/h^2 + C + D) F where the Stokes solve is exact; D or not. */
static void Velocity(World *w, int part) {
  const NearField near = w->world.coupling->mobility->near;
  const BoxPart box = near->box;
  Vec F, U;
  TestMarkerVecs(w->world.layout, 2, &F, &U, NULL);
  TestCall(PetscArraycpy(TestArray(F), w->force + 2 * w->world.layout->first, 2 * w->world.layout->n));
  if (!part) near->box = NULL;
  TestWorldRespond(&w->world, PETSC_TRUE, F, U);
  near->box = box;
  TestCall(LayoutGatherVec(w->world.layout, U, w->U[part]));
}

/* The markers' velocity on two grids, with D and without. */
static void CheckVelocity(const char name[], const char options[], PetscReal most) {
  ScopedPair w[2] = {{{0}}};
  TestAbout("%s", name);
  PetscReal off[2];
  PairCreate(options, w);
  for (int k = 0; k < 4; k++) Velocity(&w[k / 2], k % 2);
  for (int part = 0; part < 2; part++) off[part] = Difference(2 * w[0].world.layout->M, w[1].U[part], 1, w[0].U[part]);
  CheckBelow(off[1], most, "velocities on 32 and 64 cells differ");
  CheckBelow(off[1] / off[0], 0.4, "of what they do without D");
}

/* A vesicle a third of a spacing from its own image on both sides: finer points for all images with the box part, as
   without it: unrefined they differ by 2.4e-2. */
static void CheckOwnImages(const char name[], const char options[]) {
  ScopedPair w[2] = {{{0}}};
  TestAbout("%s", name);
  for (int k = 0; k < 2; k++) {
    WorldCreate(options, 64, (PetscBool)k, &w[k]);
    Velocity(&w[k], k);
  }
  CheckBelow(Difference(2 * w[0].world.layout->M, w[0].U[0], 1, w[1].U[1]), 2e-3,
             "velocities with and without D differ");
}

#define ONE "-domain_box 0,5,0,5 -vesicle_semi_axes 0.4,0.6 -vesicle_center 2.6,2.3 -vesicle_angle 20 "
#define TWO "-domain_box 0,4,0,4 -vesicle_count 2 -vesicle_semi_axes 0.4,0.6 -vesicle_center 1.2,1.8,3.1,2 "
#define OWN "-domain_box 0,2,0,2 -vesicle_semi_axes 0.988,0.4 -vesicle_center 1,0.9 "
#define WALL "-domain_box 0,5,0,5 -vesicle_semi_axes 1.6,1 -vesicle_center 2.6,1.08 "
#define UNLIKE "-domain_box 0,5,0,5.079365079365079 "
#define SEAM "-domain_box 0,8,0,8 -vesicle_semi_axes 0.4,0.6 -vesicle_center 7.7654321,4.3 -vesicle_markers 35 "

/* Largest D F - SUM phi Q diag(l) Q^T psi^T F of sources all unlike, D F by BoxPartApply, over the largest. */
static PetscReal ApplyOffBy(BoxPart box) {
  const Layout l = box->markers->layout;
  const BoxTable *t = box->at;
  const PetscReal *X = box->markers->X;
  PetscReal found[2] = {0, 0};
  PetscReal *F = TestReals(t->parts * l->M), *U = TestReals(2 * l->n), *a = TestReals(2 * t->rank),
            *b = TestReals(t->parts * t->rank), *sum = TestReals(t->rank);
  for (PetscInt j = 0; j < t->parts * l->M; j++) F[j] = PetscSinReal(1 + j * j);
  TestCall(BoxPartApply(box, 1, F + t->parts * l->first, U));
  for (PetscInt j = 0; j < l->M; j++) {
    BoxTableRows(t, X + 2 * j, 1, t->source, t->parts, b);
    for (PetscInt m = 0; m < t->parts * t->rank; m++) sum[m % t->rank] += F[t->parts * j + m / t->rank] * b[m];
  }
  for (PetscInt k = 0; k < 2 * l->n; k++) {
    BoxTableRows(t, X + 2 * (l->first + k / 2), 1, 0, 2, a);
    const PetscReal answer = BoxProduct(t->rank, t->l, a + k % 2 * t->rank, sum);
    TestWorse(&found[0], answer - U[k]);
    TestWorse(&found[1], answer);
  }
  TestMost(2, found);
  return found[0] / found[1];
}

/* Products of forces and of dipoles. */
static void CheckApply(const char options[]) {
  PetscReal ratio = 10;
  World w;
  WorldCreate(options, 32, PETSC_TRUE, &w);
  const Mobility m = w.world.coupling->mobility;
  TestCall(DoubleLayerCreate(m->near, &ratio, &m->contrast));
  TestCall(DoubleLayerAddBoxPart(m->contrast, &w.world.scene->fluid));
  TestCall(DoubleLayerPlace(m->contrast));
  CheckBelow(ApplyOffBy(m->near->box), 1e-12, "a product of forces is that of the table's vectors");
  CheckBelow(ApplyOffBy(m->contrast->box), 1e-12, "a product of dipoles is that of the table's vectors");
  TestWorldDestroy(&w.world);
}

/* In a box of 256 cells across or more there is a box part only when it is asked for. */
static void CheckDefault(void) {
  static const struct {
    const char *options;
    PetscBool has;
  } rows[] = {{"-domain_cells 255,300 -domain_box 0,25.5,0,30", PETSC_TRUE},
              {"-domain_cells 256,300 -domain_box 0,25.6,0,30", PETSC_FALSE},
              {"-domain_cells 256,300 -domain_box 0,25.6,0,30 -coupling_box_part true", PETSC_TRUE},
              {"-domain_cells 255,300 -domain_box 0,25.5,0,30 -coupling_box_part false", PETSC_FALSE}};
  TestAbout("box part");
  for (int k = 0; k < 4; k++) {
    Scene scene;
    TestScene(&scene, EXACT "-delta_type cbs54 -fluid_inertia auto -vesicle_center 9,9 %s", rows[k].options);
    CHECK(SceneHasBoxPart(scene) == rows[k].has, "%s", rows[k].options);
    TestCall(SceneDestroy(&scene));
  }
}

/* Nearest images and their part by the library's erfc, at rows of pairs that are no whole vectors; half a period is
   minus half. */
static void CheckImage(void) {
  enum { PAIRS = 61 };
  const BoxAxis axis[2] = {{.low = -2, .high = 2}, {.low = 0, .high = 3}};
  PetscReal d[2][PAIRS + 3] = {{0}}, part[PAIRS + 3], off = 0;
  for (int k = 0; k < PAIRS; k++)
    for (int dir = 0; dir < 2; dir++) d[dir][k] = (k - PAIRS / 2) * (dir ? 0.11 : 0.25);
  BoxImageRow(axis, PAIRS, (PetscReal *[2]){d[0], d[1]}, part);
  for (int k = 0; k < PAIRS; k++) {
    PetscReal right = 1;
    for (int dir = 0; dir < 2; dir++) {
      const PetscReal period = dir ? 3 : 4, x = (k - PAIRS / 2) * (dir ? 0.11 : 0.25);
      const PetscReal nearest = x - period * PetscFloorReal(x / period + 0.5);
      TestWorse(&off, d[dir][k] - nearest);
      right *= 0.5 * erfc(2.3 * (PetscAbsReal(nearest) / period - 0.3) / 0.2);
    }
    TestWorse(&off, part[k] - right);
  }
  CheckBelow(off, 1e-14, "nearest images and their part");
}

void Facts(void) {
  static const char *const boxes[] = {"", CHANNEL, PERIODIC};
  CheckImage();
  CheckDefault();
  for (int k = 0; k < 3; k++) {
    TestAbout("box \"%s\"", boxes[k]);
    CheckTable(TestText(ONE "%s", boxes[k]), !k);
    CheckApply(TestText("%s%s", k == 1 ? SEAM : ONE, boxes[k]));
  }
  CheckUnlike(ONE UNLIKE "-domain_cells 63,64 ", ONE UNLIKE "-domain_cells 189,192 ");
  CheckVelocity("channel", ONE CHANNEL, 5e-5);
  CheckVelocity("half a cell from a wall", WALL CHANNEL, 4e-4);
  CheckVelocity("periodic", ONE PERIODIC, 5e-5);
  CheckVelocity("two in a channel", TWO CHANNEL, 2e-4);
  CheckVelocity("two in a periodic box", TWO PERIODIC, 2e-4);
  CheckOwnImages("its own images in a channel", OWN CHANNEL);
  CheckOwnImages("its own images in a periodic box", OWN PERIODIC);
}
