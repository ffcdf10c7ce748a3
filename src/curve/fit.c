/* The markers of a closed curve moved as little as possible until their edges and their area are what they
   should be. */
#include "curve/curve.h"
#include <petscblaslapack.h>

#define CONVERGED 1e-13 /* squared edges and area, relative */

/* D[k][l] = d[k - l], d[-(M-1)..M-1]: the derivative with respect to the marker index. */
typedef PetscReal *IndexDerivative;

/* Of the trigonometric interpolant (for even M without its highest wave). */
static void SpectralIndexDerivative(PetscInt M, IndexDerivative d) {
  d[0] = 0;
  for (PetscInt j = 1; j < M; j++) {
    const PetscReal x = PETSC_PI * j / M;
    d[j] = PETSC_PI / M * (j % 2 ? -1 : 1) / (M % 2 ? PetscSinReal(x) : PetscTanReal(x));
    d[-j] = -d[j];
  }
}

/* Half the difference of the neighbours, or (chord) of a marker and the one before. */
static void DifferenceDerivative(PetscInt M, PetscBool chord, IndexDerivative d) {
  (void)PetscArrayzero(d - (M - 1), 2 * M - 1);
  d[0] = chord ? 1 : 0;
  d[1] = d[1 - M] = chord ? -1 : -0.5;
  if (!chord) d[-1] = d[M - 1] = 0.5;
}

/* e = D X */
static void Derivative(PetscInt M, const PetscReal d[], const PetscReal X[], PetscReal e[]) {
  for (PetscInt k = 0; k < M; k++) {
    e[2 * k] = e[2 * k + 1] = 0;
    for (PetscInt l = 0; l < M; l++)
      for (int c = 0; c < 2; c++) e[2 * k + c] += d[k - l] * X[2 * l + c];
  }
}

/* r = {|e_k|^2 - ds^2, 2 (A - wanted)}, 2A = SUM X x a for the edges e and an antisymmetric derivative a; returns the
   largest, relative. */
static PetscReal Residual(PetscInt M, const PetscReal X[], PetscReal ds, PetscReal area, const PetscReal e[],
                          const PetscReal a[], PetscReal r[]) {
  PetscReal worst = 0;
  r[M] = -2 * area;
  for (PetscInt k = 0; k < M; k++) {
    r[k] = PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]) - ds * ds;
    r[M] += X[2 * k] * a[2 * k + 1] - X[2 * k + 1] * a[2 * k];
    worst = PetscMax(worst, PetscAbsReal(r[k]) / (ds * ds));
  }
  if (PetscIsInfOrNanReal(r[M])) return PETSC_MAX_REAL;
  return PetscMax(worst, PetscAbsReal(r[M]) / (2 * area));
}

/* The rows' gradient C[M+1][2M]: 2 e_k . D, and 2 (a_y, -a_x) because the derivative of a is antisymmetric. */
static void Gradient(PetscInt M, const PetscReal d[], const PetscReal e[], const PetscReal a[], PetscReal C[]) {
  for (PetscInt k = 0; k < M; k++) {
    for (PetscInt l = 0; l < M; l++)
      for (int c = 0; c < 2; c++) C[k * 2 * M + 2 * l + c] = 2 * e[2 * k + c] * d[k - l];
    C[M * 2 * M + 2 * k] = 2 * a[2 * k + 1];
    C[M * 2 * M + 2 * k + 1] = -2 * a[2 * k];
  }
}

/* X -= C^T (C C^T)^-1 r, the least change; false when the rows do not determine it. */
static PetscErrorCode LeastChange(PetscInt M, const PetscReal C[], PetscReal CC[], PetscReal r[], PetscReal X[],
                                  PetscBool *solved) {
  const PetscBLASInt rows = (PetscBLASInt)M + 1, columns = 2 * (PetscBLASInt)M, one = 1;
  const PetscReal plus = 1, minus = -1, zero = 0;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  PetscCallBLAS("BLASgemm",
                BLASgemm_("T", "N", &rows, &rows, &columns, &plus, C, &columns, C, &columns, &zero, CC, &rows));
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, CC, &rows, &info));
  *solved = info ? PETSC_FALSE : PETSC_TRUE;
  if (info) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &rows, &one, CC, &rows, r, &rows, &info));
  PetscCallBLAS("BLASgemv", BLASgemv_("N", &columns, &rows, &minus, C, &columns, r, &one, &plus, X, &one));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[], PetscInt most,
                        PetscReal *left) {
  PetscReal *memory[2], *e, *a, *r, *C, *CC;
  IndexDerivative edge, central;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc7(2 * M, &memory[0], 2 * M, &memory[1], 2 * M, &e, 2 * M, &a, M + 1, &r, (M + 1) * 2 * M, &C,
                         (M + 1) * (M + 1), &CC));
  edge = memory[0] + M - 1;
  central = memory[1] + M - 1;
  if (spectral) {
    SpectralIndexDerivative(M, edge);
    SpectralIndexDerivative(M, central);
  } else {
    DifferenceDerivative(M, PETSC_TRUE, edge);
    DifferenceDerivative(M, PETSC_FALSE, central);
  }
  for (PetscInt it = 0;; it++) { /* Newton with the smallest change of the markers */
    PetscBool solved = PETSC_FALSE;
    Derivative(M, edge, X, e);
    Derivative(M, central, X, a);
    *left = Residual(M, X, length / M, area, e, a, r);
    if (it == most || *left < CONVERGED) break;
    Gradient(M, edge, e, a, C);
    PetscCall(LeastChange(M, C, CC, r, X, &solved));
    if (!solved) break; /* a circle has no freedom left: it stays as it is */
  }
  PetscCall(PetscFree7(memory[0], memory[1], e, a, r, C, CC));
  PetscFunctionReturn(PETSC_SUCCESS);
}
