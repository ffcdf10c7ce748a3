/* Edges corrected after a step (src/bodies/restore.c): exact on known shapes, Newton's quadratic convergence, the
   least displacement, and nothing where nothing is wrong or no freedom is left. */
#include "facts.h"

static const char *const derivatives[] = {"fd", "bending", "spectral"};

#define M 35
#define N (2 * M)

/* Membrane on an ellipse, turned, off the middle. */
static void Create(int derivative, const char axes[], TestMembrane *w) {
  TestMembraneCreate(w,
                     "-domain_cells 64,64 -domain_box 3,5,-1,1 -vesicle_semi_axes %s -vesicle_angle 25 "
                     "-vesicle_center 4.1,0.05 -vesicle_markers %d -membrane_derivative %s -scheme_type coupled",
                     axes, M, derivatives[derivative]);
}

/* Largest relative error of edges. */
static PetscReal EdgeError(const TestMembrane *w, const PetscReal X[]) {
  PetscReal e[N], error = 0;
  MembraneEdges(w->membrane, 0, X, e);
  for (PetscInt k = 0; k < N; k += 2)
    TestWorse(&error, PetscSqrtReal(PetscSqr(e[k]) + PetscSqr(e[k + 1])) / w->membrane->ds[0] - 1);
  return error;
}

static PetscReal AreaOf(const TestMembrane *w, const PetscReal X[]) {
  Measures measures;
  MembraneMeasure(w->membrane, 0, X, &measures);
  return measures.area;
}

/* How far the markers' mean has moved. */
static PetscReal Drift(const PetscReal X[], const PetscReal before[]) {
  PetscReal drift[2] = {0, 0};
  for (PetscInt k = 0; k < N; k++) drift[k % 2] += (X[k] - before[k]) / M;
  return PetscAbsReal(drift[0]) + PetscAbsReal(drift[1]);
}

/* Random waves, and markers by themselves: edges are off by about epsilon. Afterwards all edges have their length, the
   area is the one before, and markers have not moved as a whole (a least displacement has no part that no constraint
   asks for). */
static void CheckRestored(int derivative, PetscReal epsilon) {
  ScopedMembrane w;
  unsigned seed = 3;
  const PetscReal *wave = TestRandoms(8, &seed);
  PetscReal *X = TestRandoms(N, &seed), before[N], found;
  Create(derivative, "0.25,0.5", &w);
  for (PetscInt k = 0; k < N; k++) {
    X[k] = w.scene->shape.X[k] + 0.2 * epsilon * w.membrane->ds[0] * X[k];
    for (int q = 0; q < 4; q++)
      X[k] += epsilon * 0.1 * wave[2 * q + k % 2] * PetscCosReal(2 * PETSC_PI * (q + 1) * (k / 2) / M) / (q + 1);
    before[k] = X[k];
  }
  const PetscReal wrong = EdgeError(&w, X);
  TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-3, X, &found));
  CHECK(wrong > 0.3 * epsilon && found == wrong, "edges off by %.1e, %.1e found", wrong, found);
  CheckBelow(EdgeError(&w, X), 1e-12, "edges afterwards");
  CheckBelow(AreaOf(&w, X) / AreaOf(&w, before) - 1, 1e-12, "area");
  CheckBelow(Drift(X, before), 1e-14, "the markers' mean stays");
}

/* Gradient of the area at the initial markers, by differences: exact, as the polygon's and the spectral curve's areas
   are quadratic. */
static void AreaGradient(const TestMembrane *w, PetscReal gradient[]) {
  const PetscReal step = 1e-3;
  PetscReal X[N];
  TestCall(PetscArraycpy(X, w->scene->shape.X, N));
  for (PetscInt k = 0; k < N; k++) {
    const PetscReal x = X[k];
    X[k] = x + step;
    gradient[k] = AreaOf(w, X) / (2 * step);
    X[k] = x - step;
    gradient[k] -= AreaOf(w, X) / (2 * step);
    X[k] = x;
  }
}

/* A displacement across the shapes with the right edges: J^T lambda, J^T of edges alone being that of MembraneEdges. It
   must not change the area, so a multiple of the area's gradient (normals) is taken off. Of largest entry 1. */
static void Across(const TestMembrane *w, PetscReal across[]) {
  const Membrane m = w->membrane;
  PetscReal e[N], normal[N];
  AreaGradient(w, normal);
  MembraneEdges(m, 0, w->scene->shape.X, e);
  for (PetscInt k = 0; k < N; k++) e[k] *= 0.5 + PetscCosReal(3 * PETSC_PI * (k - k % 2) / M + 0.4);
  MembraneEdgesTranspose(m, 0, 1, e, across);
  const PetscReal flux = TestProduct(N, across, normal), size = TestProduct(N, normal, normal);
  for (PetscInt k = 0; k < N; k++) across[k] -= flux / size * normal[k];
  const PetscReal largest = TestFar(N, across, NULL);
  for (PetscInt k = 0; k < N; k++) across[k] /= largest;
}

/* The shape found is the nearest: from X_0 + t J^T lambda, J^T lambda being across the shapes with the right edges,
   back to X_0 but for O(t^2). */
static void CheckNearest(int derivative) {
  ScopedMembrane w;
  PetscReal off[2], across[N] = {0}, X[N], found;
  Create(derivative, "0.25,0.5", &w);
  const PetscReal *X0 = w.scene->shape.X, ds = w.membrane->ds[0];
  Across(&w, across);
  for (int t = 0; t < 2; t++) {
    for (PetscInt k = 0; k < N; k++) X[k] = X0[k] + (t ? 0.005 : 0.01) * ds * across[k];
    TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-6, X, &found));
    off[t] = TestFar(N, X, X0);
  }
  CheckBelow(off[0] / off[1] - 4, 0.4, "back to the nearest shape but for second order, off by %.1e of %.1e", off[0],
             ds);
  CheckBelow(off[0] / ds, 0.001, "back to the nearest shape");
}

/* What is left after one, two and three steps of Newton: the square of what was left before, times a constant. */
static void CheckQuadratic(int derivative) {
  ScopedMembrane w;
  PetscReal left[4], X[N];
  Create(derivative, "0.25,0.5", &w);
  for (PetscInt most = 0; most < 4; most++) {
    for (PetscInt k = 0; k < N; k++)
      X[k] = w.scene->shape.X[k] - (k % 2 ? 0.05 : 4.1) + 0.01 * PetscCosReal(6 * PETSC_PI * (k / 2) / M + k % 2);
    TestCall(CurveFit(M, derivative == 2, M * w.membrane->ds[0], w.membrane->A0[0], X, most, &left[most]));
  }
  CHECK(left[0] > 0.03 && left[1] < 0.5 * left[0], "%.1e, after a step of Newton %.1e", left[0], left[1]);
  for (int k = 1; k < 3; k++)
    CheckBelow(left[k + 1], 5 * PetscSqr(left[k]) + 1e-13, "after another step %.1f times the square",
               left[k + 1] / PetscSqr(left[k]));
}

/* Nothing moves below the tolerance, nor on a blown-up circle, whose area edges of the right length cannot enclose. */
static void CheckNothingMoves(int derivative) {
  static const char *const axes[] = {"0.25,0.5", "0.4,0.4"};
  for (int circle = 0; circle < 2; circle++) {
    ScopedMembrane w;
    PetscReal found, X[N], before[N];
    Create(derivative, axes[circle], &w);
    for (PetscInt k = 0; k < N; k++) X[k] = before[k] = (circle ? 1.01 : 1.0009) * w.scene->shape.X[k];
    TestCall(MembraneRestoreEdges(w.membrane, 0, 1e-3, X, &found));
    CHECK(TestFar(N, X, before) == 0 && found == 0, "%s moves nothing",
          circle ? "a circle that is too large" : "an edge error of 9e-4");
  }
}

/* The length made right by the least displacement that leaves the area: both to 1e-12 from errors of 1e-5 and 5e-4, the
   markers' mean stays, and of a displacement along the two gradients nothing but second order is left. Nothing moves
   where the length is off by more than the tolerance, or on a circle. */
static void CheckLength(int derivative) {
  static const PetscReal sizes[] = {3e-6, 1.5e-4, 3e-3};
  ScopedMembrane w, circle;
  PetscReal X[N], before[N];
  Create(derivative, "0.25,0.5", &w);
  Create(derivative, "0.4,0.4", &circle);
  const PetscReal L0 = w.membrane->L0[0];
  for (int size = 0; size < 3; size++) {
    const PetscReal epsilon = sizes[size];
    Measures measures, after;
    for (PetscInt k = 0; k < N; k++)
      X[k] = before[k] = w.scene->shape.X[k] * (1 + epsilon) +
                         epsilon * PetscCosReal(4 * PETSC_PI * (k / 2) / M + k % 2);
    MembraneMeasure(w.membrane, 0, X, &measures);
    TestCall(MembraneRestoreLength(w.membrane, 0, 1e-3, X));
    MembraneMeasure(w.membrane, 0, X, &after);
    const PetscReal moved = TestFar(N, X, before), was = PetscAbsReal(measures.length / L0 - 1);
    if (size == 2) {
      CHECK(was > 1e-3 && moved == 0, "a length off by %.1e is left alone", was);
      continue;
    }
    CHECK(was > epsilon && moved < 5 * was, "length off by %.1e, markers moved by %.1e", was, moved);
    CheckBelow(after.length / L0 - 1, 1e-12, "length afterwards");
    CheckBelow(after.area / measures.area - 1, 1e-12, "area");
    CheckBelow(Drift(X, before), 1e-14, "the markers' mean stays");
  }
  for (PetscInt k = 0; k < N; k++) X[k] = before[k] = 1.0001 * circle.scene->shape.X[k];
  TestCall(MembraneRestoreLength(circle.membrane, 0, 1e-3, X));
  CHECK(TestFar(N, X, before) == 0, "a circle keeps its length, which its area gives");
}

void Facts(void) {
  for (int d = 0; d < 3; d++) {
    TestAbout("%s", derivatives[d]);
    for (int k = 0; k < 3; k++) CheckRestored(d, k ? 0.03 * k : 3e-3);
    CheckNearest(d);
    CheckQuadratic(d);
    CheckNothingMoves(d);
    CheckLength(d);
  }
}
