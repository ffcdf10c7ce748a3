#include "numerics/rigidfit.h"
#include "base/lanes.h"

void RigidFitCentre(PetscInt n, const PetscReal X[], PetscReal Y[]) {
  PetscReal mean[2] = {0, 0};
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) mean[c] += X[2 * k + c] / n;
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) Y[2 * k + c] = X[2 * k + c] - mean[c];
}

void RigidFitSizes(PetscInt n, const PetscReal X[], PetscReal size[RIGIDFIT_SIZES]) {
  PetscReal rest = 0;
  for (PetscInt k = 0; k < 2 * n; k++) rest += X[k] * X[k] / (PetscReal)n;
  for (int q = 0; q < RIGIDFIT_SIZES - 1; q++) {
    const PetscReal angle = (q % 2 ? 2 : -2) * PETSC_PI * (q / 2 + 1) / (PetscReal)n, c = PetscCosReal(angle),
                    s = PetscSinReal(angle);
    PetscReal turn[2] = {1, 0}, a[2] = {0, 0};
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal next = c * turn[0] - s * turn[1];
      a[0] += (turn[0] * X[2 * k] - turn[1] * X[2 * k + 1]) / (PetscReal)n;
      a[1] += (turn[1] * X[2 * k] + turn[0] * X[2 * k + 1]) / (PetscReal)n;
      turn[1] = s * turn[0] + c * turn[1];
      turn[0] = next;
    }
    size[q] = PetscSqrtReal(a[0] * a[0] + a[1] * a[1]);
    rest -= size[q] * size[q];
  }
  size[RIGIDFIT_SIZES - 1] = PetscSqrtReal(PetscMax(rest, 0));
}

PetscReal RigidFitLeast(const PetscReal a[RIGIDFIT_SIZES], const PetscReal b[RIGIDFIT_SIZES]) {
  PetscReal sum = 0;
  for (int q = 0; q < RIGIDFIT_SIZES; q++) sum += PetscSqr(a[q] - b[q]);
  return PetscSqrtReal(sum);
}

#define SAME 1e-12

/* sum[0] + i sum[1] += SUM conj(y_k) x_k of n markers, two at once. Real and imaginary parts are in sums of their own,
   so that the imaginary part of a curve with itself is zero to the bit. */
static inline void AddProducts(PetscInt n, const PetscReal X[], const PetscReal Y[], Lanes sum[2]) {
  const PetscInt last = n - 1;
  for (PetscInt k = 0; k < last; k += 2) {
    const Lanes y = LanesAt(Y + 2 * k), x = LanesAt(X + 2 * k);
    sum[0] += y * x;
    sum[1] += (Lanes){-y[1], y[0], -y[3], y[2]} * x;
  }
  if (n % 2 == 0) return;
  const PetscReal *y = Y + 2 * last, *x = X + 2 * last;
  sum[0] += (Lanes){y[0] * x[0], y[1] * x[1]};
  sum[1] += (Lanes){-y[1] * x[0], y[0] * x[1]};
}

RigidFit RigidFitCurves(PetscInt n, PetscBool shifted, const PetscReal X[], const PetscReal Y[]) {
  RigidFit fit = {.turn = {1, 0}};
  PetscReal squares = 0, largest = -1;
  for (PetscInt k = 0; k < 2 * n; k++) squares += X[k] * X[k] + Y[k] * Y[k];
  for (PetscInt j = 0; j < (shifted ? n : 1); j++) {
    Lanes sum[2] = {{0}, {0}};
    AddProducts(n - j, X + 2 * j, Y, sum);
    AddProducts(j, X, Y + 2 * (n - j), sum);
    const PetscReal c[2] = {LanesSum(sum[0]), LanesSum(sum[1])}, size = c[0] * c[0] + c[1] * c[1];
    if (size <= (1 + SAME) * largest) continue; /* of a symmetric curve the first, whatever rounding does */
    largest = size;
    fit.shift = j;
    fit.turn[0] = c[0];
    fit.turn[1] = c[1];
  }
  const PetscReal size = PetscSqrtReal(PetscMax(largest, 0));
  for (int c = 0; c < 2; c++) fit.turn[c] = size > 0 ? fit.turn[c] / size : !c;
  fit.distance = PetscSqrtReal(PetscMax(squares - 2 * size, 0) / (PetscReal)n);
  return fit;
}

void RigidFitTurn(const RigidFit *p, PetscBool back, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscReal c = p->turn[0], s = back ? -p->turn[1] : p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    y[2 * k] = c * x[2 * k] - s * x[2 * k + 1];
    y[2 * k + 1] = s * x[2 * k] + c * x[2 * k + 1];
  }
}

/* y = x of n markers, vectors turned. */
static void CopyTurned(const RigidFit *p, PetscBool back, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  if (each == 2)
    RigidFitTurn(p, back, n, x, y);
  else
    (void)PetscArraycpy(y, x, n);
}

void RigidFitInto(const RigidFit *p, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscInt j = p->shift;
  CopyTurned(p, PETSC_TRUE, each, n - j, x + each * j, y);
  CopyTurned(p, PETSC_TRUE, each, j, x, y + each * (n - j));
}

void RigidFitBack(const RigidFit *p, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscInt j = p->shift;
  CopyTurned(p, PETSC_FALSE, each, n - j, x, y + each * j);
  CopyTurned(p, PETSC_FALSE, each, j, x + each * (n - j), y);
}
