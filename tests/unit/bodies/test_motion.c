/* The motion of solid bodies: the velocity of a marker is the rate of change of its place, vectors of the body turn
   with it, and no marker goes farther than its stride. */
#include "facts.h"
#include "bodies/motion.h"

#define N 5

static void CheckMotion(const char name[], const BodyMotion *m, PetscReal t) {
  const PetscReal step = 1e-5, rest[2 * N] = {1.5, 2, 1, 2.7, 0.4, 2, 1, 1.6, 1.2, 1.8}, later = t + 0.4;
  PetscReal X[2 * N], before[2 * N], after[2 * N], U[2], rate = 0, off = 0, far = 0, reach = 0;
  MotionCarry(m, (Instant){t - step}, N, rest, before);
  MotionCarry(m, (Instant){t}, N, rest, X);
  MotionCarry(m, (Instant){t + step}, N, rest, after);
  for (PetscInt k = 0; k < N; k++) {
    MotionVelocity(m, (Instant){t}, X + 2 * k, U);
    for (int c = 0; c < 2; c++) TestWorse(&rate, (after[2 * k + c] - before[2 * k + c]) / (2 * step) - U[c]);
  }
  CheckBelow(rate, 1e-8, "%s, t = %g: places change by the velocity", name, t);
  MotionCarry(m, (Instant){later}, N, rest, after);
  for (PetscInt k = 0; k < N; k++) {
    far = PetscMax(far, PetscHypotReal(after[2 * k] - X[2 * k], after[2 * k + 1] - X[2 * k + 1]));
    reach = PetscMax(reach, PetscHypotReal(rest[2 * k] - m->center[0], rest[2 * k + 1] - m->center[1]));
  }
  CHECK(far <= MotionStride(m, (Instant){t}, (Instant){later}, reach),
        "%s, t = %g: markers go by %.3f at most, in a stride", name, t, far);
  for (PetscInt k = 2; k < 2 * N; k++) before[k] = X[k] - X[k % 2], after[k] -= after[k % 2];
  MotionTurn(m, (Instant){t}, (Instant){later}, N - 1, before + 2);
  for (PetscInt k = 2; k < 2 * N; k++) TestWorse(&off, before[k] - after[k]);
  CheckBelow(off, 1e-14, "%s, t = %g: vectors turn with the body", name, t);
}

void Facts(void) {
  BodyMotion m = {
      .center = {1, 2}, .velocity = {0.3, -0.2}, .rotation = 1.3, .carried = PETSC_TRUE, .turned = PETSC_TRUE};
  const BodyMotion rest = {.center = {1, 2}};
  CheckMotion("at rest", &rest, 0.7);
  for (PetscReal t = 0; t < 1; t += 0.4) CheckMotion("steady", &m, t);
  m.frequency = 2.5;
  for (PetscReal t = 0; t < 1; t += 0.4) CheckMotion("swinging", &m, t);
}
