/* Membranes: initial shapes with equal edges, measures of exact shapes, bending and stretching operators, the labels'
   speed and the area target. */
#include "facts.h"
#include "bodies/bending.h"
#include "bodies/stretch.h"

TestScoped(MembraneLaw, LawDestroy);

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

/* The middle where Ellipse puts it. */
static void CheckCenter(const Measures *got) {
  CheckBelow(PetscAbsReal(got->center[0] - 1.25) + PetscAbsReal(got->center[1] + 0.5), 1e-13, "centroid");
}

/* A regular polygon: everything in closed form. */
static void CheckCircle(void) {
  const PetscInt M = 60;
  const PetscReal R = 0.7, half = PETSC_PI / M, omega = 0.83, edge = 2 * R * PetscSinReal(half);
  const PetscReal energy = 0.5 * 0.3 * M * edge * PetscSqr(2 * PetscSinReal(half) / edge);
  ScopedMembrane m;
  Measures got;
  TestAbout("circle");
  Ellipse(M, R, R, 30, &m);
  const PetscReal *X = m.scene->shape.X;
  MembraneMeasure(m.membrane, 0, X, &got);
  CheckBelow(got.area / (0.5 * M * R * R * PetscSinReal(2 * half)) - 1, 1e-13, "area of the regular polygon");
  CheckBelow(got.length / (M * edge) - 1, 1e-13, "length of the regular polygon");
  CheckBelow(got.edge_ratio - 1, 1e-12, "equal edges");
  CheckCenter(&got);
  CheckBelow(MembraneBendingEnergy(m.membrane, 0, X) / energy - 1, 1e-10, "bending energy of the regular polygon");
  PetscReal *U = TestReals(2 * M);
  for (PetscInt k = 0; k < 2 * M; k++) /* rotation and translation */
    U[k] = k % 2 ? -0.2 + omega * (X[k - 1] - 1.25) : 0.4 - omega * (X[k + 1] + 0.5);
  CheckBelow(MembraneFrequency(m.membrane, 0, X, U) / omega - 1, 1e-12, "rigid rotation has frequency omega");
  CHECK(MembraneNormalSpeed(m.membrane, 0, X, U) > 0.4, "normal speed sees the translation");
  for (PetscInt k = 0; k < 2 * M; k++) U[k] -= k % 2 ? -0.2 : 0.4;
  CheckBelow(MembraneNormalSpeed(m.membrane, 0, X, U), 1e-13, "pure rotation has no normal speed");
  for (PetscInt k = 0; k < M; k++) U[2 * k + 1] = 0;
  CHECK(PetscIsNanReal(MembraneFrequency(m.membrane, 0, X, U)),
        "no frequency where the membrane does not rotate in one sense");
}

/* Ellipse: equal chords, points on the curve, and measures that converge with the square of the number of markers. */
static void CheckEllipse(PetscReal degrees) {
  const PetscReal a = 0.5, b = 0.2, angle = degrees * PETSC_PI / 180, c = PetscCosReal(angle), s = PetscSinReal(angle);
  PetscReal error[2][2], off = 0;
  TestAbout("ellipse at %g degrees", degrees);
  for (int level = 0; level < 2; level++) {
    const PetscInt M = level ? 192 : 96;
    ScopedMembrane m;
    Measures got;
    Ellipse(M, a, b, degrees, &m);
    const PetscReal *X = m.scene->shape.X;
    MembraneMeasure(m.membrane, 0, X, &got);
    for (PetscInt k = 0; k < M; k++) {
      const PetscReal x = X[2 * k] - 1.25, y = X[2 * k + 1] + 0.5;
      TestWorse(&off, PetscSqr((c * x + s * y) / a) + PetscSqr((c * y - s * x) / b) - 1);
    }
    CheckBelow(off, 1e-13, "%d markers on it", (int)M);
    CheckBelow(PetscAbsReal(X[0] - 1.25 - a * c) + PetscAbsReal(X[1] + 0.5 - a * s), 1e-13,
               "marker 0 on the first semi-axis");
    CheckBelow(got.edge_ratio - 1, 1e-12, "equal edges");
    CHECK(got.inclination > -PETSC_PI / 2 && got.inclination <= PETSC_PI / 2 * (1 + 1e-15), "inclination within pi");
    CheckBelow(PetscSinReal(got.inclination - angle), 1e-12, "inclination %.6f", got.inclination);
    CheckCenter(&got);
    CheckBelow(m.membrane->ds[0] * M / got.length - 1, 5e-15, "ds is the mean chord");
    CheckBelow(m.membrane->A0[0] / got.area - 1, 5e-15, "A0 is the polygon's area");
    error[level][0] = PETSC_PI * a * b / got.area - 1;
    error[level][1] = Perimeter(a, b) / got.length - 1;
  }
  for (int k = 0; k < 2; k++) {
    CheckBelow(PetscLog2Real(error[0][k] / error[1][k]) - 2, 0.1, "%s to order 2 but for", k ? "length" : "area");
    CheckBelow(error[1][k], 1e-3, "%s, error", k ? "length" : "area");
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
  FILE *f;
  ScopedMembrane m;
  Measures got;
  PetscReal off = 0;
  TestCall(PetscFOpen(PETSC_COMM_WORLD, path, "w", &f));
  TestCall(PetscFPrintf(PETSC_COMM_WORLD, f, "# an ellipse, clockwise\n\n"));
  for (int k = 0; k <= 40; k++) { /* the last point repeats the first */
    const PetscReal t = -2 * PETSC_PI * (k % 40) / 40 - 0.1 * PetscSinReal(2 * PETSC_PI * k / 40);
    const char *format = k % 2 ? "%.17g, %.17g # odd\n" : "  %.17g\t%.17g\n";
    TestCall(PetscFPrintf(PETSC_COMM_WORLD, f, format, a * PetscCosReal(t), b * PetscSinReal(t)));
  }
  TestCall(PetscFClose(PETSC_COMM_WORLD, f));
  TestCall(MPI_Barrier(PETSC_COMM_WORLD));
  TestMembraneCreate(&m, "-vesicle_shape file -vesicle_file %s -vesicle_markers 64", path);
  const PetscReal *X = m.scene->shape.X;
  MembraneMeasure(m.membrane, 0, X, &got);
  for (PetscInt k = 0; k < m.M; k++) TestWorse(&off, PetscSqr(X[2 * k] / a) + PetscSqr(X[2 * k + 1] / b) - 1);
  TestAbout("curve file");
  CheckBelow(off, 2e-4, "%d markers on the ellipse", (int)m.M);
  CheckBelow(got.edge_ratio - 1, 1e-12, "equal edges");
  CHECK(m.M == 64 && got.area > 0, "turned counter-clockwise, area %.4f", got.area);
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
static void CheckBending(const TestMembrane *m, unsigned *state) {
  const PetscInt n = 2 * m->M;
  const PetscReal e = 1e-2, *X = m->scene->shape.X, *V = TestRandoms(n, state), *W = TestRandoms(n, state);
  PetscReal slope = 0, *F = TestReals(n), *G = TestReals(n), *H = TestReals(n), *moved = TestReals(n);
  for (int side = -1; side <= 1; side += 2) {
    for (PetscInt k = 0; k < n; k++) moved[k] = X[k] + side * e * V[k];
    slope += side * MembraneBendingEnergy(m->membrane, 0, moved) / (2 * e);
  }
  MembraneBending(m->membrane, m->membrane->bending, X, F);
  CheckBelow((TestProduct(n, F, V) - slope) / Size(n, F, V), 1e-10, "bending is the gradient of the energy");
  MembraneBending(m->membrane, 1, W, G);
  MembraneBending(m->membrane, 1, V, H);
  CheckBelow((TestProduct(n, G, V) - TestProduct(n, H, W)) / Size(n, G, V), 1e-13, "bending is symmetric");
}

/* Dm and Dm^T, their dense matrix, and what Dm makes of a rigid motion. */
static void CheckStretching(const TestMembrane *m, unsigned *state) {
  const PetscInt M = m->M, n = 2 * M;
  const PetscReal *X = m->scene->shape.X, *sigma = TestRandoms(M, state);
  PetscReal *V = TestRandoms(n, state), *F = TestReals(n), *d = TestReals(M), *D = TestReals(M * n), dense = 0;
  Scoped(MembraneLaw) law;
  TestCall(LawCreate(m->membrane, 1, 0, 1, &law));
  LawPlace(law, 1, X);
  LawRows(law, V, sigma, d);
  LawForce(law, 1, sigma, F);
  CheckBelow((TestProduct(M, d, sigma) - TestProduct(n, F, V)) / Size(M, d, sigma), 1e-13, "Dm and Dm^T adjoint");
  TestCall(LawBlock(law, 0, D));
  for (PetscInt k = 0; k < M; k++) TestWorse(&dense, TestProduct(n, D + k * n, V) - d[k]);
  CheckBelow(dense, 1e-13, "Dm as a matrix");
  for (PetscInt k = 0; k < n; k++) V[k] = k % 2 ? 1 + 2 * X[k - 1] : 3 - 2 * X[k + 1];
  LawRows(law, V, sigma, d);
  CheckBelow(TestFar(M, d, NULL), 1e-14, "a rigid motion stretches no edge");
}

/* Half the squared edges' rate of change along a motion U, at markers near rest, is ds SUM (Dm U). */
static void CheckRate(const TestMembrane *w, unsigned *state) {
  const Membrane m = w->membrane;
  const PetscInt M = w->M;
  const PetscReal step = 1e-4, *U = TestRandoms(2 * M, state);
  PetscReal *X = TestRandoms(2 * M, state), *moved = TestReals(2 * M), *edges = TestReals(2 * M), *d = TestReals(M);
  PetscReal rate = 0, slope = 0;
  Scoped(MembraneLaw) law;
  for (PetscInt k = 0; k < 2 * M; k++) X[k] = w->scene->shape.X[k] + 0.02 * m->ds[0] * X[k];
  TestCall(LawCreate(m, 1, 0, 1, &law));
  LawPlace(law, 1, X);
  LawRows(law, U, NULL, d);
  for (int side = -1; side <= 1; side += 2) {
    for (PetscInt k = 0; k < 2 * M; k++) moved[k] = X[k] + side * step * U[k];
    MembraneEdges(m, 0, moved, edges);
    slope += side * 0.5 * TestProduct(2 * M, edges, edges) / (2 * step);
  }
  for (PetscInt k = 0; k < M; k++) rate += m->ds[0] * d[k];
  CheckBelow((slope - rate) / M, 1e-9, "Dm is the rate of the squared edges, %.10f against %.10f", rate, slope);
}

/* What is left of an area: a uniform shift. */
static void CheckArea(const TestMembrane *w) {
  const Membrane m = w->membrane;
  PetscReal *X = TestReals(2 * w->M);
  Measures measures;
  for (PetscInt k = 0; k < 2 * w->M; k++) X[k] = 1.004 * w->scene->shape.X[k];
  const PetscReal shift = MembraneRestoreArea(m, 0, X);
  MembraneMeasure(m, 0, X, &measures);
  CheckBelow(measures.area / m->A0[0] - 1, 1e-12, "area restored");
  CheckBelow(shift * m->L0[0] / m->A0[0] + 0.008, 1e-3, "shift %.5f", shift);
}

/* The labels' speed of a known motion, a translation, a turn and a shift of labels together; on a circle, where a turn
   is a shift, all of it. */
static void CheckTreading(const TestMembrane *w) {
  const Membrane m = w->membrane;
  const PetscReal V = 0.41, omega = -0.7, *X = w->scene->shape.X;
  PetscReal *circle = TestReals(2 * w->M), *U = TestReals(2 * w->M);
  for (PetscInt k = 0; k < 2 * w->M; k++) U[k] = k % 2 ? -2 + omega * X[k - 1] : 3 - omega * X[k + 1];
  MembraneLabelDerivative(m, 0, V, X, U);
  CheckBelow(MembraneTreading(m, 0, X, U) / V - 1, 1e-12, "labels at the speed %g", V);
  for (PetscInt k = 0; k < w->M; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / w->M;
    circle[2 * k] = 5 + 0.3 * PetscCosReal(t);
    circle[2 * k + 1] = 0.3 * PetscSinReal(t);
    U[2 * k] = 1 - omega * 0.3 * PetscSinReal(t);
    U[2 * k + 1] = omega * 0.3 * PetscCosReal(t);
  }
  CheckBelow(MembraneTreading(m, 0, circle, U) / omega - 1, 1e-12, "a circle that turns at %g: labels go with it",
             omega);
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
      TestWorse(&energy, (up.energy - down.energy) / d - at.sigma);
      TestWorse(&slope, (up.sigma - down.sigma) / (2 * d) - at.slope);
    }
    CheckBelow(energy, 1e-8, "%s: sigma is twice the derivative of the energy by q", names[law]);
    CheckBelow(slope, 1e-8, "%s: the slope of sigma", names[law]);
    const Stretch small = StretchOf((LawType)law, PetscSqr(1 + 1e-6));
    CheckBelow(small.sigma * (1 + 1e-6) / 1e-6 - 1, 2e-6, "%s: tension at small strain", names[law]);
  }
}

static void CheckOperators(const char derivative[], int markers) {
  ScopedMembrane m;
  unsigned state = 5;
  TestAbout("%s, %d markers", derivative, markers);
  TestMembraneCreate(&m, TURNED "-vesicle_markers %d -membrane_derivative %s", markers, derivative);
  CheckBending(&m, &state);
  CheckStretching(&m, &state);
  CheckRate(&m, &state);
  CheckArea(&m);
  CheckTreading(&m);
}

static void CheckMemory(void) {
  ScopedMembrane m;
  unsigned state = 7;
  TestAbout("memory");
  TestMembraneCreate(&m, TURNED
                     "-vesicle_markers 63 -membrane_memory 1 -scheme_type coupled -membrane_derivative spectral");
  CheckBending(&m, &state);
  const PetscReal rest = MembraneBendingEnergy(m.membrane, 0, m.scene->shape.X);
  TestCall(PetscFree(m.membrane->memory));
  CheckBelow(rest / MembraneBendingEnergy(m.membrane, 0, m.scene->shape.X), 1e-6,
             "the remembered shape has no energy, over that without memory");
}

void Facts(void) {
  CheckCircle();
  for (int k = 0; k < 4; k++) CheckEllipse((PetscReal[]){0, 65, 90, -89}[k]);
  CheckReducedArea();
  CheckFile();
  CheckLaws();
  for (int markers = 48; markers < 50; markers++) {
    CheckOperators("fd", markers);
    CheckOperators("bending", markers);
    CheckOperators("spectral", markers);
  }
  CheckMemory();
}
