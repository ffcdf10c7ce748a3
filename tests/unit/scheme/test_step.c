/* What a step of the scheme coupled solves: U = a0 (X - Xhat) + V dX/ds, with the history in labels that turn at the
   fitted speed V, and in those of the markers where the membrane is not spectral. */
#include "facts.h"
#include "scheme/coupled.h"

TestScoped(Spectral, SpectralDestroy);

#define FIRST 4 /* states: the newest and three before it */

/* Take the mean off. */
static void Center(PetscInt n, PetscReal x[]) {
  for (int c = 0; c < 2; c++) {
    PetscReal mean = 0;
    for (PetscInt k = 0; k < n; k++) mean += x[2 * k + c] / n;
    for (PetscInt k = 0; k < n; k++) x[2 * k + c] -= mean;
  }
}

/* The speed of labels that fits a velocity best, beside a translation and a rotation: least squares. */
static PetscReal Speed(PetscInt n, Spectral s, const PetscReal X[], const PetscReal velocity[]) {
  PetscReal *along = TestReals(2 * n), *about = TestReals(2 * n), *U = TestReals(2 * n), *turn = TestReals(2 * n);
  SpectralDerivative(s, 1, n / (2 * PETSC_PI), X, along);
  TestCall(PetscArraycpy(about, X, 2 * n));
  TestCall(PetscArraycpy(U, velocity, 2 * n));
  Center(n, about);
  Center(n, U);
  for (PetscInt i = 0; i < 2 * n; i++) turn[i] = i % 2 ? about[i - 1] : -about[i + 1];
  const PetscReal aa = TestProduct(2 * n, along, along), ar = TestProduct(2 * n, along, turn),
                  rr = TestProduct(2 * n, turn, turn), au = TestProduct(2 * n, along, U),
                  ru = TestProduct(2 * n, turn, U);
  return (au * rr - ru * ar) / (aa * rr - ar * ar);
}

static void CheckFormula(const char options[], PetscReal dt, PetscBool turns, int order) {
  static const PetscReal a[4][4] = {{0}, {1, 1}, {3. / 2, 2, -1. / 2}, {11. / 6, 3, -3. / 2, 1. / 3}};
  Scoped(Spectral) s;
  ScopedWorld w;
  PetscReal *X[FIRST], *U[2], speed = 0;
  TestRunCreate(&w, "%s -scheme_order %d -time_step %.17g", options, order, dt);
  const PetscInt n = w.layout->M;
  TestCall(SpectralCreate(n, &s));
  for (int k = 0; k < 16; k++) TestCall(SchemeStep(w.scheme, PETSC_MAX_REAL));
  PetscReal *found = TestReals(2 * n), *shifted = TestReals(2 * n);
  for (int k = 0; k < FIRST; k++) {
    const State *state = k ? &w.scheme->old[k - 1] : &w.scheme->state;
    TestCall(LayoutGatherVec(w.layout, state->X, X[k] = TestReals(2 * n)));
    if (k < 2) TestCall(LayoutGatherVec(w.layout, state->U, U[k] = TestReals(2 * n)));
  }
  if (turns) speed = Speed(n, s, X[1], U[1]);
  SpectralDerivative(s, 1, speed * n / (2 * PETSC_PI), X[0], found);
  for (int k = 0; k <= order; k++) {
    SpectralShift(s, 2, speed * k * dt, X[k], shifted);
    for (PetscInt i = 0; i < 2 * n; i++) found[i] += (k ? -1 : 1) * a[order][k] * shifted[i] / dt;
  }
  TestAbout("%s, dt = %g, order %d", strstr(options, "-v"), dt, order);
  CHECK(!*w.scheme->report.failure && turns == (PetscAbsReal(speed) > 0.3), "labels turn at %.2f", speed);
  CheckBelow(TestFar(2 * n, found, U[0]), 1e-12, "U is the formula's");
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
