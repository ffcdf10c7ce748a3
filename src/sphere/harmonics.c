#include "sphere/harmonics.h"

PetscInt HarmonicsDegree(PetscInt k) {
  return (PetscInt)PetscSqrtReal((PetscReal)k + 0.5);
}

/* P[l][m], m <= most, at x = cos theta, s = sin theta, rows of p + 1; 0 for m > l. */
static void LegendreAt(PetscInt p, PetscInt most, PetscReal x, PetscReal s, PetscReal P[]) {
  const PetscInt row = p + 1;
  P[0] = PetscSqrtReal(1 / (4 * PETSC_PI));
  for (PetscInt m = 1; m <= most; m++)
    P[m * row + m] = PetscSqrtReal((2 * m + 1.) / (2 * m)) * s * P[(m - 1) * row + m - 1];
  for (PetscInt m = 0; m <= most && m < p; m++) {
    P[(m + 1) * row + m] = PetscSqrtReal(2 * m + 3.) * x * P[m * row + m];
    for (PetscInt l = m + 2; l <= p; l++) {
      const PetscReal a = PetscSqrtReal((4. * l * l - 1) / (l * l - m * m)),
                      b = PetscSqrtReal(((l - 1.) * (l - 1) - m * m) / (4. * (l - 1) * (l - 1) - 1));
      P[l * row + m] = a * (x * P[(l - 1) * row + m] - b * P[(l - 2) * row + m]);
    }
  }
}

/* The entries of one point for l and m >= 0. turn: cos and sin of m phi, times root 2 where m > 0. at[part]: where
   Y_(l, 0) of this point is; apart: numbers from one k to the next. A: P_lm and its first and second derivative in
   theta. */
static void HarmonicsSet(PetscInt m, const PetscReal turn[2], const PetscReal A[3], PetscInt parts,
                         PetscReal *const at[], PetscInt apart) {
  for (int side = 0; side <= (m > 0); side++) {
    const PetscReal T = turn[side], dT = side ? m * turn[0] : -m * turn[1];
    const PetscInt k = side ? -m * apart : m * apart;
    const PetscReal entry[] = {A[0] * T, A[1] * T, A[0] * dT, A[2] * T, A[1] * dT, -A[0] * T * m * m};
    for (PetscInt part = 0; part < parts; part++) at[part][k] = entry[part];
  }
}

PetscErrorCode HarmonicsAt(PetscInt p, PetscInt most, PetscInt n, const PetscReal theta[], const PetscReal phi[],
                           PetscInt parts, PetscReal table[]) {
  const PetscInt count = HarmonicsCount(p), row = p + 1;
  PetscReal *P;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(row * row, &P));
  for (PetscInt i = 0; i < n; i++) {
    const PetscReal x = PetscCosReal(theta[i]), s = PetscSinReal(theta[i]);
    if (i == 0 || theta[i] != theta[i - 1]) LegendreAt(p, most, x, s, P);
    for (PetscInt m = 0; m <= most; m++) {
      const PetscReal scale = m ? PETSC_SQRT2 : 1;
      const PetscReal turn[2] = {scale * PetscCosReal(m * phi[i]), scale * PetscSinReal(m * phi[i])};
      for (PetscInt l = m; l <= p; l++) {
        PetscReal A[3] = {P[l * row + m], 0, 0}, *at[HARMONIC_PARTS];
        if (parts > 1) {
          const PetscReal lower = l > m ? PetscSqrtReal((2 * l + 1.) * (l * l - m * m) / (2 * l - 1)) *
                                              P[(l - 1) * row + m]
                                        : 0;
          A[1] = (l * x * A[0] - lower) / s;
          A[2] = -x / s * A[1] + (m * m / (s * s) - l * (l + 1)) * A[0];
        }
        for (PetscInt part = 0; part < parts; part++) at[part] = table + (part * count + l * l + l) * n + i;
        HarmonicsSet(m, turn, A, parts, at, n);
      }
    }
  }
  PetscCall(PetscFree(P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HarmonicsRevolvedAt(PetscInt p, PetscInt n, const PetscReal theta[], const PetscReal phi[],
                                   PetscInt parts, PetscReal table[]) {
  const PetscInt count = HarmonicsCount(p);
  PetscReal *one;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(parts * count, &one));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal *entry = table + i;
    PetscCall(HarmonicsAt(p, 1, 1, theta + i, phi + i, parts, one));
    for (PetscInt part = 0; part < parts; part++)
      for (PetscInt group = 0; group < 3; group++)
        for (PetscInt l = group ? 1 : 0; l <= p; l++, entry += n)
          *entry = one[part * count + l * l + l + (group == 2 ? -1 : group)] / (group ? PETSC_SQRT2 : 1);
  }
  PetscCall(PetscFree(one));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void HarmonicsTurn(PetscInt p, PetscReal angle, PetscBool back, const PetscReal x[], PetscReal y[]) {
  for (PetscInt m = 0; m <= p; m++) {
    const PetscReal c = PetscCosReal(m * angle), s = back ? -PetscSinReal(m * angle) : PetscSinReal(m * angle);
    for (PetscInt l = m; l <= p; l++) {
      const PetscInt k = l * l + l;
      y[k + m] = c * x[k + m] + s * x[k - m];
      if (m) y[k - m] = c * x[k - m] - s * x[k + m];
    }
  }
}
