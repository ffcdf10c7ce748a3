/* Membranes: initial shapes with equal edges, measures of exact shapes, bending and stretching operators. */
#include "facts.h"
#include "bodies/bending.h"
#include "bodies/stretch.h"

/* Membrane of M markers on an ellipse, turned and moved. */
static void Ellipse(PetscInt M, PetscReal a, PetscReal b, PetscReal degrees, TestMembrane *m) {
  TestMembraneCreate(m,
                     "-domain_box -8,8,-8,8 -domain_cells 800,800 -vesicle_semi_axes %.17g,%.17g -vesicle_angle "
                     "%.17g -vesicle_center 1.25,-0.5 -vesicle_markers %d -vesicle_bending 0.3 "
                     "-vesicle_allow_close_markers",
                     a, b, degrees, (int)M);
}

/* Perimeter of an ellipse by the trapezoidal rule, which is exact to round-off here (periodic, analytic). */
static PetscReal Perimeter(PetscReal a, PetscReal b) {
  PetscReal sum = 0;
  for (int k = 0; k < 2000; k++) {
    const PetscReal t = 2 * PETSC_PI * k / 2000;
    sum += PetscSqrtReal(PetscSqr(a * PetscSinReal(t)) + PetscSqr(b * PetscCosReal(t)));
  }
  return sum * 2 * PETSC_PI / 2000;
}

/* A regular polygon: everything in closed form. */
static void CheckCircle(void) {
  const PetscInt M = 60;
  const PetscReal R = 0.7, half = PETSC_PI / M, omega = 0.83, edge = 2 * R * PetscSinReal(half);
  const PetscReal energy = 0.5 * 0.3 * M * edge * PetscSqr(2 * PetscSinReal(half) / edge);
  ScopedMembrane m;
  Measures got;
  PetscReal error, frequency;
  Ellipse(M, R, R, 30, &m);
  MembraneMeasure(m.membrane, 0, m.scene->shape.X, &got);
  error = PetscAbsReal(got.area / (0.5 * M * R * R * PetscSinReal(2 * half)) - 1);
  CHECK(error < 1e-13, "circle: area of the regular polygon, error %.1e", error);
  error = PetscAbsReal(got.length / (M * edge) - 1);
  CHECK(error < 1e-13, "circle: length of the regular polygon, error %.1e", error);
  CHECK(got.edge_ratio - 1 < 1e-12, "circle: equal edges, ratio - 1 = %.1e", got.edge_ratio - 1);
  error = PetscAbsReal(got.center[0] - 1.25) + PetscAbsReal(got.center[1] + 0.5);
  CHECK(error < 1e-13, "circle: centroid, error %.1e", error);
  error = PetscAbsReal(MembraneBendingEnergy(m.membrane, 0, m.scene->shape.X) / energy - 1);
  CHECK(error < 1e-10, "circle: bending energy of the regular polygon, error %.1e", error);
  PetscReal *U = TestReals(2 * M);
  for (PetscInt k = 0; k < M; k++) {
    U[2 * k] = 0.4 - omega * (m.scene->shape.X[2 * k + 1] + 0.5); /* rotation and translation */
    U[2 * k + 1] = -0.2 + omega * (m.scene->shape.X[2 * k] - 1.25);
  }
  frequency = MembraneFrequency(m.membrane, 0, m.scene->shape.X, U);
  CHECK(PetscAbsReal(frequency / omega - 1) < 1e-12, "circle: rigid rotation has frequency omega, error %.1e",
        PetscAbsReal(frequency / omega - 1));
  error = MembraneNormalSpeed(m.membrane, 0, m.scene->shape.X, U);
  CHECK(error > 0.4, "circle: normal speed sees the translation, %.3f", error);
  for (PetscInt k = 0; k < 2 * M; k++) U[k] -= k % 2 ? -0.2 : 0.4;
  error = MembraneNormalSpeed(m.membrane, 0, m.scene->shape.X, U);
  CHECK(error < 1e-13, "circle: pure rotation has no normal speed, %.1e", error);
  for (PetscInt k = 0; k < M; k++) U[2 * k + 1] = 0;
  frequency = MembraneFrequency(m.membrane, 0, m.scene->shape.X, U);
  CHECK(PetscIsNanReal(frequency), "circle: no frequency where the membrane does not rotate in one sense");
}

/* Ellipse: equal chords, points on the curve, and measures that converge with the square of the number of markers. */
static void CheckEllipse(PetscReal degrees) {
  const PetscReal a = 0.5, b = 0.2, angle = degrees * PETSC_PI / 180, c = PetscCosReal(angle), s = PetscSinReal(angle);
  const PetscReal area = PETSC_PI * a * b, length = Perimeter(a, b);
  PetscReal error[2][2], off = 0;
  for (int level = 0; level < 2; level++) {
    const PetscInt M = level ? 192 : 96;
    ScopedMembrane m;
    Measures got;
    Ellipse(M, a, b, degrees, &m);
    MembraneMeasure(m.membrane, 0, m.scene->shape.X, &got);
    CHECK(got.edge_ratio - 1 < 1e-12, "ellipse at %g degrees: %d equal edges, ratio - 1 = %.1e", degrees, (int)M,
          got.edge_ratio - 1);
    for (PetscInt k = 0; k < M; k++) {
      const PetscReal x = m.scene->shape.X[2 * k] - 1.25, y = m.scene->shape.X[2 * k + 1] + 0.5;
      off = PetscMax(off, PetscAbsReal(PetscSqr((c * x + s * y) / a) + PetscSqr((c * y - s * x) / b) - 1));
    }
    off = PetscMax(off,
                   PetscAbsReal(m.scene->shape.X[0] - 1.25 - a * c) + PetscAbsReal(m.scene->shape.X[1] + 0.5 - a * s));
    CHECK(off < 1e-13, "ellipse at %g degrees: markers on it, marker 0 on the first semi-axis, error %.1e", degrees,
          off);
    off = PetscAbsReal(PetscSinReal(got.inclination - angle));
    CHECK(off < 1e-12 && got.inclination > -PETSC_PI / 2 && got.inclination <= PETSC_PI / 2 * (1 + 1e-15),
          "ellipse at %g degrees: inclination %.6f, error %.1e", degrees, got.inclination, off);
    off = PetscAbsReal(got.center[0] - 1.25) + PetscAbsReal(got.center[1] + 0.5);
    CHECK(off < 1e-13, "ellipse at %g degrees: centroid, error %.1e", degrees, off);
    off = PetscAbsReal(m.membrane->ds[0] * M / got.length - 1) + PetscAbsReal(m.membrane->A0[0] / got.area - 1);
    CHECK(off < 1e-14, "ellipse at %g degrees: ds is the mean chord, A0 the polygon's area, error %.1e", degrees, off);
    error[level][0] = area / got.area - 1;
    error[level][1] = length / got.length - 1;
  }
  for (int k = 0; k < 2; k++) {
    const PetscReal order = PetscLog2Real(error[0][k] / error[1][k]);
    CHECK(order > 1.9 && order < 2.1 && error[1][k] < 1e-3, "ellipse at %g degrees: %s to order %.2f, error %.1e",
          degrees, k ? "length" : "area", order, error[1][k]);
  }
}

static void CheckReducedArea(void) {
  for (int k = 1; k < 10; k++) {
    const PetscReal V = k == 9 ? 0.99 : 0.1 * k, area = 1.7;
    PetscReal axes[2], error;
    TestCall(EllipseAxes(area, V, axes));
    error = PetscAbsReal(PETSC_PI * axes[0] * axes[1] / area - 1) +
            PetscAbsReal(4 * PETSC_PI * area / PetscSqr(Perimeter(axes[0], axes[1])) / V - 1);
    CHECK(error < 1e-9 && axes[0] >= axes[1], "ellipse of area 1.7 and reduced area %.2f, error %.1e", V, error);
  }
}

/* 40 unequal, clockwise points of an ellipse: the spline gives the ellipse back to h^4, equal edges, counter-clockwise.
 */
static void CheckFile(void) {
  const char *path = TestScratch("curve.txt");
  const PetscReal a = 0.5, b = 0.3;
  PetscMPIInt rank;
  ScopedMembrane m;
  Measures got;
  PetscReal off = 0;
  TestCall(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
  if (!rank) {
    FILE *f = fopen(path, "w");
    PetscCheckAbort(f, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s", path);
    fprintf(f, "# an ellipse, clockwise\n\n");
    for (int k = 0; k <= 40; k++) { /* the last point repeats the first */
      const PetscReal t = -2 * PETSC_PI * (k % 40) / 40 - 0.1 * PetscSinReal(2 * PETSC_PI * k / 40);
      fprintf(f, k % 2 ? "%.17g, %.17g # odd\n" : "  %.17g\t%.17g\n", a * PetscCosReal(t), b * PetscSinReal(t));
    }
    fclose(f);
  }
  TestCall(MPI_Barrier(PETSC_COMM_WORLD));
  TestMembraneCreate(&m, "-vesicle_shape file -vesicle_file %s -vesicle_markers 64", path);
  MembraneMeasure(m.membrane, 0, m.scene->shape.X, &got);
  for (PetscInt k = 0; k < m.M; k++)
    off = PetscMax(off,
                   PetscAbsReal(PetscSqr(m.scene->shape.X[2 * k] / a) + PetscSqr(m.scene->shape.X[2 * k + 1] / b) - 1));
  CHECK(m.M == 64 && off < 2e-4, "curve file: 64 markers on the ellipse, error %.1e", off);
  CHECK(got.edge_ratio - 1 < 1e-12, "curve file: equal edges, ratio - 1 = %.1e", got.edge_ratio - 1);
  CHECK(got.area > 0, "curve file: turned counter-clockwise, area %.4f", got.area);
}

/* SUM |x_k y_k|. */
static PetscReal Size(PetscInt n, const PetscReal x[], const PetscReal y[]) {
  PetscReal size = 0;
  for (PetscInt k = 0; k < n; k++) size += PetscAbsReal(x[k] * y[k]);
  return size;
}

#define TURNED                                                                                                         \
  "-domain_box -8,8,-8,8 -domain_cells 800,800 -vesicle_semi_axes 0.6,0.25 -vesicle_angle 17 -vesicle_bending 0.3 "    \
  "-vesicle_allow_close_markers "

/* E(X + e V) - E(X - e V) = 2 e <c_b ds D4 X, V>, exactly, as the energy is quadratic; and D4 is symmetric. */
static void CheckBending(const TestMembrane *m, const char name[], unsigned *state) {
  const PetscInt n = 2 * m->M;
  const PetscReal e = 1e-2, *X = m->scene->shape.X;
  PetscReal slope;
  PetscReal *F = TestReals(n), *V = TestReals(n), *W = TestReals(n);
  for (PetscInt k = 0; k < n; k++) V[k] = TestRandom(state);
  for (PetscInt k = 0; k < n; k++) W[k] = X[k] + e * V[k];
  slope = MembraneBendingEnergy(m->membrane, 0, W);
  for (PetscInt k = 0; k < n; k++) W[k] = X[k] - e * V[k];
  slope = (slope - MembraneBendingEnergy(m->membrane, 0, W)) / (2 * e);
  MembraneBending(m->membrane, m->membrane->bending, X, F);
  const PetscReal error = PetscAbsReal(TestProduct(n, F, V) - slope) / Size(n, F, V);
  CHECK(error < 1e-10, "%s: bending is the gradient of the energy, error %.1e", name, error);
  for (PetscInt k = 0; k < n; k++) W[k] = TestRandom(state);
  TestCall(PetscArrayzero(F, n));
  MembraneBending(m->membrane, 1, W, F);
  const PetscReal product = TestProduct(n, F, V), size = Size(n, F, V);
  TestCall(PetscArrayzero(F, n));
  MembraneBending(m->membrane, 1, V, F);
  const PetscReal swapped = TestProduct(n, F, W);
  CHECK(PetscAbsReal(product - swapped) < 1e-13 * size, "%s: bending is symmetric, error %.1e", name,
        PetscAbsReal(product - swapped) / size);
}

/* Dm and Dm^T, their dense matrix, and what Dm makes of a rigid motion. */
static void CheckStretching(const TestMembrane *m, const char name[], unsigned *state) {
  const PetscInt n = 2 * m->M;
  const PetscReal *X = m->scene->shape.X;
  PetscReal dense = 0;
  MembraneLaw law;
  PetscReal *F = TestReals(n), *V = TestReals(n), *sigma = TestReals(m->M), *d = TestReals(m->M),
            *D = TestReals(m->M * n);
  TestCall(LawCreate(m->membrane, 1, 0, 1, &law));
  for (PetscInt k = 0; k < n; k++) V[k] = TestRandom(state);
  for (PetscInt k = 0; k < m->M; k++) sigma[k] = TestRandom(state);
  LawPlace(law, 1, X);
  LawRows(law, V, sigma, d);
  LawForce(law, 1, sigma, F);
  const PetscReal product = TestProduct(m->M, d, sigma), swapped = TestProduct(n, F, V), size = Size(m->M, d, sigma);
  CHECK(PetscAbsReal(product - swapped) < 1e-13 * size, "%s: Dm and Dm^T adjoint, error %.1e", name,
        PetscAbsReal(product - swapped) / size);
  TestCall(LawBlock(law, 0, D));
  for (PetscInt k = 0; k < m->M; k++) dense = PetscMax(dense, PetscAbsReal(TestProduct(n, D + k * n, V) - d[k]));
  CHECK(dense < 1e-13, "%s: Dm as a matrix, error %.1e", name, dense);
  for (PetscInt k = 0; k < m->M; k++) V[2 * k] = 3 - 2 * X[2 * k + 1], V[2 * k + 1] = 1 + 2 * X[2 * k];
  LawRows(law, V, sigma, d);
  const PetscReal error = TestFar(m->M, d, NULL);
  CHECK(error < 1e-14, "%s: a rigid motion stretches no edge, error %.1e", name, error);
  TestCall(LawDestroy(&law));
}

/* The laws of stretching: sigma = 2 dW/dq and its derivative by q by differences, and E (lambda - 1) at small strain.
 */
static void CheckLaws(void) {
  static const char *const names[] = {"", "hooke", "green", "neo_hookean"};
  for (int law = LAW_HOOKE; law <= LAW_NEO_HOOKEAN; law++) {
    PetscReal energy = 0, slope = 0;
    for (PetscReal q = 0.3; q < 4; q *= 1.3) {
      const PetscReal d = 1e-5 * q;
      const Stretch at = StretchOf((LawType)law, q), up = StretchOf((LawType)law, q + d),
                    down = StretchOf((LawType)law, q - d);
      energy = PetscMax(energy, PetscAbsReal((up.energy - down.energy) / d - at.sigma));
      slope = PetscMax(slope, PetscAbsReal((up.sigma - down.sigma) / (2 * d) - at.slope));
    }
    CHECK(energy < 1e-8, "%s: sigma is twice the derivative of the energy by q, error %.1e", names[law], energy);
    CHECK(slope < 1e-8, "%s: the slope of sigma, error %.1e", names[law], slope);
    const Stretch small = StretchOf((LawType)law, PetscSqr(1 + 1e-6));
    CHECK(PetscAbsReal(small.sigma * (1 + 1e-6) / 1e-6 - 1) < 2e-6, "%s: tension at small strain", names[law]);
  }
}

static void CheckOperators(const char derivative[]) {
  ScopedMembrane m;
  unsigned state = 5;
  TestMembraneCreate(&m, TURNED "-vesicle_markers 48 -membrane_derivative %s", derivative);
  CheckBending(&m, derivative, &state);
  CheckStretching(&m, derivative, &state);
}

static void CheckMemory(void) {
  ScopedMembrane m;
  unsigned state = 7;
  TestMembraneCreate(&m, TURNED
                     "-vesicle_markers 63 -membrane_memory 1 -scheme_type coupled -membrane_derivative spectral");
  CheckBending(&m, "memory", &state);
  const PetscReal rest = MembraneBendingEnergy(m.membrane, 0, m.scene->shape.X);
  TestCall(PetscFree(m.membrane->memory));
  const PetscReal plain = MembraneBendingEnergy(m.membrane, 0, m.scene->shape.X);
  CHECK(rest < 1e-6 * plain, "the remembered shape has no energy, %.1e of that without memory", rest / plain);
}

void Facts(void) {
  CheckCircle();
  CheckEllipse(0);
  CheckEllipse(65);
  CheckEllipse(90);
  CheckEllipse(-89);
  CheckReducedArea();
  CheckFile();
  CheckLaws();
  CheckOperators("fd");
  CheckOperators("bending");
  CheckOperators("spectral");
  CheckMemory();
}
