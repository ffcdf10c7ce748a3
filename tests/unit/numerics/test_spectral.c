/* Spectral derivatives along a closed curve, shifts of labels, slopes, and the initial curve through few markers. */
#include "facts.h"

TestScoped(Spectral, SpectralDestroy);

/* The first derivative is antisymmetric, the fourth symmetric. */
static void CheckAdjoints(PetscInt n, Spectral s) {
  unsigned seed = 3;
  const PetscReal *x = TestRandoms(2 * n, &seed), *y = TestRandoms(2 * n, &seed);
  for (int power = 1; power <= 4; power += 3) {
    PetscReal *Dx = TestReals(2 * n), *Dy = TestReals(2 * n);
    SpectralDerivative(s, power, 1, x, Dx);
    SpectralDerivative(s, power, 1, y, Dy);
    const PetscReal one = TestProduct(2 * n, y, Dx), other = TestProduct(2 * n, x, Dy);
    CheckBelow((one + (power == 1 ? other : -other)) / n, power == 1 ? 1e-12 : 1e-11, "derivative %d is %ssymmetric",
               power, power == 1 ? "anti" : "");
  }
}

/* Exact on trigonometric curves. */
static void CheckDerivatives(PetscInt n) {
  static const int powers[] = {1, 2, 4};
  Scoped(Spectral) s;
  TestCall(SpectralCreate(n, &s));
  TestAbout("%d markers", (int)n);
  PetscReal *x = TestReals(2 * n), *a = TestReals(2 * n);
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
          TestWorse(&error, a[2 * k + i] - 0.5 - 2 * factor * PetscCosReal(phase));
          size = PetscMax(size, factor);
        }
    }
    CheckBelow(error / size, 1e-13 * PetscMax(1, n / 40.), "derivative %d exact on %d waves", powers[p],
               (int)((n + 1) / 2));
  }
  CheckAdjoints(n, s);
}

/* What was found for x before must not be given for another x in the same place. */
static void CheckKept(PetscInt n) {
  static const int powers[] = {1, 2, 4};
  Scoped(Spectral) s;
  unsigned seed = 5;
  TestCall(SpectralCreate(n, &s));
  TestAbout("%d markers", (int)n);
  PetscReal *x = TestRandoms(2 * n, &seed), *d = TestReals(2 * n);
  d[2 * n - 1] = 1;
  for (int p = 0; p < 3; p++) {
    PetscReal *a = TestReals(2 * n), *b = TestReals(2 * n), *c = TestReals(2 * n), error = 0;
    SpectralDerivative(s, powers[p], 1, x, a);
    x[2 * n - 1] += 1;
    SpectralDerivative(s, powers[p], 1, x, b);
    x[2 * n - 1] -= 1;
    SpectralDerivative(s, powers[p], 1, d, c);
    for (PetscInt i = 0; i < 2 * n; i++) TestWorse(&error, a[i] + c[i] - b[i]);
    CheckBelow(error / TestFar(2 * n, c, NULL), 1e-12, "derivative %d of a sum", powers[p]);
  }
}

/* A shift of labels: exact on trigonometric curves, alone or in pairs; it keeps sums of squares of an odd number. */
static void CheckShift(PetscInt n) {
  const PetscReal phi = 0.37;
  PetscReal error = 0;
  unsigned seed = 9;
  Scoped(Spectral) s;
  TestCall(SpectralCreate(n, &s));
  TestAbout("%d markers", (int)n);
  PetscReal *x = TestReals(2 * n), *y = TestReals(2 * n);
  for (int each = 1; each <= 2; each++)
    for (PetscInt q = 0; q <= (n - 1) / 2; q++) {
      for (PetscInt k = 0; k < each * n; k++)
        x[k] = PetscCosReal(2 * PETSC_PI * q * (PetscReal)(k / each) / n + 0.3 + k % each);
      SpectralShift(s, each, phi, x, y);
      for (PetscInt k = 0; k < each * n; k++)
        TestWorse(&error, y[k] - PetscCosReal(q * (2 * PETSC_PI * (PetscReal)(k / each) / n + phi) + 0.3 + k % each));
    }
  CheckBelow(error, 1e-12, "labels shifted exactly on %d waves", (int)((n + 1) / 2));
  x = TestRandoms(2 * n, &seed);
  SpectralShift(s, 2, phi, x, y);
  const PetscReal change = TestProduct(2 * n, y, y) / TestProduct(2 * n, x, x) - 1;
  CHECK(n % 2 ? PetscAbsReal(change) < 1e-13 : change < 0, "a shift changes the sum of squares by %.1e", change);
  SpectralShift(s, 2, -phi, y, y);
  if (n % 2) CheckBelow(TestFar(2 * n, y, x), 1e-13, "labels shifted back, in place");
}

/* Slopes by fast transforms are derivatives and shifts by sums, and their transpose is adjoint to them. */
static void CheckSlopes(PetscInt n) {
  const PetscReal scale[2] = {1.7, -0.4};
  unsigned seed = 5;
  Scoped(Spectral) s;
  TestCall(SpectralCreate(n, &s));
  TestAbout("%d markers", (int)n);
  PetscReal *x = TestRandoms(2 * n, &seed), *back = TestReals(2 * n);
  PetscReal *slope = TestReals(8 * n), *other = TestRandoms(8 * n, &seed);
  SpectralSlopes(s, scale, x, slope);
  for (int power = 1; power <= 2; power++) {
    PetscReal *y = TestReals(4 * n);
    SpectralDerivative(s, power, scale[power - 1], x, y);
    SpectralShift(s, 2, PETSC_PI / n, y, y + 2 * n);
    CheckBelow(TestFar(4 * n, slope + (power - 1) * 4 * n, y), 1e-12, "slope %d at the points and halfway", power);
  }
  SpectralSlopesTranspose(s, scale, other, back);
  const PetscReal adjoint = TestProduct(8 * n, slope, other) - TestProduct(2 * n, x, back);
  CheckBelow(adjoint, 1e-11, "the transpose of the slopes");
}

/* Few markers on a slender ellipse: the spectral curve through them has its length, its area and equal edges, and its
   symmetry about the first axis. */
static void CheckStart(const char *cells) {
  ScopedMembrane w;
  Measures measures;
  Curve curve = {.axes = {0.15, 0.6}};
  PetscReal asymmetry = 0;
  TestMembraneCreate(&w,
                     "-domain_cells %s -domain_box -1,1,-1,1 -vesicle_semi_axes 0.15,0.6 -membrane_derivative "
                     "spectral -delta_type cbs54 -vesicle_spacing 1.5",
                     cells);
  const PetscInt M = w.M;
  MembraneMeasure(w.membrane, 0, w.scene->shape.X, &measures);
  for (PetscInt k = 1; k < M; k++) {
    const PetscReal *a = &w.scene->shape.X[2 * k], *b = &w.scene->shape.X[2 * (M - k)];
    TestWorse(&asymmetry, PetscAbsReal(a[0] - b[0]) + PetscAbsReal(a[1] + b[1]));
  }
  TestAbout("%d markers", (int)M);
  CheckBelow(measures.length / CurveLength(&curve) - 1, 1e-12, "length");
  CheckBelow(measures.area / (PETSC_PI * 0.15 * 0.6) - 1, 1e-12, "area");
  CheckBelow(measures.edge_ratio - 1, 1e-12, "edges");
  CheckBelow(asymmetry, 1e-12, "symmetry");
}

void Facts(void) {
  CheckStart("24,24");
  CheckStart("64,64");
  for (PetscInt n = 8; n < 16; n++) CheckDerivatives(n);
  for (PetscInt n = 44; n < 47; n++) CheckKept(n);
  CheckDerivatives(137);
  for (PetscInt n = 35; n <= 48; n += 13) {
    CheckDerivatives(n);
    CheckShift(n);
    CheckSlopes(n);
  }
}
