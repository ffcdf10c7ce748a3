/* The markers of a closed curve moved as little as possible until their edges and their area are what they
   should be. */
#include "curve/curve.h"
#include "curve/circulant.h"
#include <petscblaslapack.h>

#define CONVERGED 1e-13 /* squared edges and area, relative */

/* Of one fit. D is circulant: D[k][l] = d[k - l], markers counted round the curve, and (D D^T)_kl is a function of k -
   l alone. */
typedef struct {
  PetscInt M;
  PetscReal *edge, *central;   /* [M] d of the edges, and of the antisymmetric derivative of differences */
  PetscReal *products;         /* [M + CIRCULANT_PADDING] D D^T of the edges */
  PetscReal *e, *a, *z, *work; /* [2M + CIRCULANT_PADDING] edges, derivative, normals */
  PetscReal *twice;            /* [4M + CIRCULANT_PADDING] */
  PetscReal *r, *CC;           /* [M + 1] residuals, [(M + 1)^2] */
} Fit;

/* Of the trigonometric interpolant (for even M without its highest wave). */
static void SpectralIndexDerivative(PetscInt M, PetscReal d[]) {
  d[0] = 0;
  for (PetscInt j = 1; 2 * j <= M; j++) {
    const PetscReal x = PETSC_PI * j / M;
    d[j] = 2 * j == M ? 0 : PETSC_PI / M * (j % 2 ? -1 : 1) / (M % 2 ? PetscSinReal(x) : PetscTanReal(x));
    d[M - j] = -d[j];
  }
}

/* Half the difference of the neighbours, or (chord) of a marker and the one before. */
static void DifferenceDerivative(PetscInt M, PetscBool chord, PetscReal d[]) {
  (void)PetscArrayzero(d, M);
  d[0] = chord ? 1 : 0;
  d[1] = chord ? -1 : -0.5;
  if (!chord) d[M - 1] = 0.5;
}

/* out = D x of `each` numbers a marker, or (transposed) D^T x. */
static void FitMultiply(const Fit *f, const PetscReal d[], int each, PetscBool transposed, const PetscReal x[],
                        PetscReal out[]) {
  const PetscInt width = each * f->M;
  for (PetscInt i = 0; i < width; i++) f->twice[i] = f->twice[width + i] = x[i];
  for (PetscInt i = 2 * width; i < 2 * width + CIRCULANT_PADDING; i++) f->twice[i] = 0;
  CirculantConvolve(f->M, each, transposed, d, f->twice, out);
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
   derivative of a is antisymmetric. */
static void GradientProducts(const Fit *f) {
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

/* X -= C^T (C C^T)^-1 r, the least change; false when the rows do not determine it. */
static PetscErrorCode LeastChange(const Fit *f, PetscReal X[], PetscBool *solved) {
  const PetscInt M = f->M;
  const PetscBLASInt rows = (PetscBLASInt)M + 1, one = 1;
  const PetscReal *r = f->r;
  PetscBLASInt info;
  PetscFunctionBeginUser;
  GradientProducts(f);
  PetscCallBLAS("LAPACKpotrf", LAPACKpotrf_("L", &rows, f->CC, &rows, &info));
  *solved = info ? PETSC_FALSE : PETSC_TRUE;
  if (info) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallBLAS("LAPACKpotrs", LAPACKpotrs_("L", &rows, &one, f->CC, &rows, f->r, &rows, &info));
  for (PetscInt k = 0; k < 2 * M; k++) f->a[k] = r[k / 2] * f->e[k];
  FitMultiply(f, f->edge, 2, PETSC_TRUE, f->a, f->work);
  for (PetscInt k = 0; k < 2 * M; k++) X[k] -= 2 * (r[M] * f->z[k] + f->work[k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFit(PetscInt M, PetscBool spectral, Fit *f) {
  const PetscInt room = 2 * M + CIRCULANT_PADDING;
  PetscFunctionBeginUser;
  f->M = M;
  PetscCall(PetscMalloc7(M, &f->edge, M, &f->central, room, &f->products, room, &f->e, room, &f->a, room, &f->z, room,
                         &f->work));
  PetscCall(PetscMalloc3(2 * room, &f->twice, M + 1, &f->r, (M + 1) * (M + 1), &f->CC));
  if (spectral)
    SpectralIndexDerivative(M, f->edge);
  else {
    DifferenceDerivative(M, PETSC_TRUE, f->edge);
    DifferenceDerivative(M, PETSC_FALSE, f->central);
  }
  FitMultiply(f, f->edge, 1, PETSC_TRUE, f->edge, f->products); /* of d_q and d_{q + j}, even in j */
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyFit(Fit *f) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree7(f->edge, f->central, f->products, f->e, f->a, f->z, f->work));
  PetscCall(PetscFree3(f->twice, f->r, f->CC));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFit(PetscInt M, PetscBool spectral, PetscReal length, PetscReal area, PetscReal X[], PetscInt most,
                        PetscReal *left) {
  Fit f;
  PetscFunctionBeginUser;
  PetscCall(CreateFit(M, spectral, &f));
  for (PetscInt it = 0;; it++) { /* Newton with the smallest change of the markers */
    PetscBool solved = PETSC_FALSE;
    FitMultiply(&f, f.edge, 2, PETSC_FALSE, X, f.e);
    const PetscReal *a = spectral ? f.e : f.a;
    if (!spectral) FitMultiply(&f, f.central, 2, PETSC_FALSE, X, f.a);
    *left = Residual(M, X, length / M, area, f.e, a, f.r);
    if (it == most || *left < CONVERGED) break;
    for (PetscInt k = 0; k < M; k++) {
      f.z[2 * k] = a[2 * k + 1];
      f.z[2 * k + 1] = -a[2 * k];
    }
    PetscCall(LeastChange(&f, X, &solved));
    if (!solved) break; /* a circle has no freedom left: it stays as it is */
  }
  PetscCall(DestroyFit(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
}
