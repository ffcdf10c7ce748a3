/* Grid and near field together are the free-space single layer: the velocity of forces on a circle, which is known, for
   kernels, places in a cell and turns of the markers. */
#include "facts.h"
#include "layers/latticegreen.h"
#include "layers/pairkernel.h"

#define OPTIONS                                                                                                        \
  EXACT PERIODIC "-scheme_type coupled -fluid_inertia none -domain_cells 160,160 -domain_box 0,5,0,5 "                 \
                 "-vesicle_semi_axes 0.5,0.5 -fluid_viscosity 0.7 -vesicle_markers 101 "

/* On a circle of radius R the free-space single layer of the force density f_x + i f_y = e^{i k theta}, k neither 0 nor
   1, is R/(4 nu |k|) times it. A box of periods 10 R adds the velocity of the images, which is smooth, does not depend
   on the circle's place in a cell, and is given by few Fourier modes of the velocity u_x + i u_y; after its constant
   and linear part, modes -1 to 1, it is of order (R/L)^4 and smaller. */
#define RADIUS 0.5
static const int modes[] = {-5, -4, -3, -2, 2, 3, 4, 5};
enum { MODES = 8, LOW = 12, COEFFICIENTS = 2 * (2 * LOW + 1) };

typedef struct {
  TestWorld w;
  Vec force, velocity;
  PetscReal center[2];
} Circle;

/* x += factor e^{i (k theta + phase)} at the own markers. */
static void AddMode(Circle *c, int k, PetscReal factor, PetscReal phase, Vec x) {
  const PetscScalar *X = TestArray(c->w.X);
  PetscScalar *a = TestArray(x);
  for (PetscInt j = 0; j < c->w.layout->n; j++) {
    const PetscReal theta = atan2(X[2 * j + 1] - c->center[1], X[2 * j] - c->center[0]);
    a[2 * j] += factor * PetscCosReal(k * theta + phase);
    a[2 * j + 1] += factor * PetscSinReal(k * theta + phase);
  }
}

/* Coefficient of e^{i k theta} in x, on every rank. */
static void Coefficient(Circle *c, int k, Vec x, PetscReal z[2]) {
  Vec wave;
  TestVecs(x, &wave, NULL);
  for (int part = 0; part < 2; part++) {
    TestCall(VecZeroEntries(wave));
    AddMode(c, k, 1. / c->w.layout->M, part * PETSC_PI / 2, wave);
    z[part] = TestDot(x, wave);
  }
}

/* velocity = E A^-1 E^T F/h^2, and with C F, of the force of mode k, less the exact one, over its size. */
static void Disturb(Circle *c, int k, PetscReal phase, PetscBool with) {
  const PetscReal size = RADIUS / (4 * c->w.fluid->nu * PetscAbsInt(k));
  TestCall(VecZeroEntries(c->force));
  AddMode(c, k, 2 * PETSC_PI * RADIUS / c->w.layout->M, phase, c->force);
  TestWorldRespond(&c->w, with, c->force, c->velocity);
  AddMode(c, k, -size, phase, c->velocity);
  TestCall(VecScale(c->velocity, 1 / size));
}

/* The error of a mode without its constant and linear part, and its modes up to LOW; error[0]: its largest value,
   error[1]: that of what is in higher modes. */
static void ModeError(Circle *c, int k, PetscReal phase, PetscReal error[2], PetscReal z[COEFFICIENTS]) {
  Disturb(c, k, phase, PETSC_TRUE);
  for (int q = 0; q <= LOW; q++)
    for (int sign = -1; sign <= (q ? 1 : -1); sign += 2) {
      PetscReal *at = z + 2 * (LOW + sign * q);
      if (q == 2 && sign < 0) error[0] = TestNorm(NORM_INFINITY, c->velocity);
      Coefficient(c, sign * q, c->velocity, at);
      AddMode(c, sign * q, -at[0], 0, c->velocity);
      AddMode(c, sign * q, -at[1], PETSC_PI / 2, c->velocity);
    }
  error[1] = TestNorm(NORM_INFINITY, c->velocity);
}

/* Modes of the force on one circle; the first circle's errors are kept, by which those of others differ little. */
static void CheckCircle(const char kernel[], PetscReal turn, const PetscReal center[2],
                        PetscReal kept[MODES][2][COEFFICIENTS]) {
  Circle c = {.center = {center[0], center[1]}};
  PetscReal without = 0, second = 0, others = 0, spread = 0;
  TestAbout("circle, %s, turned by %g degrees, at %.4f, %.4f", kernel, turn, center[0], center[1]);
  TestWorldCreate(&c.w, OPTIONS "-vesicle_angle %g -vesicle_center %.16g,%.16g -delta_type %s", turn, center[0],
                  center[1], kernel);
  TestVecs(c.w.X, &c.force, &c.velocity, NULL);
  for (int k = 0; k < 2 * MODES; k++) {
    const int mode = modes[k / 2];
    PetscReal *known = kept[k / 2][k % 2], z[COEFFICIENTS], error[2] = {0}, apart = 0;
    Disturb(&c, mode, k % 2 * PETSC_PI / 2, PETSC_FALSE);
    TestWorse(&without, TestNorm(NORM_INFINITY, c.velocity));
    ModeError(&c, mode, k % 2 * PETSC_PI / 2, error, z);
    if (TestFar(COEFFICIENTS, known, NULL) == 0) TestCall(PetscArraycpy(known, z, COEFFICIENTS));
    for (int q = 0; q < COEFFICIENTS; q++) apart += PetscSqr(z[q] - known[q]);
    TestWorse(&spread, PetscSqrtReal(apart) + error[1]);
    TestWorse(PetscAbsInt(mode) == 2 ? &second : &others, error[0]);
  }
  CheckBelow(second, 1.5e-3, "modes 2 of the single layer");
  CheckBelow(others, 4e-4, "higher modes");
  CHECK(without > 0.2, "without C %.2f", without);
  CheckBelow(spread, 2e-4, "apart from the first circle's");
  TestWorldDestroy(&c.w);
}

/* A pair seen from a wall, in cells: x along it, response minus source; a, b the distances of response and source. */
typedef struct {
  PetscReal x, a, b;
} PairOff;

/* The lattice's image by its tables, the half space's less the free one's: response comp r and source comp s (0 along
   the wall, 1 across it), x0 the source's place along it. Of n to t entry q lies at the offset q - 1/2. */
static PetscReal ImageOfTables(const ImageTable *half, const OffsetTable *free, int r, int s, const PairOff *p,
                               PetscReal x0) {
  const Kernel *kernel = KernelFind("cbs54");
  const KernelWeights weights[] = {kernel->along, kernel->across};
  const OffsetBlock block = r != s ? OFFSET_VU : r ? OFFSET_VV : OFFSET_UU;
  const PetscReal at[4] = {x0 + p->x - (r ? 0.5 : 0), x0 - (s ? 0.5 : 0), p->a - (r ? 0 : 0.5), p->b - (s ? 0 : 0.5)};
  const int kind[4] = {r, s, !r, !s};
  PetscReal w[4][KERNEL_MAX_POINTS], sum = 0;
  PetscInt first[4], n[4];
  for (int q = 0; q < 4; q++) n[q] = weights[kind[q]](at[q], &first[q], w[q]);
  for (PetscInt i = 0; i < n[0]; i++)
    for (PetscInt j = 0; j < n[1]; j++)
      for (PetscInt k = 0; k < n[2]; k++)
        for (PetscInt l = 0; l < n[3]; l++) {
          const PetscInt q = first[0] + i - first[1] - j + (r != s), row = first[2] + k, source = first[3] + l;
          const PetscInt line = (row - source - (r != s) + free->size[1]) * (2 * free->size[0] + 1);
          sum += w[0][i] * w[1][j] * w[2][k] * w[3][l] *
                 (half->value[block][row][source][IMAGE_SHIFT + q] - free->value[block][line + free->size[0] + q]);
        }
  return sum;
}

/* Off the wall the closed forms of images are what kernels and lattice make of them. With the first two orders alone
   they are off by 1.5e-6 to 1.8e-6 at 14 cells. */
static void CheckImages(PetscReal R, PetscReal bound) {
  static const char *const name[IMAGE_PARTS] = {"tt", "nn", "nt", "tn"};
  OffsetTable free;
  ImageTable *half;
  ImageKernel kernel;
  PetscReal most[IMAGE_PARTS] = {0};
  TestAbout("images %g cells away", R);
  TestCall(LatticeStokeslet(2 * IMAGE_SHIFT, &free));
  TestCall(PetscNew(&half));
  TestCall(stokeslet.image_fill(&free, half));
  stokeslet.image_make(KernelFind("cbs54"), &kernel);
  for (int q = 0; q < 60; q++) { /* angles, places between wall and wall, places in a cell */
    const PetscReal turn = 0.9 * (q % 12) / 12, H = R * PetscCosReal(turn), part = (q % 5 + 0.5) / 5;
    const PairOff p = {R * PetscSinReal(turn), 3 + part * (H - 6), H - 3 - part * (H - 6)};
    const Lanes x = p.x + (Lanes){0}, a = p.a + (Lanes){0}, b = p.b + (Lanes){0};
    Lanes blake[IMAGE_PARTS], left[IMAGE_PARTS], other[IMAGE_PARTS];
    stokeslet.image_exact(&kernel, x, a, b, blake);
    stokeslet.image_far(&kernel, x, a, b, NULL, left);
    for (int k = 0; k < IMAGE_NT + 1; k++) {
      const int r = k != IMAGE_TT, s = k == IMAGE_NN;
      const PetscReal image = ImageOfTables(half, &free, r, s, &p, 0.37 * q);
      TestWorse(&most[k], blake[k][0] - image - left[k][0]);
    }
    stokeslet.image_far(&kernel, -x, b, a, NULL, other); /* t from n is n from t, exchanged */
    TestWorse(&most[IMAGE_TN], left[IMAGE_TN][0] - other[IMAGE_NT][0]);
  }
  for (int k = 0; k < IMAGE_TN; k++) CheckBelow(most[k], bound, "%s: closed form and sums", name[k]);
  CheckBelow(most[IMAGE_TN], 1e-16, "tn is nt with the ends exchanged");
  TestCall(PetscFree(half));
  TestCall(OffsetTableDestroy(&free));
}

void Facts(void) {
  static const char *const kernels[] = {"cbs54", "ib6"};
  static const PetscReal cell = 5. / 160, shift[][2] = {{0, 0}, {0.37, 0}, {0.5, 0.5}, {0.21, 0.83}};
  static PetscReal kept[MODES][2][COEFFICIENTS];
  for (int k = 0; k < 2; k++)
    for (int s = 0; s < 4; s++) {
      const PetscReal center[2] = {2.5 + shift[s][0] * cell, 2.5 + shift[s][1] * cell};
      CheckCircle(kernels[k], s % 2 ? 17 : 0, center, kept);
    }
  CheckImages(IMAGE_OFF, 1e-6);
  CheckImages(IMAGE_CELLS, 2e-7);
}
