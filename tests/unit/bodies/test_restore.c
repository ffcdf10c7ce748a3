/* Edges corrected after a step (src/bodies/restore.c): exact on known shapes, Newton's quadratic convergence, the
   least displacement, and nothing where nothing is wrong or no freedom is left. */
#include "facts.h"

static const char *const derivatives[] = {"fd", "bending", "spectral"};

/* Membrane of M markers on an ellipse, turned, off the middle. */
static void Create(int derivative, const char axes[], PetscInt M, TestMembrane *w) {
  TestMembraneCreate(w,
                     "-domain_cells 64,64 -domain_box 3,5,-1,1 -vesicle_semi_axes %s -vesicle_angle 25 "
                     "-vesicle_center 4.1,0.05 -vesicle_markers %d -membrane_derivative %s -scheme_type coupled",
                     axes, (int)M, derivatives[derivative]);
}

/* Largest relative errors of edges and of the area against `area`. */
static void Errors(const TestMembrane *w, const PetscScalar X[], PetscReal area, PetscReal error[2]) {
  const Membrane m = w->membrane;
  PetscScalar *e = TestReals(2 * w->M);
  Measures measures;
  MembraneMeasure(m, 0, X, &measures);
  MembraneEdges(m, 0, X, e);
  error[0] = 0;
  for (PetscInt k = 0; k < w->M; k++)
    error[0] = PetscMax(error[0],
                        PetscAbsReal(PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1])) / m->ds[0] - 1));
  error[1] = PetscAbsReal(measures.area / area - 1);
}

/* Random waves, and markers by themselves: edges are off by about epsilon. Afterwards all edges have their length, the
   area is the one before, and markers have not moved as a whole (a least displacement has no part that no constraint
   asks for). */
static void CheckRestored(int derivative, PetscReal epsilon) {
  ScopedMembrane w;
  unsigned seed = 3;
  PetscReal wave[8], error[2], found, drift[2] = {0, 0};
  Measures measures;
  Create(derivative, "0.25,0.5", 35, &w);
  const PetscInt M = w.M;
  PetscReal *X = TestReals(2 * M), *before = TestReals(2 * M);
  for (int q = 0; q < 8; q++) wave[q] = TestRandom(&seed);
  for (PetscInt k = 0; k < 2 * M; k++) {
    X[k] = w.scene->shape.X[k] + 0.2 * epsilon * w.membrane->ds[0] * TestRandom(&seed);
    for (int q = 0; q < 4; q++)
      X[k] += epsilon * 0.1 * wave[2 * q + k % 2] * PetscCosReal(2 * PETSC_PI * (q + 1) * (k / 2) / M) / (q + 1);
    before[k] = X[k];
  }
  Errors(&w, X, 1, error);
  const PetscReal wrong = error[0];
  MembraneMeasure(w.membrane, 0, X, &measures);
  TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-3, X, &found));
  Errors(&w, X, measures.area, error);
  for (PetscInt k = 0; k < 2 * M; k++) drift[k % 2] += (X[k] - before[k]) / M;
  CHECK(wrong > 0.3 * epsilon && found == wrong && error[0] < 1e-12 && error[1] < 1e-12,
        "%s: edges off by %.1e (%.1e found) afterwards by %.1e, area by %.1e", derivatives[derivative], wrong, found,
        error[0], error[1]);
  CHECK(PetscAbsReal(drift[0]) + PetscAbsReal(drift[1]) < 1e-14, "%s, %.0e: the markers' mean stays, to %.1e",
        derivatives[derivative], epsilon, PetscAbsReal(drift[0]) + PetscAbsReal(drift[1]));
}

/* Gradient of the area at the initial markers, by differences: exact, as the polygon's and the spectral curve's areas
   are quadratic. */
static void AreaGradient(const TestMembrane *w, PetscReal gradient[]) {
  const PetscReal step = 1e-3;
  PetscReal change[2];
  PetscReal *X = TestReals(2 * w->M);
  for (PetscInt k = 0; k < 2 * w->M; k++) {
    for (int side = 0; side < 2; side++) {
      Measures measures;
      TestCall(PetscArraycpy(X, w->scene->shape.X, 2 * w->M));
      X[k] += side ? step : -step;
      MembraneMeasure(w->membrane, 0, X, &measures);
      change[side] = measures.area;
    }
    gradient[k] = (change[1] - change[0]) / (2 * step);
  }
}

/* A displacement across the shapes with the right edges: J^T lambda, J^T of edges alone being that of MembraneEdges. It
   must not change the area, so a multiple of the area's gradient (normals) is taken off. Of largest entry 1. */
static void Across(const TestMembrane *w, PetscReal across[]) {
  const Membrane m = w->membrane;
  const PetscInt n = 2 * w->M;
  PetscReal *e = TestReals(n), *normal = TestReals(n);
  AreaGradient(w, normal);
  MembraneEdges(m, 0, w->scene->shape.X, e);
  for (PetscInt k = 0; k < n; k += 2) {
    const PetscReal lambda = 0.5 + PetscCosReal(3 * PETSC_PI * k / w->M + 0.4);
    for (int c = 0; c < 2; c++) e[k + c] *= lambda;
  }
  MembraneEdgesTranspose(m, 0, 1, e, across);
  const PetscReal flux = TestProduct(n, across, normal), size = TestProduct(n, normal, normal);
  for (PetscInt k = 0; k < n; k++) across[k] -= flux / size * normal[k];
  const PetscReal largest = TestFar(n, across, NULL);
  for (PetscInt k = 0; k < n; k++) across[k] /= largest;
}

/* The shape found is the nearest: from X_0 + t J^T lambda, J^T lambda being across the shapes with the right edges,
   back to X_0 but for O(t^2). */
static void CheckNearest(int derivative) {
  ScopedMembrane w;
  PetscReal off[2];
  Create(derivative, "0.25,0.5", 35, &w);
  const PetscReal *X0 = w.scene->shape.X, ds = w.membrane->ds[0];
  const PetscInt n = 2 * w.M;
  PetscReal *across = TestReals(n), *X = TestReals(n);
  Across(&w, across);
  for (int t = 0; t < 2; t++) {
    PetscReal found;
    for (PetscInt k = 0; k < n; k++) X[k] = X0[k] + (t ? 0.005 : 0.01) * ds * across[k];
    TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-6, X, &found));
    off[t] = TestFar(n, X, X0);
  }
  CHECK(off[0] / off[1] > 3.6 && off[0] / off[1] < 4.4 && off[0] < 0.001 * ds,
        "%s: back to the nearest shape but for second order, %.1e and %.1e from half as far", derivatives[derivative],
        off[0], off[1]);
}

/* What is left after one, two and three steps of Newton: the square of what was left before, times a constant. */
static void CheckQuadratic(int derivative) {
  ScopedMembrane w;
  PetscReal left[4];
  Create(derivative, "0.25,0.5", 35, &w);
  const PetscInt M = w.M;
  const PetscBool spectral = derivative == 2 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal *X = TestReals(2 * M);
  for (PetscInt most = 0; most < 4; most++) {
    for (PetscInt k = 0; k < 2 * M; k++) {
      const PetscReal t = 2 * PETSC_PI * (k / 2) / M;
      X[k] = w.scene->shape.X[k] - (k % 2 ? 0.05 : 4.1) + 0.01 * PetscCosReal(3 * t + k % 2);
    }
    TestCall(CurveFit(M, spectral, M * w.membrane->ds[0], w.membrane->A0[0], X, most, &left[most]));
  }
  CHECK(left[0] > 0.03 && left[1] < 0.5 * left[0], "%s: %.1e, after a step of Newton %.1e", derivatives[derivative],
        left[0], left[1]);
  for (int k = 1; k < 3; k++)
    CHECK(left[k + 1] < 5 * PetscSqr(left[k]) + 1e-13, "%s: %.1e, after another one %.1e: %.1f times the square",
          derivatives[derivative], left[k], left[k + 1], left[k + 1] / PetscSqr(left[k]));
}

/* Nothing moves below the tolerance, nor on a blown-up circle, whose area edges of the right length cannot enclose. */
static void CheckNothingMoves(int derivative) {
  static const char *const axes[] = {"0.25,0.5", "0.4,0.4"};
  for (int circle = 0; circle < 2; circle++) {
    ScopedMembrane w;
    PetscReal found;
    PetscBool same;
    Create(derivative, axes[circle], 35, &w);
    const PetscInt M = w.M;
    PetscReal *X = TestReals(2 * M), *before = TestReals(2 * M);
    for (PetscInt k = 0; k < 2 * M; k++) X[k] = before[k] = (circle ? 1.01 : 1.0009) * w.scene->shape.X[k];
    TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-3, X, &found));
    TestCall(PetscArraycmp(X, before, 2 * M, &same));
    CHECK(same && found == 0, "%s: %s moves nothing", derivatives[derivative],
          circle ? "a circle that is too large" : "an edge error of 9e-4");
  }
}

/* The length made right by the least displacement that leaves the area: both to 1e-12 from errors of 1e-5 and 5e-4, the
   markers' mean stays, and of a displacement along the two gradients nothing but second order is left. Nothing moves
   where the length is off by more than the tolerance, or on a circle. */
static void CheckLength(int derivative) {
  ScopedMembrane w, circle;
  Measures measures, after;
  PetscBool same;
  Create(derivative, "0.25,0.5", 35, &w);
  Create(derivative, "0.4,0.4", 35, &circle);
  const PetscInt n = 2 * w.M;
  const PetscReal L0 = w.membrane->L0[0];
  PetscReal *X = TestReals(n), *before = TestReals(n);
  for (int size = 0; size < 3; size++) {
    const PetscReal epsilon = size == 0 ? 3e-6 : size == 1 ? 1.5e-4 : 3e-3;
    PetscReal drift[2] = {0, 0};
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal t = 2 * PETSC_PI * (k / 2) / w.M;
      X[k] = before[k] = w.scene->shape.X[k] * (1 + epsilon) + epsilon * PetscCosReal(2 * t + k % 2);
    }
    MembraneMeasure(w.membrane, 0, X, &measures);
    TestCall(MembraneRestoreLength(w.membrane, 0, 1e-3, X));
    MembraneMeasure(w.membrane, 0, X, &after);
    for (PetscInt k = 0; k < n; k++) drift[k % 2] += (X[k] - before[k]) / w.M;
    const PetscReal moved = TestFar(n, X, before);
    const PetscReal was = PetscAbsReal(measures.length / L0 - 1), left = PetscAbsReal(after.length / L0 - 1);
    if (size < 2)
      CHECK(was > epsilon && left < 1e-12 && PetscAbsReal(after.area / measures.area - 1) < 1e-12 && moved < 5 * was &&
                PetscAbsReal(drift[0]) + PetscAbsReal(drift[1]) < 1e-14,
            "%s: length off by %.1e, then by %.1e, markers moved by %.1e", derivatives[derivative], was, left, moved);
    else
      CHECK(was > 1e-3 && moved == 0, "%s: a length off by %.1e is left alone", derivatives[derivative], was);
  }
  for (PetscInt k = 0; k < n; k++) X[k] = before[k] = 1.0001 * circle.scene->shape.X[k];
  TestCall(MembraneRestoreLength(circle.membrane, 0, 1e-3, X));
  TestCall(PetscArraycmp(X, before, n, &same));
  CHECK(same, "%s: a circle keeps its length, which its area gives", derivatives[derivative]);
}

void Facts(void) {
  for (int d = 0; d < 3; d++) {
    for (int k = 0; k < 3; k++) CheckRestored(d, k ? 0.03 * k : 3e-3);
    CheckNearest(d);
    CheckQuadratic(d);
    CheckNothingMoves(d);
    CheckLength(d);
  }
}
