/* Self-mobility: the constants and symbols are the kernels', Theta only dissipates; spectral
   derivatives, spectral edges with their exact transposes, and the area target. */
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
static PetscReal Flux(Membrane m, const PetscScalar X[], const PetscReal Theta[], PetscReal largest) {
  const PetscInt M = m->M;
  PetscReal worst = 0, *e = m->work;
  MembraneEdges(m, 0, X, e);
  for (PetscInt k = 0; k < M && m->derivative != DERIVATIVE_SPECTRAL; k++)
    for (PetscInt c = 0; c < 2; c++)
      e[2 * k + c] = 8 * (X[2 * ((k + 1) % M) + c] - X[2 * ((k + M - 1) % M) + c]) -
                     (X[2 * ((k + 2) % M) + c] - X[2 * ((k + M - 2) % M) + c]);
  for (PetscInt j = 0; j < 2 * M; j++) {
    PetscReal flux = 0;
    for (PetscInt k = 0; k < M; k++)
      flux += (e[2 * k + 1] * Theta[2 * k * 2 * M + j] - e[2 * k] * Theta[(2 * k + 1) * 2 * M + j]) /
              PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    worst = PetscMax(worst, PetscAbsReal(flux) / largest);
  }
  return worst;
}

/* Theta = Theta^T, x^T Theta x >= 0, and no flux through the membrane. */
static PetscErrorCode CheckTheta(SelfMobilityType type, const char *derivative, const char *kernel, PetscReal a0) {
  const char *name = type == SELF_LOCAL ? "local" : "symbol";
  char options[512];
  TestWorld w;
  SelfMobility self;
  const PetscScalar *X;
  const PetscReal *Theta;
  PetscReal *shifted, asymmetry = 0, largest = 0, least = PETSC_MAX_REAL;
  PetscInt n;
  unsigned seed = 11;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), BOX "-delta_type %s -membrane_derivative %s", kernel, derivative));
  PetscCall(TestWorldCreate(options, &w));
  PetscCall(SelfMobilityCreate(w.coupling, NU, type, &self));
  PetscCall(VecGetArrayRead(w.X, &X));
  PetscCall(SelfMobilitySetMarkers(self, a0, X));
  PetscCall(VecRestoreArrayRead(w.X, &X));
  Theta = SelfMobilityBlock(self, 0);
  n = 2 * w.membrane->M;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < n; j++) {
      largest = PetscMax(largest, PetscAbsReal(Theta[i * n + j]));
      asymmetry = PetscMax(asymmetry, PetscAbsReal(Theta[i * n + j] - Theta[j * n + i]));
    }
  PetscCall(VecGetArrayRead(w.X, &X));
  const PetscReal flux = Flux(w.membrane, X, Theta, largest);
  PetscCall(VecRestoreArrayRead(w.X, &X));
  CHECK(flux < 1e-13, "%s, %s, %s, a0 = %g: no flux through the membrane, %.1e", name, kernel, derivative, a0, flux);
  for (int trial = 0; trial < 50; trial++) {
    PetscReal *x, product = 0, square = 0;
    PetscCall(PetscMalloc1(n, &x));
    for (PetscInt i = 0; i < n; i++) {
      x[i] = TestRandom(&seed);
      if (trial % 2) x[i] += (i > 1 ? x[i - 2] : 0); /* smooth ones too */
    }
    for (PetscInt i = 0; i < n; i++) {
      square += PetscSqr(x[i]);
      for (PetscInt j = 0; j < n; j++) product += x[i] * Theta[i * n + j] * x[j];
    }
    least = PetscMin(least, product / (square * largest));
    PetscCall(PetscFree(x));
  }
  CHECK(asymmetry < 1e-14 * largest, "%s, %s, %s, a0 = %g: Theta is symmetric to %.1e", name, kernel, derivative, a0,
        asymmetry / largest);
  /* all eigenvalues: Cholesky's factor exists a little above zero */
  PetscCall(PetscMalloc1(n * n, &shifted));
  PetscCall(PetscArraycpy(shifted, Theta, n * n));
  for (PetscInt i = 0; i < n; i++) shifted[i * n + i] += 1e-12 * largest;
  const PetscErrorCode failed = DenseFactorSymmetric(n, shifted);
  CHECK(!failed, "%s, %s, %s, a0 = %g: no eigenvalue of Theta below -1e-12", name, kernel, derivative, a0);
  PetscCall(PetscFree(shifted));
  CHECK(least > 0, "%s, %s, %s, a0 = %g: x^T Theta x >= %.2e |x|^2 max|Theta|", name, kernel, derivative, a0, least);
  PetscCall(SelfMobilityDestroy(&self));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* R = (I + Theta K)^-1 undoes I + Theta K, for stiffness over many decades. */
static PetscErrorCode CheckR(SelfMobilityType type, const char *derivative, PetscReal bending) {
  char options[512];
  TestWorld w;
  SelfMobility self;
  Membrane m;
  const PetscScalar *X;
  PetscReal *known, *U, *work, error = 0, size = 0;
  const PetscReal a0 = 20;
  unsigned seed = 17;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), BOX "-delta_type cbs54 -membrane_derivative %s -vesicle_bending %g",
                          derivative, (double)bending));
  PetscCall(TestWorldCreate(options, &w));
  m = w.membrane;
  PetscCall(SelfMobilityCreate(w.coupling, NU, type, &self));
  PetscCall(VecGetArrayRead(w.X, &X));
  PetscCall(SelfMobilitySetMarkers(self, a0, X));
  PetscCall(PetscCalloc3(2 * m->M, &known, 2 * m->M, &U, 2 * m->M, &work));
  for (PetscInt k = 0; k < 2 * m->M; k++) known[k] = X[k] + 0.1 * TestRandom(&seed);
  PetscCall(VecRestoreArrayRead(w.X, &X));
  MembraneBending(m, m->bending / a0, known, work, U);
  PetscCall(SelfMobilityMultTheta(self, U));
  for (PetscInt k = 0; k < 2 * m->M; k++) {
    U[k] += known[k];
    size = PetscMax(size, PetscAbsReal(U[k]));
  }
  PetscCall(SelfMobilityApply(self, NULL, NULL, U));
  for (PetscInt k = 0; k < 2 * m->M; k++) error = PetscMax(error, PetscAbsReal(U[k] - known[k]));
  CHECK(error < 1e-14 * size, "%s, %s, c_b = %g: R (I + Theta K) U is U to %.1e of %.1e",
        type == SELF_LOCAL ? "local" : "symbol", derivative, bending, error, size);
  PetscCall(PetscFree3(known, U, work));
  PetscCall(SelfMobilityDestroy(&self));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscReal Dot(PetscInt n, const PetscReal a[], const PetscReal b[]) {
  PetscReal sum = 0;
  for (PetscInt i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* Exact on trigonometric curves; the first derivative antisymmetric, the fourth symmetric. */
static PetscErrorCode CheckDerivatives(PetscInt n) {
  static const int powers[] = {1, 2, 4};
  Spectral s;
  PetscReal *x, *y, *a, *b, *c, *d;
  unsigned seed = 3;
  PetscFunctionBeginUser;
  PetscCall(SpectralCreate(n, &s));
  PetscCall(PetscCalloc6(2 * n, &x, 2 * n, &y, 2 * n, &a, 2 * n, &b, 2 * n, &c, 2 * n, &d));
  for (int p = 0; p < 3; p++) {
    PetscReal error = 0, size = 0;
    for (PetscInt q = 0; q <= (n - 1) / 2; q++) {
      const PetscReal wave = 2 * PETSC_PI * q / n, factor = PetscPowRealInt(wave, powers[p]);
      for (PetscInt k = 0; k < n; k++) {
        x[2 * k] = PetscCosReal(wave * k + 0.3);
        x[2 * k + 1] = PetscSinReal(wave * k + 1.1);
        a[2 * k] = a[2 * k + 1] = 0.5; /* adds to what is there */
      }
      SpectralDerivative(s, powers[p], 2, x, a);
      for (PetscInt k = 0; k < n; k++)
        for (int i = 0; i < 2; i++) {
          const PetscReal phase = wave * k + (i ? 1.1 - PETSC_PI / 2 : 0.3) + powers[p] * PETSC_PI / 2;
          error = PetscMax(error, PetscAbsReal(a[2 * k + i] - 0.5 - 2 * factor * PetscCosReal(phase)));
          size = PetscMax(size, factor);
        }
    }
    CHECK(error < 1e-13 * size, "%d markers: derivative %d exact on %d waves, error %.1e of %.1e", (int)n, powers[p],
          (int)((n + 1) / 2), error, size);
  }
  for (PetscInt i = 0; i < 2 * n; i++) {
    x[i] = TestRandom(&seed);
    y[i] = TestRandom(&seed);
    a[i] = b[i] = c[i] = d[i] = 0;
  }
  SpectralDerivative(s, 1, 1, x, a);
  SpectralDerivative(s, 1, 1, y, b);
  SpectralDerivative(s, 4, 1, x, c);
  SpectralDerivative(s, 4, 1, y, d);
  const PetscReal odd = Dot(2 * n, y, a) + Dot(2 * n, x, b), even = Dot(2 * n, y, c) - Dot(2 * n, x, d);
  CHECK(PetscAbsReal(odd) < 1e-12 * n, "%d markers: y.Dx + x.Dy = %.1e for random x, y", (int)n, odd);
  CHECK(PetscAbsReal(even) < 1e-11 * n, "%d markers: y.D4x - x.D4y = %.1e for random x, y", (int)n, even);
  PetscCall(PetscFree6(x, y, a, b, c, d));
  PetscCall(SpectralDestroy(&s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Dm and Dm^T; bending force and bending energy; the area target. */
static PetscErrorCode CheckMembrane(const char *derivative) {
  char options[512];
  TestWorld w;
  Membrane m;
  PetscReal *tau, *U, *d, *sigma, *F, *X, *old, *work, rate, slope;
  PetscInt M;
  unsigned seed = 5;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), BOX "-vesicle_bending 0.3 -membrane_derivative %s", derivative));
  PetscCall(TestWorldCreate(options, &w));
  m = w.membrane;
  M = m->M;
  PetscCall(PetscCalloc4(2 * M, &tau, 2 * M, &U, M, &d, M, &sigma));
  PetscCall(PetscCalloc4(2 * M, &F, 2 * M, &X, 2 * M, &old, 2 * M, &work));
  for (PetscInt k = 0; k < 2 * M; k++) {
    U[k] = TestRandom(&seed);
    X[k] = w.scene->shape.X[k] + 0.02 * m->ds[0] * TestRandom(&seed);
    sigma[k / 2] = TestRandom(&seed);
  }
  MembraneTangents(m, X, tau);
  MembraneStretching(m, tau, U, d);
  MembraneStretchingTranspose(m, tau, 1, sigma, F);
  rate = Dot(M, sigma, d) - Dot(2 * M, U, F);
  CHECK(PetscAbsReal(rate) < 1e-13 * M, "%s: sigma.(Dm U) - (Dm^T sigma).U = %.1e", derivative, rate);

  /* half the squared edges' rate of change along U is ds SUM d */
  const PetscReal step = 1e-4;
  PetscReal half[2] = {0, 0}, energy[2];
  for (int side = 0; side < 2; side++) {
    for (PetscInt k = 0; k < 2 * M; k++) old[k] = X[k] + (side ? step : -step) * U[k];
    MembraneEdges(m, 0, old, work);
    half[side] = 0.5 * Dot(2 * M, work, work);
    energy[side] = MembraneBendingEnergy(m, 0, old);
  }
  rate = 0;
  for (PetscInt k = 0; k < M; k++) rate += m->ds[0] * d[k];
  slope = (half[1] - half[0]) / (2 * step);
  CHECK(PetscAbsReal(slope - rate) < 1e-9 * M, "%s: Dm is the rate of the squared edges, %.10f against %.10f",
        derivative, rate, slope);
  PetscCall(PetscArrayzero(F, 2 * M));
  MembraneBending(m, -m->bending, X, work, F); /* the force, per marker */
  rate = Dot(2 * M, F, U);
  slope = (energy[1] - energy[0]) / (2 * step);
  CHECK(PetscAbsReal(slope + rate) < 1e-8 * PetscAbsReal(rate),
        "%s: bending force is minus the gradient of the energy, %.8e against %.8e", derivative, rate, -slope);

  for (PetscInt k = 0; k < 2 * M; k++) X[k] = old[k] = 1.004 * w.scene->shape.X[k];
  for (PetscInt k = 0; k < M; k++) old[2 * k] += 0.1;
  const PetscReal shift = MembraneRestoreArea(m, 0, X, old);
  Measures measures;
  PetscReal apart = 0;
  MembraneMeasure(m, 0, X, &measures);
  for (PetscInt k = 0; k < M; k++)
    apart = PetscMax(apart, PetscAbsReal(old[2 * k] - X[2 * k] - 0.1) + PetscAbsReal(old[2 * k + 1] - X[2 * k + 1]));
  CHECK(PetscAbsReal(measures.area / m->A0[0] - 1) < 1e-12, "%s: area restored to %.1e", derivative,
        measures.area / m->A0[0] - 1);
  CHECK(shift < 0 && PetscAbsReal(shift * m->L0[0] / m->A0[0] + 0.008) < 1e-3 && apart < 1e-15,
        "%s: shift %.5f, old markers moved alike to %.1e", derivative, shift, apart);
  PetscCall(PetscFree4(tau, U, d, sigma));
  PetscCall(PetscFree4(F, X, old, work));
  PetscCall(TestWorldDestroy(&w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Few markers on a slender ellipse: the spectral curve through them has its length, its area and equal edges, and its
   symmetry about the first axis. */
static PetscErrorCode CheckStart(const char *cells) {
  char options[512];
  TestWorld w;
  Measures measures;
  Curve curve = {0, {0.15, 0.6}, NULL, {NULL, NULL}, {NULL, NULL}};
  PetscReal asymmetry = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options),
                          "-domain_cells %s -domain_box -1,1,-1,1 -vesicle_semi_axes 0.15,0.6 -membrane_derivative "
                          "spectral -delta_type cbs54 -vesicle_spacing 1.5",
                          cells));
  PetscCall(TestWorldCreate(options, &w));
  const PetscInt M = w.membrane->M;
  MembraneMeasure(w.membrane, 0, w.scene->shape.X, &measures);
  for (PetscInt k = 1; k < M; k++) {
    const PetscReal *a = &w.scene->shape.X[2 * k], *b = &w.scene->shape.X[2 * (M - k)];
    asymmetry = PetscMax(asymmetry, PetscAbsReal(a[0] - b[0]) + PetscAbsReal(a[1] + b[1]));
  }
  CHECK(PetscAbsReal(measures.length / CurveLength(&curve) - 1) < 1e-12 && measures.edge_ratio - 1 < 1e-12 &&
            PetscAbsReal(measures.area / (PETSC_PI * 0.15 * 0.6) - 1) < 1e-12 && asymmetry < 1e-12,
        "%d markers: length off by %.1e, area by %.1e, edges by %.1e, symmetry by %.1e", (int)M,
        measures.length / CurveLength(&curve) - 1, measures.area / (PETSC_PI * 0.15 * 0.6) - 1, measures.edge_ratio - 1,
        asymmetry);
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
  PetscCall(CheckStart("24,24"));
  PetscCall(CheckStart("64,64"));
  PetscCall(CheckDerivatives(35));
  PetscCall(CheckDerivatives(48));
  for (int k = 0; k < 3; k++) PetscCall(CheckMembrane(derivatives[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
