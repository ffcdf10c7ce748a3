/* Derivatives along the membrane: spectral ones, the rate of edges, the labels' speed, and the area target. */
#include "facts.h"

/* Exact on trigonometric curves; the first derivative antisymmetric, the fourth symmetric. */
static void CheckDerivatives(PetscInt n) {
  static const int powers[] = {1, 2, 4};
  Spectral s;
  unsigned seed = 3;
  TestCall(SpectralCreate(n, &s));
  PetscReal *x = TestReals(2 * n), *y = TestReals(2 * n), *a = TestReals(2 * n), *b = TestReals(2 * n),
            *c = TestReals(2 * n), *d = TestReals(2 * n);
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
    CHECK(error < 1e-13 * PetscMax(1, n / 40.) * size,
          "%d markers: derivative %d exact on %d waves, error %.1e of %.1e", (int)n, powers[p], (int)((n + 1) / 2),
          error, size);
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
  const PetscReal odd = TestProduct(2 * n, y, a) + TestProduct(2 * n, x, b),
                  even = TestProduct(2 * n, y, c) - TestProduct(2 * n, x, d);
  CHECK(PetscAbsReal(odd) < 1e-12 * n, "%d markers: y.Dx + x.Dy = %.1e for random x, y", (int)n, odd);
  CHECK(PetscAbsReal(even) < 1e-11 * n, "%d markers: y.D4x - x.D4y = %.1e for random x, y", (int)n, even);
  TestCall(SpectralDestroy(&s));
}

/* What was found for x before must not be given for another x in the same place. */
static void CheckKept(PetscInt n) {
  static const int powers[] = {1, 2, 4};
  Spectral s;
  unsigned seed = 5;
  TestCall(SpectralCreate(n, &s));
  PetscReal *x = TestReals(2 * n), *a = TestReals(2 * n), *b = TestReals(2 * n), *c = TestReals(2 * n),
            *d = TestReals(2 * n);
  for (PetscInt i = 0; i < 2 * n; i++) x[i] = TestRandom(&seed);
  for (int p = 0; p < 3; p++) {
    PetscReal error = 0, size = 0;
    SpectralDerivative(s, powers[p], 1, x, a);
    x[2 * n - 1] += 1;
    SpectralDerivative(s, powers[p], 1, x, b);
    x[2 * n - 1] -= 1;
    d[2 * n - 1] = 1;
    SpectralDerivative(s, powers[p], 1, d, c);
    for (PetscInt i = 0; i < 2 * n; i++) {
      error = PetscMax(error, PetscAbsReal(a[i] + c[i] - b[i]));
      size = PetscMax(size, PetscAbsReal(c[i]));
      a[i] = b[i] = c[i] = d[i] = 0;
    }
    CHECK(error < 1e-12 * size && size > 0, "%d markers: derivative %d of a sum, error %.1e of %.1e", (int)n, powers[p],
          error, size);
  }
  TestCall(SpectralDestroy(&s));
}

/* A shift of labels: exact on trigonometric curves, alone or in pairs; it keeps sums of squares of an odd number. */
static void CheckShift(PetscInt n) {
  const PetscReal phi = 0.37;
  PetscReal error = 0;
  unsigned seed = 9;
  Spectral s;
  TestCall(SpectralCreate(n, &s));
  PetscReal *x = TestReals(2 * n), *y = TestReals(2 * n);
  for (int each = 1; each <= 2; each++)
    for (PetscInt q = 0; q <= (n - 1) / 2; q++) {
      for (PetscInt k = 0; k < each * n; k++)
        x[k] = PetscCosReal(2 * PETSC_PI * q * (PetscReal)(k / each) / n + 0.3 + k % each);
      SpectralShift(s, each, phi, x, y);
      for (PetscInt k = 0; k < each * n; k++)
        error = PetscMax(error, PetscAbsReal(y[k] - PetscCosReal(q * (2 * PETSC_PI * (PetscReal)(k / each) / n + phi) +
                                                                 0.3 + k % each)));
    }
  CHECK(error < 1e-12, "%d markers: labels shifted exactly on %d waves, error %.1e", (int)n, (int)((n + 1) / 2), error);
  for (PetscInt k = 0; k < 2 * n; k++) x[k] = TestRandom(&seed);
  SpectralShift(s, 2, phi, x, y);
  const PetscReal change = TestProduct(2 * n, y, y) / TestProduct(2 * n, x, x) - 1;
  CHECK(n % 2 ? PetscAbsReal(change) < 1e-13 : change < 0, "%d markers: a shift changes the sum of squares by %.1e",
        (int)n, change);
  SpectralShift(s, 2, -phi, y, y);
  error = TestFar(2 * n, y, x);
  if (n % 2) CHECK(error < 1e-13, "%d markers: and back, in place, to %.1e", (int)n, error);
  TestCall(SpectralDestroy(&s));
}

/* Slopes by fast transforms are derivatives and shifts by sums, and their transpose is adjoint to them. */
static void CheckSlopes(PetscInt n) {
  const PetscReal scale[2] = {1.7, -0.4};
  unsigned seed = 5;
  Spectral s;
  TestCall(SpectralCreate(n, &s));
  PetscReal *x = TestReals(2 * n), *back = TestReals(2 * n), *y = TestReals(4 * n), adjoint = 0;
  PetscReal *slope[2] = {TestReals(4 * n), TestReals(4 * n)}, *other[2] = {TestReals(4 * n), TestReals(4 * n)};
  for (PetscInt k = 0; k < 2 * n; k++) x[k] = TestRandom(&seed);
  SpectralSlopes(s, scale, x, slope);
  for (int power = 1; power <= 2; power++) {
    for (PetscInt k = 0; k < 2 * n; k++) y[k] = 0;
    SpectralDerivative(s, power, scale[power - 1], x, y);
    SpectralShift(s, 2, PETSC_PI / n, y, y + 2 * n);
    CHECK(TestFar(4 * n, slope[power - 1], y) < 1e-12, "%d markers: slope %d at the points and halfway, %.1e", (int)n,
          power, TestFar(4 * n, slope[power - 1], y));
    for (PetscInt k = 0; k < 4 * n; k++) other[power - 1][k] = TestRandom(&seed);
    adjoint += TestProduct(4 * n, slope[power - 1], other[power - 1]);
  }
  SpectralSlopesTranspose(s, scale, other, back);
  adjoint -= TestProduct(2 * n, x, back);
  CHECK(PetscAbsReal(adjoint) < 1e-11, "%d markers: the transpose of the slopes, %.1e", (int)n, adjoint);
  TestCall(SpectralDestroy(&s));
}

/* Half the squared edges' rate of change along a motion U, at markers near rest, is ds SUM (Dm U). */
static void CheckStretching(const TestMembrane *w, const char derivative[]) {
  const Membrane m = w->membrane;
  const PetscInt M = w->M;
  const PetscReal step = 1e-4;
  PetscReal *X = TestReals(2 * M), *U = TestReals(2 * M), *moved = TestReals(2 * M), *edges = TestReals(2 * M),
            *d = TestReals(M);
  PetscReal half[2], rate = 0;
  MembraneLaw law;
  unsigned seed = 5;
  for (PetscInt k = 0; k < 2 * M; k++) {
    U[k] = TestRandom(&seed);
    X[k] = w->scene->shape.X[k] + 0.02 * m->ds[0] * TestRandom(&seed);
  }
  TestCall(LawCreate(m, 1, 0, 1, &law));
  LawPlace(law, 1, X);
  LawRows(law, U, NULL, d);
  for (int side = 0; side < 2; side++) {
    for (PetscInt k = 0; k < 2 * M; k++) moved[k] = X[k] + (side ? step : -step) * U[k];
    MembraneEdges(m, 0, moved, edges);
    half[side] = 0.5 * TestProduct(2 * M, edges, edges);
  }
  for (PetscInt k = 0; k < M; k++) rate += m->ds[0] * d[k];
  const PetscReal slope = (half[1] - half[0]) / (2 * step);
  CHECK(PetscAbsReal(slope - rate) < 1e-9 * M, "%s: Dm is the rate of the squared edges, %.10f against %.10f",
        derivative, rate, slope);
  TestCall(LawDestroy(&law));
}

/* What is left of an area: a uniform shift. */
static void CheckArea(const TestMembrane *w, const char derivative[]) {
  const Membrane m = w->membrane;
  PetscReal *X = TestReals(2 * w->M);
  Measures measures;
  for (PetscInt k = 0; k < 2 * w->M; k++) X[k] = 1.004 * w->scene->shape.X[k];
  const PetscReal shift = MembraneRestoreArea(m, 0, X);
  MembraneMeasure(m, 0, X, &measures);
  CHECK(PetscAbsReal(measures.area / m->A0[0] - 1) < 1e-12, "%s: area restored to %.1e", derivative,
        measures.area / m->A0[0] - 1);
  CHECK(shift < 0 && PetscAbsReal(shift * m->L0[0] / m->A0[0] + 0.008) < 1e-3, "%s: shift %.5f", derivative, shift);
}

/* The labels' speed of a known motion, a translation, a turn and a shift of labels together; on a circle, where a turn
   is a shift, all of it. */
static void CheckTreading(const TestMembrane *w, const char derivative[]) {
  const Membrane m = w->membrane;
  const PetscInt M = w->M;
  const PetscReal V = 0.41, omega = -0.7, *X = w->scene->shape.X;
  PetscReal *circle = TestReals(2 * M), *U = TestReals(2 * M);
  for (PetscInt k = 0; k < M; k++) {
    U[2 * k] = 3 - omega * X[2 * k + 1];
    U[2 * k + 1] = -2 + omega * X[2 * k];
  }
  MembraneLabelDerivative(m, 0, V, X, U);
  const PetscReal found = MembraneTreading(m, 0, X, U);
  CHECK(PetscAbsReal(found / V - 1) < 1e-12, "%s: labels at the speed %.15f, %g known", derivative, found, V);
  for (PetscInt k = 0; k < M; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / M;
    circle[2 * k] = 5 + 0.3 * PetscCosReal(t);
    circle[2 * k + 1] = 0.3 * PetscSinReal(t);
    U[2 * k] = 1 - omega * 0.3 * PetscSinReal(t);
    U[2 * k + 1] = omega * 0.3 * PetscCosReal(t);
  }
  const PetscReal turn = MembraneTreading(m, 0, circle, U);
  CHECK(PetscAbsReal(turn / omega - 1) < 1e-12, "%s: a circle that turns at %g: labels at %.15f", derivative, omega,
        turn);
}

static void CheckMembrane(const char derivative[]) {
  ScopedMembrane w;
  TestMembraneCreate(&w,
                     "-domain_cells 64,64 -domain_box -1,1,-1,1 -vesicle_semi_axes 0.25,0.45 -vesicle_angle 25 "
                     "-membrane_derivative %s",
                     derivative);
  CheckStretching(&w, derivative);
  CheckArea(&w, derivative);
  CheckTreading(&w, derivative);
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
    asymmetry = PetscMax(asymmetry, PetscAbsReal(a[0] - b[0]) + PetscAbsReal(a[1] + b[1]));
  }
  CHECK(PetscAbsReal(measures.length / CurveLength(&curve) - 1) < 1e-12 && measures.edge_ratio - 1 < 1e-12 &&
            PetscAbsReal(measures.area / (PETSC_PI * 0.15 * 0.6) - 1) < 1e-12 && asymmetry < 1e-12,
        "%d markers: length off by %.1e, area by %.1e, edges by %.1e, symmetry by %.1e", (int)M,
        measures.length / CurveLength(&curve) - 1, measures.area / (PETSC_PI * 0.15 * 0.6) - 1, measures.edge_ratio - 1,
        asymmetry);
}

void Facts(void) {
  static const char *const derivatives[] = {"fd", "bending", "spectral"};
  CheckStart("24,24");
  CheckStart("64,64");
  for (PetscInt n = 8; n < 16; n++) CheckDerivatives(n);
  for (PetscInt n = 44; n < 47; n++) CheckKept(n);
  CheckDerivatives(35);
  CheckDerivatives(137);
  CheckDerivatives(48);
  CheckShift(35);
  CheckShift(48);
  CheckSlopes(35);
  CheckSlopes(48);
  for (int k = 0; k < 3; k++) CheckMembrane(derivatives[k]);
}
