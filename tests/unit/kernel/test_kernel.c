/* Kernels: values and moments (docs/membrane.md, Kernels), at many positions of a marker in its cell. */
#include "facts.h"

#define POSITIONS 997

/* phi(x): the weight at grid point 0 of a marker at x. */
static PetscReal Phi(KernelWeights weights, PetscReal x) {
  PetscReal w[KERNEL_MAX_POINTS];
  PetscInt first;
  const PetscInt n = weights(x, &first, w);
  return first <= 0 && -first < n ? w[-first] : 0;
}

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
    worst = PetscMax(worst, PetscAbsReal(sum - want));
  }
  return worst;
}

/* A moment stated as a fact: `tolerance` is round-off of a sum of six terms of size up to 3^m. */
static void CheckMoment(const char name[], KernelWeights weights, int m, PetscBool even, PetscReal want) {
  const PetscReal error = Moment(weights, m, even, want), tolerance = m ? 1e-13 : 1e-14;
  CHECK(error < tolerance, "%s: moment %d%s is %.10f, error %.1e", name, m, even ? " over even points" : "", want,
        error);
}

static void CheckIB6(void) {
  const PetscReal moment[] = {1, 0, 59.0 / 60 - PetscSqrtReal(29.0) / 20, 0};
  const PetscReal x[] = {0, 0.5, 1, 2}, value[] = {.4464812268, .3885397215, .25, .0267593866};
  const Kernel *ib6 = KernelFind("ib6");
  PetscReal error;
  CHECK(ib6 != NULL && ib6->along == ib6->across, "ib6 has the same weights along and across");
  for (int i = 0; i < 4; i++) {
    error = PetscMax(PetscAbsReal(Phi(ib6->along, x[i]) - value[i]), PetscAbsReal(Phi(ib6->along, -x[i]) - value[i]));
    CHECK(error < 1e-10, "ib6 phi(+-%g) = %.10f, error %.1e", x[i], value[i], error);
  }
  error = PetscAbsReal(Phi(ib6->along, 3));
  CHECK(error < 1e-15, "ib6 phi(3) = 0, error %.1e", error);
  CheckMoment("ib6", ib6->along, 0, PETSC_TRUE, 0.5); /* so the odd sum is 1/2 too */
  for (int m = 0; m < 4; m++) CheckMoment("ib6", ib6->along, m, PETSC_FALSE, moment[m]);
}

/* Spline with n points: sum 1, first moment 0, variance n/12 (n > 2; 2 points reproduce no quadratics). */
static void CheckSpline(const char name[], KernelWeights weights, PetscInt n) {
  const PetscReal moment[] = {1, 0, n / 12.0};
  PetscReal w[KERNEL_MAX_POINTS];
  PetscInt first;
  CHECK(weights(0.3, &first, w) == n, "%s: %d points", name, (int)n);
  for (int m = 0; m < 3; m++) CheckMoment(name, weights, m, PETSC_FALSE, moment[m]);
}

/* d/dx of a spline of n + 1 points = that of n points at x + 1/2 less that at x - 1/2: velocities interpolated with
   both are continuously divergence free. The derivative by central differences of step e: error e^2 and round-off
   1e-16/e. Skips the knots of the splines. */
static PetscReal DivergenceError(KernelWeights along, KernelWeights across) {
  const PetscReal e = 1e-5;
  PetscReal worst = 0;
  for (int i = 0; i < POSITIONS; i++) {
    const PetscReal x = -3.5 + 7 * (i + 0.37) / POSITIONS;
    const PetscReal slope = (Phi(along, x + e) - Phi(along, x - e)) / (2 * e);
    if (PetscAbsReal(2 * x - PetscFloorReal(2 * x + 0.5)) < 4 * e) continue;
    worst = PetscMax(worst, PetscAbsReal(slope - Phi(across, x + 0.5) + Phi(across, x - 0.5)));
  }
  return worst;
}

static void CheckSplines(void) {
  static const KernelWeights splines[] = {KernelSpline4, KernelSpline5, KernelSpline6};
  /* cardinal B-splines of 4, 5, 6 points at 0: 2/3, 115/192, 11/20; at 1: 1/6, 19/96, 13/60 */
  const PetscReal at0[] = {2.0 / 3, 115.0 / 192, 11.0 / 20}, at1[] = {1.0 / 6, 19.0 / 96, 13.0 / 60};
  const Kernel *cbs54 = KernelFind("cbs54");
  CHECK(cbs54->along == KernelSpline5 && cbs54->across == KernelSpline4, "cbs54 has splines of 5 and 4 points");
  for (int i = 0; i < 3; i++) {
    PetscReal error = PetscAbsReal(Phi(splines[i], 0) - at0[i]);
    const char *name = TestText("%d points", i + 4);
    CheckSpline(name, splines[i], i + 4);
    for (int sign = -1; sign <= 1; sign += 2) error = PetscMax(error, PetscAbsReal(Phi(splines[i], sign) - at1[i]));
    CHECK(error < 1e-14, "%s: values at 0, 1 and -1, error %.1e", name, error);
    error = i ? DivergenceError(splines[i], splines[i - 1]) : 0;
    CHECK(error < 1e-8, "%s: slope along = difference across (divergence free), error %.1e", name, error);
  }
}

void Facts(void) {
  CheckIB6();
  CheckSplines();
  CHECK(!KernelFind("ib4"), "an unknown kernel is not found");
}
