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

#define SHIFTS 4
#define SAME 1e-12

/* Products conj(y) x of points, two at once or one: real and imaginary parts in sums of their own, so that the
   imaginary part of a curve with itself is zero to the bit. */
typedef struct {
  Lanes same[SHIFTS], cross[SHIFTS];
} ShiftProducts;

static inline void AddShiftPoints(Lanes y, Lanes x, int shift, ShiftProducts *sum) {
  const Lanes turned = {-y[1], y[0], -y[3], y[2]};
  sum->same[shift] += y * x;
  sum->cross[shift] += turned * x;
}

static inline Lanes OnePoint(const PetscReal x[2]) {
  return (Lanes){x[0], x[1], 0, 0};
}

/* += SUM_k conj(y_k) x_{k + i} of n markers, all shifts i at once. */
static inline void AddShiftProducts(PetscInt n, const PetscReal X[], const PetscReal Y[], ShiftProducts *sum) {
  PetscInt k = 0;
  for (; k + 2 <= n; k += 2)
    for (int i = 0; i < SHIFTS; i++) AddShiftPoints(LanesAt(Y + 2 * k), LanesAt(X + 2 * (k + i)), i, sum);
  for (; k < n; k++)
    for (int i = 0; i < SHIFTS; i++) AddShiftPoints(OnePoint(Y + 2 * k), OnePoint(X + 2 * (k + i)), i, sum);
}

/* c_i = SUM_k conj(y_k) x_{k + j + i}, markers counted round the curve; j + SHIFTS is at most n. */
static void CorrelateShifts(PetscInt n, PetscInt j, const PetscReal X[], const PetscReal Y[], PetscReal c[SHIFTS][2]) {
  const PetscInt whole = n - j - (SHIFTS - 1); /* up to here no shift goes past the last marker, from n - j on all do */
  ShiftProducts sum = {{{0}}, {{0}}};
  AddShiftProducts(whole, X + 2 * j, Y, &sum);
  for (PetscInt k = whole; k < n - j; k++)
    for (int i = 0; i < SHIFTS; i++) AddShiftPoints(OnePoint(Y + 2 * k), OnePoint(X + 2 * ((k + j + i) % n)), i, &sum);
  AddShiftProducts(j, X, Y + 2 * (n - j), &sum);
  for (int i = 0; i < SHIFTS; i++) LanesTwoSums(sum.same[i], sum.cross[i], &c[i][0], &c[i][1]);
}

RigidFit RigidFitCurves(PetscInt n, const PetscReal X[], const PetscReal Y[]) {
  RigidFit fit = {.turn = {1, 0}};
  PetscReal squares = 0, largest = -1;
  for (PetscInt k = 0; k < 2 * n; k++) squares += X[k] * X[k] + Y[k] * Y[k];
  for (PetscInt from = 0; from < n; from += SHIFTS) {
    const PetscInt j = PetscMin(from, n - SHIFTS); /* the last ones overlap those before */
    PetscReal c[SHIFTS][2];
    CorrelateShifts(n, j, X, Y, c);
    for (int i = 0; i < SHIFTS; i++) {
      const PetscReal size = c[i][0] * c[i][0] + c[i][1] * c[i][1];
      if (size <= (1 + SAME) * largest) continue; /* of a symmetric curve the first, whatever rounding does */
      largest = size;
      fit.shift = j + i;
      fit.turn[0] = c[i][0];
      fit.turn[1] = c[i][1];
    }
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
