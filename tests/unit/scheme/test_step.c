/* What a step of the scheme coupled solves: U = a0 (X - Xhat) + V dX/ds, with the history in labels that turn at the
   fitted speed V, and in those of the markers where the membrane is not spectral. */
#include "facts.h"
#include "scheme/coupled.h"

#define FIRST 4 /* states: the newest and three before it */

/* The trigonometric polynomial through an odd number of points, at labels phi farther on. */
static void Shift(PetscInt n, const PetscReal x[], PetscReal phi, PetscReal y[]) {
  for (PetscInt i = 0; i < 2 * n; i++) y[i] = 0;
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < n; j++) {
      const PetscReal half = PETSC_PI * (k - j) / n + phi / 2, s = n * PetscSinReal(half);
      const PetscReal weight = PetscAbsReal(s) < 1e-14 ? 1 : PetscSinReal(n * half) / s;
      for (int c = 0; c < 2; c++) y[2 * k + c] += weight * x[2 * j + c];
    }
}

/* Its derivative at the points. */
static void Derivative(PetscInt n, const PetscReal x[], PetscReal y[]) {
  for (PetscInt i = 0; i < 2 * n; i++) y[i] = 0;
  for (PetscInt k = 0; k < n; k++)
    for (PetscInt j = 0; j < n; j++)
      for (int c = 0; c < 2 && j != k; c++)
        y[2 * k + c] += ((k - j) % 2 ? -0.5 : 0.5) / PetscSinReal(PETSC_PI * (k - j) / n) * x[2 * j + c];
}

/* Take the mean off. */
static void Center(PetscInt n, PetscReal x[]) {
  for (int c = 0; c < 2; c++) {
    PetscReal mean = 0;
    for (PetscInt k = 0; k < n; k++) mean += x[2 * k + c] / n;
    for (PetscInt k = 0; k < n; k++) x[2 * k + c] -= mean;
  }
}

/* The speed of labels that fits a velocity best, beside a translation and a rotation: least squares. */
static PetscReal Speed(PetscInt n, const PetscReal X[], const PetscReal velocity[], PetscReal work[]) {
  PetscReal *along = work, *about = work + 2 * n, *U = work + 4 * n, aa = 0, ar = 0, rr = 0, au = 0, ru = 0;
  Derivative(n, X, along);
  for (PetscInt i = 0; i < 2 * n; i++) about[i] = X[i];
  for (PetscInt i = 0; i < 2 * n; i++) U[i] = velocity[i];
  Center(n, about);
  Center(n, U);
  for (PetscInt i = 0; i < 2 * n; i++) {
    const PetscReal turn = i % 2 ? about[i - 1] : -about[i + 1];
    aa += along[i] * along[i];
    ar += along[i] * turn;
    rr += turn * turn;
    au += along[i] * U[i];
    ru += turn * U[i];
  }
  return (au * rr - ru * ar) / (aa * rr - ar * ar);
}

static void CheckFormula(const char options[], PetscReal dt, PetscBool turns, int order) {
  static const PetscReal a[4][4] = {{0}, {1, 1}, {3. / 2, 2, -1. / 2}, {11. / 6, 3, -3. / 2, 1. / 3}};
  const char *last = strstr(options, "-vesicle_bending");
  ScopedWorld w;
  PetscReal *X[FIRST], *U[2], speed = 0;
  TestRunCreate(&w, "%s -scheme_order %d -time_step %.17g", options, order, dt);
  const PetscInt n = w.layout->M;
  for (int k = 0; k < 16; k++) TestCall(SchemeStep(w.scheme, PETSC_MAX_REAL));
  PetscReal *found = TestReals(2 * n), *shifted = TestReals(2 * n), *work = TestReals(6 * n);
  for (int k = 0; k < FIRST; k++) {
    const State *state = k ? &w.scheme->old[k - 1] : &w.scheme->state;
    TestCall(LayoutGatherVec(w.layout, state->X, X[k] = TestReals(2 * n)));
    if (k < 2) TestCall(LayoutGatherVec(w.layout, state->U, U[k] = TestReals(2 * n)));
  }
  if (turns) speed = Speed(n, X[1], U[1], work);
  Derivative(n, X[0], work);
  for (PetscInt i = 0; i < 2 * n; i++) found[i] = a[order][0] * X[0][i] / dt + speed * work[i];
  for (int k = 1; k <= order; k++) {
    Shift(n, X[k], speed * k * dt, shifted);
    for (PetscInt i = 0; i < 2 * n; i++) found[i] -= a[order][k] * shifted[i] / dt;
  }
  const PetscReal off = TestFar(2 * n, found, U[0]);
  CHECK(!*w.scheme->report.failure && off < 1e-12 && turns == (PetscAbsReal(speed) > 0.3),
        "%s, dt = %g: order %d, labels that turn at %.2f: U is the formula's, %.1e", last ? last : "chords", dt, order,
        speed, off);
}

#define SHEAR                                                                                                          \
  "-domain_box -4,4,-4,4 -domain_cells 32,32 -fluid_inertia none -flow_type shear "                                    \
  "-vesicle_reduced_area 0.7 -vesicle_area 2.199114857512855 -vesicle_angle 17 -membrane_derivative spectral "         \
  "-delta_type cbs54 "                                                                                                 \
  "-coupling_near_field exact -vesicle_markers 45 -vesicle_allow_close_markers "

void Facts(void) {
  for (int k = 0; k < 27; k++) {
    static const PetscReal bending[] = {0.1, 0.3, 1}, dt[] = {0.125, 0.1, 0.08};
    CheckFormula(TestText(SHEAR "-vesicle_bending %g", bending[k / 9]), dt[k / 3 % 3], PETSC_TRUE, 1 + k % 3);
  }
  CheckFormula(SHEAR "-membrane_derivative bending", 0.125, PETSC_FALSE, 2);
}
