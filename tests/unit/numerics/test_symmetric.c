/* Matrices of the preconditioner's block of obstacles: a symmetric product in single precision against the plain sum,
   and interpolation between markers and points of a curve. */
#include "facts.h"
#include "numerics/symmetric.h"
#include "precondition/curvepoints.h"

/* Products with a matrix of n rows, and its inverse. */
static void CheckSymmetric(PetscInt n) {
  float *A, *packed, *x, *y;
  PetscReal *copy;
  PetscReal product = 0, inverse = 0;
  PetscBool done;
  unsigned seed = 5;
  TestCall(PetscMalloc5(n * n, &A, n * n, &copy, SymmetricSize(n), &packed, n, &x, n, &y));
  for (PetscInt j = 0; j < n; j++) {
    x[j] = (float)TestRandom(&seed);
    for (PetscInt i = 0; i <= j; i++) A[j * n + i] = A[i * n + j] = (float)TestRandom(&seed) + (i == j ? 2 * n : 0);
  }
  for (PetscInt k = 0; k < n * n; k++) copy[k] = A[k];
  SymmetricPack(n, A, packed);
  SymmetricMult(n, packed, x, y);
  for (PetscInt i = 0; i < n; i++) {
    PetscReal sum = 0;
    for (PetscInt j = 0; j < n; j++) sum += (PetscReal)A[j * n + i] * x[j];
    TestWorse(&product, y[i] - sum);
  }
  TestCall(SymmetricInvert(n, copy, packed, &done));
  SymmetricMult(n, packed, y, A);
  for (PetscInt i = 0; i < n; i++) TestWorse(&inverse, A[i] - x[i]);
  CheckBelow(product, 1e-6 * n, "%d rows: a product", (int)n);
  CHECK(done && inverse < 1e-5, "%d rows: its inverse gives back what went in to %.1e", (int)n, inverse);
  TestCall(PetscFree5(A, copy, packed, x, y));
}

/* Values at points give values at the markers that give them back, and a cosine is a cosine at the markers. */
static void CheckPoints(PetscBool open, PetscInt n, PetscInt points) {
  CurvePoints w;
  PetscReal off = 0, wave = 0;
  unsigned seed = 7;
  TestCall(CurvePointsCreate(open, n, points, &w));
  PetscReal *x = TestReals(2 * n), *value = TestReals(2 * points);
  for (PetscInt i = 0; i < points; i++) {
    value[2 * i] = TestRandom(&seed);
    value[2 * i + 1] = points < 3 ? 1 : PetscCosReal(open ? PETSC_PI * (i + 0.5) / points : 2 * PETSC_PI * i / points);
    for (PetscInt k = 0; k < 2 * n; k++) x[k] += w.to_markers[i * n + k / 2] * value[2 * i + k % 2];
  }
  for (PetscInt i = 0; i < points; i++) {
    PetscReal sum = 0;
    for (PetscInt k = 0; k < n; k++) sum += w.to_points[i * n + k] * x[2 * k];
    TestWorse(&off, sum - value[2 * i]);
  }
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal angle = open ? PETSC_PI * (k + 0.5) / n : 2 * PETSC_PI * k / n;
    TestWorse(&wave, x[2 * k + 1] - (points < 3 ? 1 : PetscCosReal(angle)));
  }
  CheckBelow(off, 1e-13, "%d points on %d markers have their values again", (int)points, (int)n);
  CheckBelow(wave, 1e-13, "and the first cosine is interpolated");
  TestCall(CurvePointsDestroy(&w));
}

void Facts(void) {
  for (PetscInt n = 1; n < 24; n += n < 12 ? 1 : 5) CheckSymmetric(n);
  for (int open = 0; open < 2; open++) {
    CheckPoints(open, 67, 9);
    CheckPoints(open, 15, 9);
    CheckPoints(open, 17, 1);
  }
}
