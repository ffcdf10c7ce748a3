/* What a kernel takes from a plane membrane's mobility, by quadrature of its weights (DESIGN section 8). */
#include "coupling/selfmobility.h"

#define SAMPLES 800  /* of a kernel's cell, for c1 */
#define POSITIONS 32 /* sub-cell positions that the transforms are averaged over */
#define WAVES 4000   /* midpoints of the wave numbers across the membrane, up to pi/h */

/* Samples of one 1-D weight, phi at spacing 1/SAMPLES over its support from -3 to 3. */
static PetscReal OneConstant(KernelWeights weights, PetscReal phi[]) {
  const PetscInt n = 2 * 3 * SAMPLES;
  PetscReal sum = 0, c1 = 0;
  for (PetscInt i = 0; i < n; i++) phi[i] = 0;
  for (PetscInt s = 0; s < SAMPLES; s++) {
    PetscReal w[KERNEL_MAX_POINTS];
    PetscInt first;
    const PetscInt count = weights((s + 0.5) / SAMPLES, &first, w);
    for (PetscInt k = 0; k < count; k++) { /* phi(x - j) at x = (s + 1/2)/SAMPLES */
      const PetscInt at = s - (first + k) * SAMPLES + 3 * SAMPLES;
      if (at >= 0 && at < n) phi[at] = w[k];
    }
  }
  for (PetscInt i = 0; i < n; i++) sum += phi[i];
  /* 1/2 INT INT |r - s| phi(r) phi(s) = INT F (1 - F), F the cumulative integral of phi */
  for (PetscInt i = 0; i < n; i++) phi[i] = (i ? phi[i - 1] : 0) + phi[i] / sum;
  for (PetscInt i = 0; i < n; i++) c1 += phi[i] * (1 - phi[i]) / SAMPLES;
  return c1;
}

PetscErrorCode SmoothingConstant(const Kernel *kernel, PetscReal *c1) {
  PetscReal *phi;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * 3 * SAMPLES, &phi));
  *c1 = 0.5 * (OneConstant(kernel->along, phi) + OneConstant(kernel->across, phi));
  PetscCall(PetscFree(phi));
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
