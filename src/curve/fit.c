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

/* CC = C C^T, its lower triangle by columns, C the rows' gradient: 2 e_k . D, and 2 z, z = (a_y, -a_x), because the
   derivative of a is antisymmetric. D is circulant, so (D D^T)_kl is one function of k - l. Dz is work. */
static void GradientProducts(PetscInt M, const PetscReal d[], const PetscReal e[], const PetscReal z[], PetscReal Dz[],
                             PetscReal CC[]) {
  const PetscInt rows = M + 1;
  for (PetscInt j = 0; j < M; j++) {
    PetscReal product = 0; /* of rows 0 and j of D */
    for (PetscInt l = 0; l < M; l++) product += d[-l] * d[j - l];
    for (PetscInt k = 0; k + j < M; k++)
      CC[k * rows + k + j] = 4 * product * (e[2 * k] * e[2 * (k + j)] + e[2 * k + 1] * e[2 * (k + j) + 1]);
  }
  Derivative(M, d, z, Dz);
  CC[M * rows + M] = 0;
  for (PetscInt k = 0; k < M; k++) {
    CC[k * rows + M] = 4 * (e[2 * k] * Dz[2 * k] + e[2 * k + 1] * Dz[2 * k + 1]);
    CC[M * rows + M] += 4 * (z[2 * k] * z[2 * k] + z[2 * k + 1] * z[2 * k + 1]);
  }
}

/* X -= C^T (C C^T)^-1 r, the least change; false when the rows do not determine it. Dz is work. */
static PetscErrorCode LeastChange(PetscInt M, const PetscReal d[], const PetscReal e[], const PetscReal z[],
                                  PetscReal Dz[], PetscReal CC[], PetscReal r[], PetscReal X[], PetscBool *solved) {
  const PetscBLASInt rows = (PetscBLASInt)M + 1, one = 1;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  GradientProducts(M, d, e, z, Dz, CC);
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, CC, &rows, &info));
  *solved = info ? PETSC_FALSE : PETSC_TRUE;
  if (info) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &rows, &one, CC, &rows, r, &rows, &info));
  for (PetscInt l = 0; l < M; l++) {
    PetscReal change[2] = {r[M] * z[2 * l], r[M] * z[2 * l + 1]};
    for (PetscInt k = 0; k < M; k++)
      for (int c = 0; c < 2; c++) change[c] += d[k - l] * r[k] * e[2 * k + c];
    for (int c = 0; c < 2; c++) X[2 * l + c] -= 2 * change[c];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[], PetscInt most,
                        PetscReal *left) {
  PetscReal *memory[2], *e, *a, *z, *r, *CC;
  IndexDerivative edge, central;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc7(2 * M, &memory[0], 2 * M, &memory[1], 2 * M, &e, 2 * M, &a, 2 * M, &z, M + 1, &r,
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
    for (PetscInt k = 0; k < M; k++) {
      z[2 * k] = a[2 * k + 1];
      z[2 * k + 1] = -a[2 * k];
    }
    PetscCall(LeastChange(M, edge, e, z, a, CC, r, X, &solved));
    if (!solved) break; /* a circle has no freedom left: it stays as it is */
  }
  PetscCall(PetscFree7(memory[0], memory[1], e, a, z, r, CC));
  PetscFunctionReturn(PETSC_SUCCESS);
}
