/* CurveFit by Newton's method. The residuals of the markers X are

       r_k = |e_k|^2 - ds^2,   e = D X,      r_M = 2 (A - area),   2 A = SUM X_k x a_k,

   D is circulant, D_kl = d_{k - l}, and a is an antisymmetric derivative of X. Their gradients are the rows of C, 2 e_k
   . D and 2 z with z = (a_y, -a_x), and the smallest step that makes the linearised residuals zero is

       X -= C^T (C C^T)^-1 r. */
#include "curve/curve.h"
#include "numerics/circulant.h"
#include <petscblaslapack.h>

#define FIT_CONVERGED 1e-13 /* relative error of squared edges and of the area */

/* The arrays of one fit. */
typedef struct {
  PetscInt M;
  PetscReal *edge;             /* [M] d of the edges */
  PetscReal *products;         /* [M] (D D^T)_kl as a function of k - l */
  PetscReal *e, *a, *z, *work; /* [2M] e, a, z, work */
  PetscReal *twice;            /* [4M] an argument of D two times */
  PetscReal *r, *CC;           /* [M + 1], [(M + 1)^2] */
} Fit;

/* d of the derivative of the trigonometric interpolant, for even M without its highest mode. */
static void FitSpectralDerivative(PetscInt M, PetscReal d[]) {
  d[0] = 0;
  for (PetscInt j = 1; 2 * j <= M; j++) {
    const PetscReal x = PETSC_PI * j / M;
    d[j] = 2 * j == M ? 0 : PETSC_PI / M * (j % 2 ? -1 : 1) / (M % 2 ? PetscSinReal(x) : PetscTanReal(x));
    d[M - j] = -d[j];
  }
}

/* out = D x or, if transposed, D^T x, of `each` numbers a marker. */
static void FitMultiply(const Fit *f, const PetscReal d[], int each, PetscBool transposed, const PetscReal x[],
                        PetscReal out[]) {
  const PetscInt width = each * f->M;
  for (PetscInt i = 0; i < width; i++) f->twice[i] = f->twice[width + i] = x[i];
  CirculantConvolve(f->M, each, transposed, d, f->twice, out);
}

/* The residuals r; returns the largest relative one. */
static PetscReal FitResidual(PetscInt M, const PetscReal X[], PetscReal ds, PetscReal area, const PetscReal e[],
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

/* CC = C C^T, its lower triangle by columns. */
static void FitGradientProducts(const Fit *f) {
  const PetscInt M = f->M, rows = M + 1;
  const PetscReal *e = f->e, *z = f->z, *Dz = f->work;
  PetscReal *CC = f->CC;
  for (PetscInt k = 0; k < M; k++)
    for (PetscInt j = k; j < M; j++)
      CC[k * rows + j] = 4 * f->products[j - k] * (e[2 * k] * e[2 * j] + e[2 * k + 1] * e[2 * j + 1]);
  FitMultiply(f, f->edge, 2, PETSC_FALSE, z, f->work);
  CC[M * rows + M] = 0;
  for (PetscInt k = 0; k < M; k++) {
    CC[k * rows + M] = 4 * (e[2 * k] * Dz[2 * k] + e[2 * k + 1] * Dz[2 * k + 1]);
    CC[M * rows + M] += 4 * (z[2 * k] * z[2 * k] + z[2 * k + 1] * z[2 * k + 1]);
  }
}

/* X -= C^T (C C^T)^-1 r; solved is false when C C^T is singular. */
static PetscErrorCode FitLeastChange(const Fit *f, PetscReal X[], PetscBool *solved) {
  const PetscInt M = f->M;
  const PetscBLASInt rows = (PetscBLASInt)M + 1, one = 1;
  const PetscReal *r = f->r;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  FitGradientProducts(f);
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, f->CC, &rows, &info));
  *solved = info ? PETSC_FALSE : PETSC_TRUE;
  if (info) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &rows, &one, f->CC, &rows, f->r, &rows, &info));
  for (PetscInt k = 0; k < 2 * M; k++) f->a[k] = r[k / 2] * f->e[k];
  FitMultiply(f, f->edge, 2, PETSC_TRUE, f->a, f->work);
  for (PetscInt k = 0; k < 2 * M; k++) X[k] -= 2 * (r[M] * f->z[k] + f->work[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FitCreate(PetscInt M, PetscBool spectral, Fit *f) {
  const PetscInt room = 2 * M;
  PetscFunctionBeginUser;
  f->M = M;
  PetscCall(PetscCalloc6(M, &f->edge, room, &f->products, room, &f->e, room, &f->a, room, &f->z, room, &f->work));
  PetscCall(PetscMalloc3(2 * room, &f->twice, M + 1, &f->r, (M + 1) * (M + 1), &f->CC));
  f->edge[0] = 1; /* chords, each from the marker before */
  f->edge[1] = -1;
  if (spectral) FitSpectralDerivative(M, f->edge);
  FitMultiply(f, f->edge, 1, PETSC_TRUE, f->edge, f->products); /* SUM_q d_q d_{q + j}, even in j */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FitDestroy(Fit *f) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(f->edge, f->products, f->e, f->a, f->z, f->work));
  PetscCall(PetscFree3(f->twice, f->r, f->CC));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[], PetscInt most,
                        PetscReal *left) {
  Fit f;
  PetscFunctionBeginUser;
  PetscCall(FitCreate(M, spectral, &f));
  for (PetscInt it = 0;; it++) {
    PetscBool solved = PETSC_FALSE;
    FitMultiply(&f, f.edge, 2, PETSC_FALSE, X, f.e);
    const PetscReal *a = spectral ? f.e : f.a;
    for (PetscInt k = 0; k < 2 * M && !spectral; k++) f.a[k] = 0.5 * (f.e[k] + f.e[(k + 2) % (2 * M)]);
    *left = FitResidual(M, X, length / M, area, f.e, a, f.r);
    if (it == most || *left < FIT_CONVERGED) break;
    for (PetscInt k = 0; k < M; k++) {
      f.z[2 * k] = a[2 * k + 1];
      f.z[2 * k + 1] = -a[2 * k];
    }
    PetscCall(FitLeastChange(&f, X, &solved));
    if (!solved) break; /* a circle has no freedom: it stays as it is */
  }
  PetscCall(FitDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}
