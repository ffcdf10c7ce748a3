#include "kernel/kernel.h"

/* Six-point C^3 kernel of Bao, Kaye and Peskin, J. Comput. Phys. 316 (2016). */
static PetscInt IB6(PetscReal x, PetscInt *first, PetscReal w[KERNEL_MAX_POINTS]) {
  const PetscReal K = 59.0 / 60 - PetscSqrtReal(29.0) / 20, below = PetscFloorReal(x);
  /* the formulas give phi at r-3 .. r+2: the last is the weight of the first grid point, where x - j = r + 2 */
  const PetscReal r = x - below, r2 = r * r, r3 = r2 * r;
  const PetscReal beta = 9.0 / 4 - 1.5 * (K + r2) + (22.0 / 3 - 7 * K) * r - 7.0 / 3 * r3;
  const PetscReal gamma = 0.25 * (0.5 * (161.0 / 36 - 59.0 / 6 * K + 5 * K * K) * r2 +
                                  1.0 / 3 * (5 * K - 109.0 / 24) * r2 * r2 + 5.0 / 18 * r3 * r3);
  const PetscReal p = (-beta + PetscSqrtReal(beta * beta - 112 * gamma)) / 56;
  *first = (PetscInt)below - 2;
  w[5] = p;
  w[4] = -3 * p - 1.0 / 16 + (K + r2) / 8 + (3 * K - 1) * r / 12 + r3 / 12;
  w[3] = 2 * p + 0.25 + (4 - 3 * K) * r / 6 - r3 / 6;
  w[2] = 2 * p + 5.0 / 8 - (K + r2) / 4;
  w[1] = -3 * p + 0.25 - (4 - 3 * K) * r / 6 + r3 / 6;
  w[0] = p - 1.0 / 16 + (K + r2) / 8 - (3 * K - 1) * r / 12 - r3 / 12;
  return 6;
}

/* Weights of the cardinal B-spline of degree n - 1 centred on x, by the Cox-de Boor recursion; returns n. */
static PetscInt BSpline(PetscInt n, PetscReal x, PetscInt *first, PetscReal w[KERNEL_MAX_POINTS]) {
  const PetscReal left = x - 0.5 * (PetscReal)n, below = PetscFloorReal(left), f = left - below;
  PetscReal M[KERNEL_MAX_POINTS] = {1}, factorial = 1;
  for (PetscInt m = 2; m <= n; factorial *= m - 1, m++) /* the divisions by m - 1 follow as 1/factorial */
    for (PetscInt i = m - 1; i >= 0; i--)
      M[i] = (i < m - 1 ? (f + i) * M[i] : 0) + (i > 0 ? (m - f - i) * M[i - 1] : 0);
  *first = (PetscInt)below + 1;
  for (PetscInt k = 0; k < n; k++) w[k] = M[n - 1 - k] * (1 / factorial);
  return n;
}

PetscInt KernelSpline4(PetscReal x, PetscInt *first, PetscReal w[]) {
  return BSpline(4, x, first, w);
}

PetscInt KernelSpline5(PetscReal x, PetscInt *first, PetscReal w[]) {
  return BSpline(5, x, first, w);
}

PetscInt KernelSpline6(PetscReal x, PetscInt *first, PetscReal w[]) {
  return BSpline(6, x, first, w);
}

#define COMMA ,
#define KERNEL_ROW(name, along, across, spacing, least, a, b)                                                          \
  {                                                                                                                    \
#name, along, across, spacing, least, {                                                                            \
      a, b                                                                                                             \
    }                                                                                                                  \
  }
static const Kernel kernels[] = {KERNELS(KERNEL_ROW, COMMA)};

const Kernel *KernelFind(const char name[]) {
  for (size_t i = 0; i < sizeof(kernels) / sizeof(kernels[0]); i++)
    if (!strcmp(kernels[i].name, name)) return &kernels[i];
  return NULL;
}

PetscReal KernelSecondMoment(KernelWeights weights) {
  const PetscReal x = 0.3;
  PetscReal w[KERNEL_MAX_POINTS], sum = 0;
  PetscInt first;
  const PetscInt n = weights(x, &first, w);
  for (PetscInt k = 0; k < n; k++) sum += w[k] * PetscSqr(first + k - x);
  return sum;
}

void KernelMoments(KernelWeights weights, int count, PetscReal moment[]) {
  enum { PLACES = 64 };
  PetscReal w[KERNEL_MAX_POINTS];
  for (int m = 0; m < count; m++) moment[m] = 0;
  for (int place = 0; place < PLACES; place++) {
    const PetscReal x = (place + 0.5) / PLACES;
    PetscInt first;
    const PetscInt n = weights(x, &first, w);
    for (PetscInt k = 0; k < n; k++)
      for (int m = 0; m < count; m++) moment[m] += w[k] * PetscPowRealInt(first + k - x, 2 * m) / PLACES;
  }
}
