/* The rows of kernels in unbounded fluid: each is a Stokes flow with its pressure, has the strength that its name says,
   and agrees with what unit sources on the lattice give. */
#include "facts.h"
#include "layers/pairkernel.h"

static const LayerSetting set = {.nu = 0.7, .unit = 1.3};
static const PetscReal N[2] = {0.4, -0.9}; /* normal times length */

/* u, v and p at x by the source component c at the origin. */
static void FlowOf(const PairKernel *k, int c, const PetscReal x[2], PetscReal flow[3]) {
  const Lanes zero = {0}, normal[2] = {N[0] + zero, N[1] + zero};
  Lanes K[3], P[2];
  PairFree(k, &set, x[0] + zero, x[1] + zero, normal, K);
  k->pressure(x[0] + zero, x[1] + zero, normal, P);
  flow[0] = K[c ? 2 : 0][0];
  flow[1] = K[c ? 1 : 2][0];
  flow[2] = P[c][0] * PetscPowRealInt(set.nu, k->viscosity + 1);
}

/* nu LAPLACE u = GRAD p and DIV u = 0 at x, by differences of fourth order. */
static void Residual(const PairKernel *k, int c, const PetscReal x[2], PetscReal *momentum, PetscReal *divergence) {
  static const PetscReal first[5] = {1. / 12, -2. / 3, 0, 2. / 3, -1. / 12};
  static const PetscReal second[5] = {-1. / 12, 4. / 3, -5. / 2, 4. / 3, -1. / 12};
  const PetscReal step = 0.004;
  PetscReal sum[3] = {0, 0, 0};
  for (int dir = 0; dir < 2; dir++)
    for (int q = 0; q < 5; q++) {
      PetscReal at[2] = {x[0], x[1]}, flow[3];
      at[dir] += (q - 2) * step;
      FlowOf(k, c, at, flow);
      for (int i = 0; i < 2; i++) sum[i] += set.nu * second[q] / (step * step) * flow[i];
      sum[dir] -= first[q] / step * flow[2];
      sum[2] += first[q] / step * flow[dir];
    }
  *momentum = TestFar(2, sum, NULL);
  *divergence = sum[2];
}

static void CheckStokes(const PairKernel *k) {
  const PetscReal place[4][2] = {{1.1, 0.3}, {-0.2, 0.9}, {-0.8, -1.2}, {0.1, -1}};
  for (int q = 0; q < 8; q++) {
    PetscReal momentum, divergence;
    Residual(k, q / 4, place[q % 4], &momentum, &divergence);
    CheckBelow(momentum, 2e-7, "%s, component %d, place %d: nu LAPLACE u = GRAD p", k->name, q / 4, q % 4);
    CheckBelow(divergence, 2e-8, "div u");
  }
}

/* The traction of a force on a circle about it is minus the force; a circle of sources with the same jump J gives the
   velocity -J inside and none outside. */
static void CheckStrength(void) {
  enum { POINTS = 64 };
  const PetscReal inside[2] = {0.3, -0.1}, outside[2] = {1.9, 0.4};
  const Lanes zero = {0};
  PetscReal force = 0, jump[2] = {0, 0};
  for (int q = 0; q < POINTS; q++) {
    const PetscReal angle = 2 * PETSC_PI * q / POINTS, n[2] = {PetscCosReal(angle), PetscSinReal(angle)}, e = 1e-4;
    PetscReal flow[3], side[2][3], traction;
    FlowOf(&stokeslet, 0, n, flow);
    for (int s = 0; s < 2; s++)
      FlowOf(&stokeslet, 0, (PetscReal[2]){n[0] * (1 + e * (2 * s - 1)), n[1] * (1 + e * (2 * s - 1))}, side[s]);
    traction = -flow[2] * n[0] + set.nu * (side[1][0] - side[0][0]) / (2 * e);
    for (int s = 0; s < 2; s++) { /* (GRAD u)^T n along x: the derivative by x of u.n */
      PetscReal at[2] = {n[0] + e * (2 * s - 1), n[1]};
      FlowOf(&stokeslet, 0, at, flow);
      traction += set.nu * (2 * s - 1) * (flow[0] * n[0] + flow[1] * n[1]) / (2 * e);
    }
    force += traction * 2 * PETSC_PI / POINTS;
    for (int s = 0; s < 2; s++) {
      const PetscReal *x = s ? outside : inside, w = 2 * PETSC_PI / POINTS;
      Lanes D[3];
      PairFree(&stresslet, &set, x[0] - n[0] + zero, x[1] - n[1] + zero,
               (const Lanes[2]){w * n[0] + zero, w * n[1] + zero}, D);
      jump[s] += D[0][0];
    }
  }
  CheckBelow(force + 1, 1e-7, "the traction of a unit force adds up to -1");
  CheckBelow(jump[0] + 1, 1e-10, "a circle of unit jumps: inside");
  CheckBelow(jump[1], 1e-10, "outside");
}

/* Unit sources with the parts of a source (force, or tensor of J and N) give its K. */
static void CheckParts(const PairKernel *k) {
  const Lanes x = {0.3, -1.2, 2, -0.7}, y = {0.8, 0.1, -1.5, -0.6}, normal[2] = {N[0] + (Lanes){0}, N[1] + (Lanes){0}};
  Lanes part[PAIR_PARTS], K[4], free[3];
  PetscReal worst = 0;
  k->parts(&set, x, y, part);
  k->contract(part, normal, K);
  PairFree(k, &set, x, y, normal, free);
  for (int q = 0; q < 4; q++)
    for (int t = 0; t < LANES; t++) TestWorse(&worst, K[q][t] - free[PetscMin(q, 2)][t]);
  CheckBelow(worst, 1e-15, "%s: parts of unit sources make the kernel", k->name);
}

void Facts(void) {
  const PairKernel *const kernels[] = {&stokeslet, &stresslet};
  for (int k = 0; k < 2; k++) {
    CheckStokes(kernels[k]);
    CheckParts(kernels[k]);
  }
  CheckStrength();
}
