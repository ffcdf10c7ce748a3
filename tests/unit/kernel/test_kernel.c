/* Kernels: values and moments (docs/membrane.md, Kernels), at many positions of a marker in its cell. */
#include "facts.h"

#define POSITIONS 997

/* Largest deviations of the moments SUM (x - j)^m phi(x - j) from `want`; even: over even j only. */
static PetscReal Moment(KernelWeights weights, int m, PetscBool even, PetscReal want) {
  PetscReal worst = 0;
  for (int k = 0; k < POSITIONS; k++) {
    const PetscReal x = -7.3 + 11.0 * k / POSITIONS;
    PetscReal w[KERNEL_MAX_POINTS], sum = 0;
    PetscInt first;
    const PetscInt n = weights(x, &first, w);
    for (PetscInt i = 0; i < n; i++)
      if (!even || (first + i) % 2 == 0) sum += w[i] * PetscPowRealInt(x - first - i, m);
    TestWorse(&worst, sum - want);
  }
  return worst;
}

/* A moment stated as a fact: the bound is round-off of a sum of six terms of size up to 3^m. */
static void CheckMoment(KernelWeights weights, int m, PetscBool even, PetscReal want) {
  CheckBelow(Moment(weights, m, even, want), m ? 1e-13 : 1e-14, "moment %d%s is %.10f", m,
             even ? " over even points" : "", want);
}

static void CheckIB6(void) {
  const PetscReal moment[] = {1, 0, 59.0 / 60 - PetscSqrtReal(29.0) / 20, 0};
  const PetscReal x[] = {0, 0.5, 1, 2}, value[] = {.4464812268, .3885397215, .25, .0267593866};
  const Kernel *ib6 = KernelFind("ib6");
  CHECK(ib6 != NULL && ib6->along == ib6->across, "ib6 has the same weights along and across");
  TestAbout("ib6");
  for (int i = 0; i < 8; i++) {
    const PetscReal at = i % 2 ? -x[i / 2] : x[i / 2];
    CheckBelow(TestWeight(ib6->along, at) - value[i / 2], 1e-10, "phi(%g) = %.10f", at, value[i / 2]);
  }
  CheckBelow(TestWeight(ib6->along, 3), 1e-15, "phi(3) = 0");
  CheckMoment(ib6->along, 0, PETSC_TRUE, 0.5); /* so the odd sum is 1/2 too */
  for (int m = 0; m < 4; m++) CheckMoment(ib6->along, m, PETSC_FALSE, moment[m]);
}

/* d/dx of a spline of n + 1 points = that of n points at x + 1/2 less that at x - 1/2: velocities interpolated with
   both are continuously divergence free. The derivative by central differences of step e: error e^2 and round-off
   1e-16/e. Skips the knots of the splines. */
static PetscReal DivergenceError(KernelWeights along, KernelWeights across) {
  const PetscReal e = 1e-5;
  PetscReal worst = 0;
  for (int i = 0; i < POSITIONS; i++) {
    const PetscReal x = -3.5 + 7 * (i + 0.37) / POSITIONS;
    const PetscReal slope = (TestWeight(along, x + e) - TestWeight(along, x - e)) / (2 * e);
    if (PetscAbsReal(2 * x - PetscFloorReal(2 * x + 0.5)) < 4 * e) continue;
    TestWorse(&worst, slope - TestWeight(across, x + 0.5) + TestWeight(across, x - 0.5));
  }
  return worst;
}

/* Spline with n points: sum 1, first moment 0, variance n/12. */
static void CheckSplines(void) {
  static const KernelWeights splines[] = {KernelSpline4, KernelSpline5, KernelSpline6};
  /* cardinal B-splines of 4, 5, 6 points at 0: 2/3, 115/192, 11/20; at 1: 1/6, 19/96, 13/60 */
  const PetscReal value[][2] = {{2.0 / 3, 1.0 / 6}, {115.0 / 192, 19.0 / 96}, {11.0 / 20, 13.0 / 60}};
  const Kernel *cbs54 = KernelFind("cbs54");
  CHECK(cbs54->along == KernelSpline5 && cbs54->across == KernelSpline4, "cbs54 has splines of 5 and 4 points");
  for (int i = 0; i < 3; i++) {
    const PetscReal moment[] = {1, 0, (i + 4) / 12.0};
    PetscReal w[KERNEL_MAX_POINTS];
    PetscInt first;
    TestAbout("spline of %d points", i + 4);
    CHECK(splines[i](0.3, &first, w) == i + 4, "that many points");
    for (int m = 0; m < 3; m++) CheckMoment(splines[i], m, PETSC_FALSE, moment[m]);
    for (int x = -1; x <= 1; x++)
      CheckBelow(TestWeight(splines[i], x) - value[i][x != 0], 1e-14, "phi(%d) = %g", x, value[i][x != 0]);
    if (i)
      CheckBelow(DivergenceError(splines[i], splines[i - 1]), 1e-8,
                 "slope along = difference across (divergence free)");
  }
}

void Facts(void) {
  CHECK(!KernelFind("ib4"), "an unknown kernel is not found");
  CheckIB6();
  CheckSplines();
}
