/* Matrices of the preconditioner's block of obstacles: a symmetric product in single precision against the plain sum,
   and the waves of a curve against what they are fitted to. */
#include "check.h"
#include "coupling/symmetric.h"
#include "coupling/waves.h"

/* Products with a matrix of n rows, and its inverse. */
static PetscErrorCode CheckSymmetric(PetscInt n) {
  float *A, *copy, *packed, *x, *y;
  PetscReal product = 0, inverse = 0;
  PetscBool done;
  unsigned seed = 5;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(n * n, &A, n * n, &copy, SymmetricSize(n), &packed, n, &x, n, &y));
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
    product = PetscMax(product, PetscAbsReal(y[i] - sum));
  }
  PetscCall(SymmetricInvert(n, copy, packed, &done));
  for (PetscInt i = 0; i < n; i++) copy[i] = y[i];
  SymmetricMult(n, packed, copy, y);
  for (PetscInt i = 0; i < n; i++) inverse = PetscMax(inverse, PetscAbsReal(y[i] - x[i]));
  CHECK(product < 1e-6 * n, "%d rows: a product is off by %.1e", (int)n, (double)product);
  CHECK(done && inverse < 1e-5, "%d rows: its inverse gives back what went in to %.1e", (int)n, (double)inverse);
  PetscCall(PetscFree5(A, copy, packed, x, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Waves are orthonormal, and a sum of them is found again from its values at a few places. */
static PetscErrorCode CheckWaves(PetscBool open, PetscInt n, PetscInt count) {
  Waves w;
  PetscReal *x, *a, *b, off = 0, fit = 0;
  unsigned seed = 7;
  PetscFunctionBeginUser;
  PetscCall(WavesCreate(open, n, count, &w));
  PetscCall(PetscMalloc3(2 * n, &x, 2 * count, &a, 2 * count, &b));
  for (PetscInt k = 0; k < 2 * count; k++) a[k] = TestRandom(&seed);
  WavesSum(&w, a, x);
  WavesOf(&w, x, b);
  for (PetscInt m = 0; m < count; m++)
    for (int c = 0; c < 2; c++) {
      PetscReal sum = 0;
      for (PetscInt s = 0; s < w.places; s++) sum += w.fit[m * w.places + s] * x[2 * w.place[s] + c];
      off = PetscMax(off, PetscAbsReal(b[2 * m + c] - a[2 * m + c]));
      fit = PetscMax(fit, PetscAbsReal(sum - a[2 * m + c]));
    }
  CHECK(off < 1e-13, "%d waves on %d markers are orthonormal to %.1e", (int)count, (int)n, (double)off);
  CHECK(fit < 1e-10, "and found from %d of them to %.1e", (int)w.places, (double)fit);
  PetscCall(PetscFree3(x, a, b));
  PetscCall(WavesDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  for (PetscInt n = 1; n < 24; n += n < 12 ? 1 : 5) PetscCall(CheckSymmetric(n));
  for (int open = 0; open < 2; open++) {
    PetscCall(CheckWaves(open, 67, 9));
    PetscCall(CheckWaves(open, 15, 9));
    PetscCall(CheckWaves(open, 17, 1));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
