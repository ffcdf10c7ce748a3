/* Initial markers for spectral edges: a curve that M markers can carry exactly. */
#include "scene/scene.h"
#include <petscblaslapack.h>

/* D[k][l] = d(k - l): the derivative with respect to the marker index of the trigonometric interpolant (for even M
   without its highest wave). */
static void IndexDerivative(PetscInt M, PetscReal d[]) {
  d[0] = 0;
  for (PetscInt j = 1; j < M; j++) {
    const PetscReal x = PETSC_PI * j / M;
    d[j] = PETSC_PI / M * (j % 2 ? -1 : 1) / (M % 2 ? PetscSinReal(x) : PetscTanReal(x));
  }
}

/* e = D X, r = {|e_k|^2 - ds^2, 2 (area - wanted)}; returns the largest, relative. */
static PetscReal Residual(PetscInt M, const PetscReal d[], const PetscReal X[], PetscReal ds, PetscReal area,
                          PetscReal e[], PetscReal r[]) {
  PetscReal worst = 0;
  r[M] = -2 * area;
  for (PetscInt k = 0; k < M; k++) {
    e[2 * k] = e[2 * k + 1] = 0;
    for (PetscInt l = 0; l < M; l++)
      for (int c = 0; c < 2; c++) e[2 * k + c] += (k >= l ? d[k - l] : -d[l - k]) * X[2 * l + c];
    r[k] = PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]) - ds * ds;
    r[M] += X[2 * k] * e[2 * k + 1] - X[2 * k + 1] * e[2 * k];
    worst = PetscMax(worst, PetscAbsReal(r[k]) / (ds * ds));
  }
  return PetscMax(worst, PetscAbsReal(r[M]) / (2 * area));
}

/* The rows' gradient C[M+1][2M]: 2 e_k . D, and 2 (e_y, -e_x) because D is antisymmetric. */
static void Gradient(PetscInt M, const PetscReal d[], const PetscReal e[], PetscReal C[]) {
  for (PetscInt k = 0; k < M; k++) {
    for (PetscInt l = 0; l < M; l++)
      for (int c = 0; c < 2; c++) C[k * 2 * M + 2 * l + c] = 2 * e[2 * k + c] * (k >= l ? d[k - l] : -d[l - k]);
    C[M * 2 * M + 2 * k] = 2 * e[2 * k + 1];
    C[M * 2 * M + 2 * k + 1] = -2 * e[2 * k];
  }
}

PetscErrorCode CurveFitSpectral(PetscInt M, PetscReal length, PetscReal area, PetscReal X[]) {
  const PetscBLASInt rows = (PetscBLASInt)M + 1, columns = 2 * (PetscBLASInt)M, one = 1;
  const PetscReal plus = 1, minus = -1, zero = 0;
  PetscReal *d, *e, *r, *C, *CC;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc5(M, &d, 2 * M, &e, M + 1, &r, (M + 1) * 2 * M, &C, (M + 1) * (M + 1), &CC));
  IndexDerivative(M, d);
  for (int it = 0; it < 20; it++) { /* Newton with the smallest change of the markers */
    if (Residual(M, d, X, length / M, area, e, r) < 1e-13) break;
    Gradient(M, d, e, C);
    PetscCallBLAS("BLASgemm",
                  BLASgemm_("T", "N", &rows, &rows, &columns, &plus, C, &columns, C, &columns, &zero, CC, &rows));
    PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, CC, &rows, &info));
    if (info) break; /* a circle has no freedom left: it stays as it is */
    PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &rows, &one, CC, &rows, r, &rows, &info));
    PetscCallBLAS("BLASgemv", BLASgemv_("N", &columns, &rows, &minus, C, &columns, r, &one, &plus, X, &one));
  }
  PetscCall(PetscFree5(d, e, r, C, CC));
  PetscFunctionReturn(PETSC_SUCCESS);
}
