#include "curve/modes.h"

void CurveModes(PetscInt n, const PetscReal a[], Point hat[]) {
  const PetscInt half = n / 2;
  for (PetscInt k = -half; k <= half; k++) {
    Point sum = 0;
    for (PetscInt j = 0; j < n; j++)
      sum += (a[2 * j] + I * a[2 * j + 1]) * cexp(-2 * PETSC_PI * I * (PetscReal)((k * j) % n) / (PetscReal)n);
    hat[half + k] = sum / (PetscReal)(2 * PetscAbsInt(k) == n ? 2 * n : n);
  }
}

Point CurveSeries(PetscInt n, const Point hat[], Point t, Point *slope) {
  const PetscInt half = n / 2;
  const Point up = cexp(I * t), down = 1 / up;
  Point sum = hat[half], plus = 1, minus = 1;
  *slope = 0;
  for (PetscInt k = 1; k <= half; k++) {
    plus *= up;
    minus *= down;
    sum += hat[half + k] * plus + hat[half - k] * minus;
    *slope += I * (PetscReal)k * (hat[half + k] * plus - hat[half - k] * minus);
  }
  return sum;
}
