/* What a kernel takes from a plane membrane's mobility, by sums over its weights (docs/accuracy.md). */
#include "coupling/selfmobility.h"

#define POSITIONS 32 /* sub-cell positions that products of weights are averaged over, in each direction */
#define TABLE 500    /* intervals of the transforms' tables, 0 to pi */
#define WAVES 4000   /* midpoints of the wave numbers across the membrane, as far as the grid has them */
#define MOST_DIAGONALS (2 * KERNEL_MAX_POINTS)

PetscReal SmoothingSum(PetscInt n, const PetscReal w[]) {
  PetscReal c = 0;
  for (PetscInt i = 0; i < n; i++)
    for (PetscInt j = 0; j < i; j++) c += (i - j) * w[i] * w[j];
  return c;
}

PetscErrorCode SmoothingConstants(const Kernel *kernel, PetscReal c[2]) {
  PetscFunctionBeginUser;
  c[0] = c[1] = 0;
  for (int s = 0; s < POSITIONS; s++)
    for (int r = 0; r < POSITIONS; r++) {
      PetscReal x[KERNEL_MAX_POINTS], y[KERNEL_MAX_POINTS], diagonal[MOST_DIAGONALS] = {0};
      PetscInt first;
      const PetscInt nx = kernel->along((s + 0.5) / POSITIONS, &first, x);
      const PetscInt ny = kernel->across((r + 0.5) / POSITIONS, &first, y);
      for (PetscInt i = 0; i < nx; i++) /* points of one diagonal are alike for a membrane along it */
        for (PetscInt j = 0; j < ny; j++) diagonal[j - i + nx - 1] += x[i] * y[j];
      c[0] += SmoothingSum(ny, y) / PetscSqr(POSITIONS);
      c[1] += SmoothingSum(nx + ny - 1, diagonal) / (PETSC_SQRT2 * PetscSqr(POSITIONS)); /* h/sqrt(2) apart */
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |transform of the weights| at theta = wave number times h, root of the mean square over sub-cell positions. */
static PetscReal Transform(KernelWeights weights, PetscReal theta) {
  PetscReal sum = 0;
  for (int s = 0; s < POSITIONS; s++) {
    PetscReal w[KERNEL_MAX_POINTS], re = 0, im = 0;
    PetscInt first;
    const PetscInt n = weights((s + 0.5) / POSITIONS, &first, w);
    for (PetscInt k = 0; k < n; k++) {
      re += w[k] * PetscCosReal(theta * k);
      im += w[k] * PetscSinReal(theta * k);
    }
    sum += re * re + im * im;
  }
  return PetscSqrtReal(sum / POSITIONS);
}

/* The table's value at theta in [-pi, pi]. */
static PetscReal Look(const PetscReal table[], PetscReal theta) {
  const PetscReal at = PetscAbsReal(theta) / PETSC_PI * TABLE;
  const PetscInt i = PetscMin((PetscInt)at, TABLE - 1);
  return table[i] + (at - i) * (table[i + 1] - table[i]);
}

/* T_grid, N_grid and X_grid of the wave number k: the integral over q, over 2 pi, of d.W A W d' with d, d' the tangent,
   the normal, one of each; A = (I - K~ K~^T/|K~|^2)/(a0 + nu |K~|^2), W the kernel's transforms of the
   two components. */
static void GridMobility(PetscReal *const table[2], PetscReal h, PetscReal a0, PetscReal nu, PetscReal angle,
                         PetscReal k, PetscReal mobility[3]) {
  const PetscReal c = PetscCosReal(angle), s = PetscSinReal(angle);
  const PetscReal reach = (PETSC_PI / h - k * s) / c,
                  dq = reach / WAVES; /* K stays within pi/h for angles up to pi/4 */
  mobility[0] = mobility[1] = mobility[2] = 0;
  for (PetscInt i = -WAVES; i < WAVES; i++) {
    const PetscReal q = (i + 0.5) * dq, Kx = h * (k * c - q * s), Ky = h * (k * s + q * c);
    const PetscReal kx = 2 / h * PetscSinReal(Kx / 2), ky = 2 / h * PetscSinReal(Ky / 2), k2 = kx * kx + ky * ky;
    const PetscReal Wx = Look(table[0], Kx) * Look(table[1], Ky), Wy = Look(table[1], Kx) * Look(table[0], Ky);
    /* f.(I - K~ K~^T/k2) f' = (f x K~)(f' x K~)/k2 */
    const PetscReal tangent = Wx * c * ky - Wy * s * kx, normal = -Wx * s * ky - Wy * c * kx;
    const PetscReal r = dq / (2 * PETSC_PI * k2 * (a0 + nu * k2));
    mobility[0] += tangent * tangent * r;
    mobility[1] += normal * normal * r;
    mobility[2] += tangent * normal * r;
  }
}

PetscErrorCode PlaneSymbols(const Kernel *kernel, PetscReal h, PetscReal a0, PetscReal nu, PetscReal angle, PetscInt n,
                            PetscReal L, PetscReal dT[], PetscReal dN[], PetscReal dX[]) {
  PetscReal *table[2];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(TABLE + 1, &table[0], TABLE + 1, &table[1]));
  for (PetscInt i = 0; i <= TABLE; i++) {
    table[0][i] = Transform(kernel->along, PETSC_PI * i / TABLE);
    table[1][i] = Transform(kernel->across, PETSC_PI * i / TABLE);
  }
  for (PetscInt m = 0; m <= n / 2; m++) {
    const PetscReal k = 2 * PETSC_PI * m / L, kappa = PetscSqrtReal(k * k + a0 / nu);
    PetscReal grid[3];
    GridMobility(table, h, a0, nu, angle, k, grid);
    dT[m] = PetscMax(1 / (2 * nu * (kappa + k)) - grid[0], 0);
    dN[m] = PetscMax(k / (2 * nu * kappa * (kappa + k)) - grid[1], 0);
    dX[m] = -grid[2];
    if (m) {
      dT[n - m] = dT[m];
      dN[n - m] = dN[m];
      dX[n - m] = dX[m];
    }
  }
  PetscCall(PetscFree2(table[0], table[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
