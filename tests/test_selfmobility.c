/* Self-mobility: the constants and symbols are the kernels', Theta only dissipates, R undoes what it should. */
#include "world.h"
#include "coupling/blas.h"
#include "coupling/selfmobility.h"

#define BOX "-domain_cells 64,64 -domain_box -1,1,-1,1 -vesicle_semi_axes 0.25,0.45 -vesicle_angle 25 "
#define NU 0.7

static const struct {
  const char *name;
  PetscReal c1;
} kernels[] = {{"ib6", .4806}, {"cbs32", .2589}, {"cbs43", .3062}, {"cbs54", .3469}, {"cbs65", .3833}};

/* The grid's sums along a line: at n points of a B-spline the integral c1 of the spline with n - 1, because (phi*phi)''
   is the second difference of the lower splines' product; c1 is the
   mean of a composite kernel's two splines and c that of the one across, hence of two kernels. */
static PetscErrorCode CheckConstants(void) {
  PetscFunctionBeginUser;
  for (int k = 2; k < 4; k++) {
    PetscReal low[2], high[2];
    PetscCall(SmoothingConstants(KernelFind(kernels[k].name), low));
    PetscCall(SmoothingConstants(KernelFind(kernels[k + 1].name), high));
    const PetscReal mean = 0.5 * (low[0] + high[0]);
    CHECK(PetscAbsReal(mean - kernels[k - 1].c1) < 6e-5, "along a line, mean of %s and %s: c = %.5f, c1 of %s %.4f",
          kernels[k].name, kernels[k + 1].name, mean, kernels[k - 1].name, kernels[k - 1].c1);
    CHECK(high[1] > 1.1 * high[0], "%s: more is lost along a diagonal, c = %.4f and %.4f", kernels[k + 1].name, high[1],
          high[0]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Long waves: dT = h c/nu, dN = 0 to first order in h, at any h and nu, along grid lines and diagonals: the symbols'
   integrals over wave numbers against the sums over weights. */
static PetscErrorCode CheckLongWaves(void) {
  const PetscReal h = 0.03, small[] = {0.08, 0.02};
  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++)
    for (int d = 0; d < 2; d++) {
      const Kernel *kernel = KernelFind(kernels[k].name);
      PetscReal error[2] = {0, 0}, dT[64], dN[64], dX[64], c[2], cross = 0;
      PetscCall(SmoothingConstants(kernel, c));
      const PetscReal limit = h * c[d] / NU;
      for (int s = 0; s < 2; s++) { /* k h and (a0 h^2/nu)^(1/2) */
        PetscCall(PlaneSymbols(kernel, h, NU * PetscSqr(small[s] / h), NU, d * PETSC_PI / 4, 64,
                               2 * PETSC_PI * h / small[s], dT, dN, dX));
        error[s] = PetscMax(PetscAbsReal(dT[1] / limit - 1), dN[1] / limit);
      }
      CHECK(error[1] < 0.05 && error[1] < 0.4 * error[0],
            "%s, %s: dT to h c/nu and dN to 0 for long waves: apart by %.1e at k h = %g, %.1e at %g", kernels[k].name,
            d ? "diagonal" : "line", error[0], small[0], error[1], small[1]);
      error[0] = error[1] = 0;
      for (int q = 0; q < 64; q++) {
        error[0] = PetscMax(error[0], PetscMax(-dT[q], -dN[q]));
        if (q) error[1] = PetscMax(error[1], PetscAbsReal(dT[q] - dT[64 - q]) + PetscAbsReal(dN[q] - dN[64 - q]));
        cross = PetscMax(cross, PetscAbsReal(dX[q]) / limit);
      }
      CHECK(error[0] <= 0 && error[1] == 0, "%s: symbols are even and nowhere negative", kernels[k].name);
      CHECK(cross < 1e-10, "%s, %s: no velocity across the force, by symmetry: %.1e", kernels[k].name,
            d ? "diagonal" : "line", cross);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* max |n^T Theta| over max |Theta|, n the normals: of spectral edges, or of fourth-order differences. */
static PetscErrorCode Flux(TestWorld *w, const PetscScalar X[], const PetscReal Theta[], PetscReal largest,
                           PetscReal *worst) {
  const PetscInt M = w->layout->n;
  PetscReal *e;
  PetscFunctionBeginUser;
  *worst = 0;
  PetscCall(PetscMalloc1(2 * M, &e));
  MembraneEdges(w->membrane, 0, X, e);
  for (PetscInt k = 0; k < M && w->membrane->derivative != DERIVATIVE_SPECTRAL; k++)
    for (PetscInt c = 0; c < 2; c++)
      e[2 * k + c] = 8 * (X[2 * ((k + 1) % M) + c] - X[2 * ((k + M - 1) % M) + c]) -
                     (X[2 * ((k + 2) % M) + c] - X[2 * ((k + M - 2) % M) + c]);
  for (PetscInt j = 0; j < 2 * M; j++) {
    PetscReal flux = 0;
    for (PetscInt k = 0; k < M; k++)
      flux += (e[2 * k + 1] * Theta[2 * k * 2 * M + j] - e[2 * k] * Theta[(2 * k + 1) * 2 * M + j]) /
              PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    *worst = PetscMax(*worst, PetscAbsReal(flux) / largest);
  }
  PetscCall(PetscFree(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Least x^T Theta x over |x|^2 max|Theta| of 50 vectors x, half of them smooth. */
static PetscErrorCode LeastProduct(PetscInt n, const PetscReal Theta[], PetscReal largest, PetscReal *least) {
  unsigned seed = 11;
  PetscReal *x;
  PetscFunctionBeginUser;
  *least = PETSC_MAX_REAL;
  PetscCall(PetscMalloc1(n, &x));
  for (int trial = 0; trial < 50; trial++) {
    PetscReal product = 0, square = 0;
    for (PetscInt i = 0; i < n; i++) {
      x[i] = TestRandom(&seed);
      if (trial % 2) x[i] += (i > 1 ? x[i - 2] : 0); /* smooth ones too */
    }
    for (PetscInt i = 0; i < n; i++) {
      square += PetscSqr(x[i]);
      for (PetscInt j = 0; j < n; j++) product += x[i] * Theta[i * n + j] * x[j];
    }
    *least = PetscMin(*least, product / (square * largest));
  }
  PetscCall(PetscFree(x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Whether the eigenvalues of Theta are above -1e-12 of its largest entry: Cholesky's factor exists a little above. */
static PetscErrorCode NoneNegative(PetscInt n, const PetscReal Theta[], PetscReal largest, PetscBool *factored) {
  PetscReal *shifted;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * n, &shifted));
  PetscCall(PetscArraycpy(shifted, Theta, n * n));
  for (PetscInt i = 0; i < n; i++) shifted[i * n + i] += 1e-12 * largest;
  PetscCall(DenseFactorSymmetric(n, shifted, factored));
  PetscCall(PetscFree(shifted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A world of one vesicle with the self-mobility of its membrane, at the initial markers for a0. */
static PetscErrorCode Create(const char options[], SelfMobilityType type, PetscReal a0, TestWorld *w,
                             SelfMobility *self) {
  const PetscScalar *X;
  PetscBool factored;
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, w));
  PetscCall(SelfMobilityCreate(w->coupling->markers, w->membrane, NU, type, self));
  PetscCall(VecGetArrayRead(w->X, &X));
  PetscCall(SelfMobilityPlace(*self, a0, X, &factored));
  PetscCall(VecRestoreArrayRead(w->X, &X));
  CHECK(factored, "   Theta has a factor with bending");
  PetscFunctionReturn(PETSC_SUCCESS);
}

enum { FLUX, ASYMMETRY, LEAST, FACTORED, FOUND };

/* What the vesicle's owner finds in Theta, on every rank. */
static PetscErrorCode LookAtTheta(TestWorld *w, SelfMobility self, PetscReal found[FOUND]) {
  const PetscInt n = 2 * w->layout->n;
  const PetscScalar *X;
  PetscReal largest = 0, asymmetry = 0;
  PetscBool factored;
  PetscFunctionBeginUser;
  if (n) {
    const PetscReal *Theta = SelfMobilityBlock(self, 0);
    for (PetscInt i = 0; i < n; i++)
      for (PetscInt j = 0; j < n; j++) {
        largest = PetscMax(largest, PetscAbsReal(Theta[i * n + j]));
        asymmetry = PetscMax(asymmetry, PetscAbsReal(Theta[i * n + j] - Theta[j * n + i]));
      }
    PetscCall(VecGetArrayRead(w->X, &X));
    PetscCall(Flux(w, X, Theta, largest, &found[FLUX]));
    PetscCall(VecRestoreArrayRead(w->X, &X));
    found[ASYMMETRY] = asymmetry / largest;
    PetscCall(LeastProduct(n, Theta, largest, &found[LEAST]));
    PetscCall(NoneNegative(n, Theta, largest, &factored));
    found[FACTORED] = factored;
  }
  PetscCall(TestWorldShare(w, FOUND, found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Theta = Theta^T, x^T Theta x >= 0, and no flux through the membrane. */
static PetscErrorCode CheckTheta(SelfMobilityType type, const char *derivative, const char *kernel, PetscReal a0) {
  char options[512], name[128];
  TestWorld w;
  SelfMobility self;
  PetscReal found[FOUND];
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(name, sizeof(name), "%s, %s, %s, a0 = %g", type == SELF_LOCAL ? "local" : "symbol", kernel,
                          derivative, (double)a0));
  PetscCall(PetscSNPrintf(options, sizeof(options), BOX "-delta_type %s -membrane_derivative %s", kernel, derivative));
  PetscCall(Create(options, type, a0, &w, &self));
  PetscCall(LookAtTheta(&w, self, found));
  CHECK(found[FLUX] < 1e-13, "%s: no flux through the membrane, %.1e", name, found[FLUX]);
  CHECK(found[ASYMMETRY] < 1e-14, "%s: Theta is symmetric to %.1e", name, found[ASYMMETRY]);
  CHECK(found[FACTORED] > 0, "%s: no eigenvalue of Theta below -1e-12", name);
  CHECK(found[LEAST] > 0, "%s: x^T Theta x >= %.2e |x|^2 max|Theta|", name, found[LEAST]);
  PetscCall(SelfMobilityDestroy(&self));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* R = (I + Theta K)^-1 undoes I + Theta K, for stiffness over many decades. */
static PetscErrorCode CheckR(SelfMobilityType type, const char *derivative, PetscReal bending) {
  const PetscReal a0 = 20;
  char options[512];
  TestWorld w;
  SelfMobility self;
  const PetscScalar *X;
  PetscReal *known, *U, found[2] = {0, 0}; /* error, size */
  unsigned seed = 17;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), BOX "-delta_type cbs54 -membrane_derivative %s -vesicle_bending %g",
                          derivative, (double)bending));
  PetscCall(Create(options, type, a0, &w, &self));
  const PetscInt n = 2 * w.layout->n;
  PetscCall(PetscCalloc2(n, &known, n, &U));
  PetscCall(VecGetArrayRead(w.X, &X));
  for (PetscInt k = 0; k < n; k++) known[k] = X[k] + 0.1 * TestRandom(&seed);
  PetscCall(VecRestoreArrayRead(w.X, &X));
  MembraneBending(w.membrane, w.membrane->bending / a0, known, U);
  PetscCall(SelfMobilityMultTheta(self, U));
  for (PetscInt k = 0; k < n; k++) {
    U[k] += known[k];
    found[1] = PetscMax(found[1], PetscAbsReal(U[k]));
  }
  PetscCall(SelfMobilityApply(self, w.coupling->tau, NULL, NULL, U));
  for (PetscInt k = 0; k < n; k++) found[0] = PetscMax(found[0], PetscAbsReal(U[k] - known[k]));
  PetscCall(TestWorldShare(&w, 2, found));
  CHECK(found[0] < 1e-14 * found[1], "%s, %s, c_b = %g: R (I + Theta K) U is U to %.1e of %.1e",
        type == SELF_LOCAL ? "local" : "symbol", derivative, bending, found[0], found[1]);
  PetscCall(PetscFree2(known, U));
  PetscCall(SelfMobilityDestroy(&self));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  static const char *const derivatives[] = {"fd", "bending", "spectral"};
  PetscFunctionBeginUser;
  PetscCall(CheckConstants());
  PetscCall(CheckLongWaves());
  for (int k = 0; k < 3; k++)
    for (int a = 0; a < 2; a++) {
      PetscCall(CheckTheta(SELF_LOCAL, derivatives[k], "cbs54", a ? 5000 : 20));
      PetscCall(CheckTheta(SELF_SYMBOL, derivatives[k], a ? "cbs54" : "ib6", a ? 5000 : 20));
    }
  for (int k = 0; k < 3; k++)
    for (int e = -4; e <= 4; e += 2) {
      PetscCall(CheckR(SELF_LOCAL, derivatives[k], PetscPowReal(10, e)));
      PetscCall(CheckR(SELF_SYMBOL, derivatives[k], PetscPowReal(10, e)));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
