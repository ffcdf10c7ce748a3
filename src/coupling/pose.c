#include "coupling/pose.h"

void PoseCentred(PetscInt n, const PetscReal X[], PetscReal Y[]) {
  PetscReal mean[2] = {0, 0};
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) mean[c] += X[2 * k + c] / n;
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) Y[2 * k + c] = X[2 * k + c] - mean[c];
}

void PoseSizes(PetscInt n, const PetscReal X[], PetscReal size[POSE_SIZES]) {
  PetscReal rest = 0;
  for (PetscInt k = 0; k < 2 * n; k++) rest += X[k] * X[k] / (PetscReal)n;
  for (int q = 0; q < POSE_SIZES - 1; q++) {
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
  size[POSE_SIZES - 1] = PetscSqrtReal(PetscMax(rest, 0));
}

PetscReal PoseLeast(const PetscReal a[POSE_SIZES], const PetscReal b[POSE_SIZES]) {
  PetscReal sum = 0;
  for (int q = 0; q < POSE_SIZES; q++) sum += PetscSqr(a[q] - b[q]);
  return PetscSqrtReal(sum);
}

/* SUM_k conj(y_k) x_k: real, imaginary. */
static inline void AddProduct(PetscInt n, const PetscReal X[], const PetscReal Y[], PetscReal c[2]) {
  PetscReal xx = 0, xy = 0, yx = 0, yy = 0;
  for (PetscInt k = 0; k < n; k++) {
    xx += Y[2 * k] * X[2 * k];
    yy += Y[2 * k + 1] * X[2 * k + 1];
    xy += Y[2 * k] * X[2 * k + 1];
    yx += Y[2 * k + 1] * X[2 * k];
  }
  c[0] += xx + yy;
  c[1] += xy - yx;
}

Pose PoseFit(PetscInt n, const PetscReal X[], const PetscReal Y[]) {
  Pose pose = {.turn = {1, 0}};
  PetscReal squares = 0, largest = -1;
  for (PetscInt k = 0; k < 2 * n; k++) squares += X[k] * X[k] + Y[k] * Y[k];
  for (PetscInt j = 0; j < n; j++) {
    PetscReal c[2] = {0, 0};
    AddProduct(n - j, X + 2 * j, Y, c);
    AddProduct(j, X, Y + 2 * (n - j), c);
    const PetscReal size = c[0] * c[0] + c[1] * c[1];
    if (size <= largest) continue;
    largest = size;
    pose.shift = j;
    pose.turn[0] = c[0];
    pose.turn[1] = c[1];
  }
  const PetscReal size = PetscSqrtReal(PetscMax(largest, 0));
  for (int c = 0; c < 2; c++) pose.turn[c] = size > 0 ? pose.turn[c] / size : !c;
  pose.distance = PetscSqrtReal(PetscMax(squares - 2 * size, 0) / (PetscReal)n);
  return pose;
}

void PoseTurn(const Pose *p, PetscBool back, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscReal c = p->turn[0], s = back ? -p->turn[1] : p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    y[2 * k] = c * x[2 * k] - s * x[2 * k + 1];
    y[2 * k + 1] = s * x[2 * k] + c * x[2 * k + 1];
  }
}

/* y = x of n markers, vectors turned. */
static void Copy(const Pose *p, PetscBool back, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  if (each == 2)
    PoseTurn(p, back, n, x, y);
  else
    (void)PetscArraycpy(y, x, n);
}

void PoseInto(const Pose *p, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscInt j = p->shift;
  Copy(p, PETSC_TRUE, each, n - j, x + each * j, y);
  Copy(p, PETSC_TRUE, each, j, x, y + each * (n - j));
}

void PoseBack(const Pose *p, int each, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscInt j = p->shift;
  Copy(p, PETSC_FALSE, each, n - j, x, y + each * j);
  Copy(p, PETSC_FALSE, each, j, x + each * (n - j), y);
}
