/* What a kernel takes from a plane membrane's mobility, by quadrature of its weights (DESIGN section 8). */
#include "coupling/selfmobility.h"

#define CONSTANT_POSITIONS 1000 /* sub-cell positions that the constant is averaged over */
#define POSITIONS 32            /* those that the transforms are averaged over */
#define WAVES 4000              /* midpoints of the wave numbers across the membrane, up to pi/h */

PetscErrorCode SmoothingConstant(const Kernel *kernel, PetscReal *c) {
  const KernelWeights both[] = {kernel->along, kernel->across};
  PetscFunctionBeginUser;
  *c = 0;
  for (int side = 0; side < 2; side++)
    for (int s = 0; s < CONSTANT_POSITIONS; s++) {
      PetscReal w[KERNEL_MAX_POINTS];
      PetscInt first;
      const PetscInt n = both[side]((s + 0.5) / CONSTANT_POSITIONS, &first, w);
      for (PetscInt i = 0; i < n; i++)
        for (PetscInt j = 0; j < n; j++) *c += PetscAbsInt(i - j) * w[i] * w[j] / (4 * CONSTANT_POSITIONS);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |transform of the weights|^2 at theta = wave number times h, mean over sub-cell positions. */
static PetscReal Power(KernelWeights weights, PetscReal theta) {
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
  return sum / POSITIONS;
}

PetscErrorCode PlaneSymbols(const Kernel *kernel, PetscReal h, PetscReal a0, PetscReal nu, PetscInt n, PetscReal L,
                            PetscReal dT[], PetscReal dN[]) {
  PetscReal *along, *across;
  const PetscReal dq = PETSC_PI / (h * WAVES);
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(WAVES, &along, WAVES, &across));
  for (PetscInt i = 0; i < WAVES; i++) {
    along[i] = Power(kernel->along, (i + 0.5) * dq * h);
    across[i] = Power(kernel->across, (i + 0.5) * dq * h);
  }
  for (PetscInt m = 0; m <= n / 2; m++) {
    const PetscReal k = 2 * PETSC_PI * m / L, kappa = PetscSqrtReal(k * k + a0 / nu);
    const PetscReal k2 = PetscSqr(2 / h * PetscSinReal(k * h / 2));
    const PetscReal k_along = Power(kernel->along, k * h), k_across = Power(kernel->across, k * h);
    PetscReal T = 1 / (2 * nu * (kappa + k)), N = k / (2 * nu * kappa * (kappa + k));
    for (PetscInt i = 0; i < WAVES; i++) { /* twice the integral over q > 0, over 2 pi */
      const PetscReal q2 = PetscSqr(2 / h * PetscSinReal((i + 0.5) * dq * h / 2)), d = k2 + q2;
      const PetscReal r = 0.5 * (k_along * across[i] + k_across * along[i]) / (d * (a0 + nu * d)) * dq / PETSC_PI;
      T -= r * q2;
      N -= r * k2;
    }
    dT[m] = PetscMax(T, 0);
    dN[m] = PetscMax(N, 0);
    if (m) {
      dT[n - m] = dT[m];
      dN[n - m] = dN[m];
    }
  }
  PetscCall(PetscFree2(along, across));
  PetscFunctionReturn(PETSC_SUCCESS);
}
