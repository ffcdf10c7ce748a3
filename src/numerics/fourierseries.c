#include "numerics/fourierseries.h"

#define FOURIER_AFRESH 16 /* e^{-2 pi i k j/n} is a product of the one before, and computed anew after so many */

/* a b, without the case distinctions of C for products that are not finite. */
static inline Point FourierTimes(Point a, Point b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b), creal(a) * cimag(b) + cimag(a) * creal(b));
}

void FourierSeriesModes(PetscInt n, const PetscReal a[], Point hat[]) {
  const PetscInt half = n / 2;
  for (PetscInt k = -half; k <= half; k++) {
    const Point step = cexp(-2 * PETSC_PI * I * (PetscReal)k / (PetscReal)n);
    Point sum = 0, turn = 1;
    for (PetscInt j = 0; j < n; j++) {
      if (j % FOURIER_AFRESH == 0) turn = cexp(-2 * PETSC_PI * I * (PetscReal)((k * j) % n) / (PetscReal)n);
      sum += FourierTimes(CMPLX(a[2 * j], a[2 * j + 1]), turn);
      turn = FourierTimes(turn, step);
    }
    hat[half + k] = sum / (PetscReal)(2 * PetscAbsInt(k) == n ? 2 * n : n);
  }
}

Point FourierSeriesAt(PetscInt n, const Point hat[], Point t, Point *slope) {
  const PetscInt half = n / 2;
  const Point up = cexp(I * t), down = 1 / up;
  Point sum = hat[half], change = 0, plus = 1, minus = 1;
  for (PetscInt k = 1; k <= half; k++) {
    plus = FourierTimes(plus, up);
    minus = FourierTimes(minus, down);
    const Point a = FourierTimes(hat[half + k], plus), b = FourierTimes(hat[half - k], minus);
    sum += a + b;
    change += (PetscReal)k * (a - b);
  }
  *slope = I * change;
  return sum;
}
