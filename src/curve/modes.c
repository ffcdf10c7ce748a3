#include "curve/modes.h"

#define AFRESH 16 /* products of a turn before it is computed anew */

/* a b, without what C says of products that are not finite. */
static inline Point Times(Point a, Point b) {
  return CMPLX(creal(a) * creal(b) - cimag(a) * cimag(b), creal(a) * cimag(b) + cimag(a) * creal(b));
}

void CurveModes(PetscInt n, const PetscReal a[], Point hat[]) {
  const PetscInt half = n / 2;
  for (PetscInt k = -half; k <= half; k++) {
    const Point step = cexp(-2 * PETSC_PI * I * (PetscReal)k / (PetscReal)n);
    Point sum = 0, turn = 1;
    for (PetscInt j = 0; j < n; j++) {
      if (j % AFRESH == 0) turn = cexp(-2 * PETSC_PI * I * (PetscReal)((k * j) % n) / (PetscReal)n);
      sum += Times(CMPLX(a[2 * j], a[2 * j + 1]), turn);
      turn = Times(turn, step);
    }
    hat[half + k] = sum / (PetscReal)(2 * PetscAbsInt(k) == n ? 2 * n : n);
  }
}

Point CurveSeries(PetscInt n, const Point hat[], Point t, Point *slope) {
  const PetscInt half = n / 2;
  const Point up = cexp(I * t), down = 1 / up;
  Point sum = hat[half], change = 0, plus = 1, minus = 1;
  for (PetscInt k = 1; k <= half; k++) {
    plus = Times(plus, up);
    minus = Times(minus, down);
    const Point a = Times(hat[half + k], plus), b = Times(hat[half - k], minus);
    sum += a + b;
    change += (PetscReal)k * (a - b);
  }
  *slope = I * change;
  return sum;
}
