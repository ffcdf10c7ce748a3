#include "layers/selflayer.h"

void SelfLogarithm(PetscInt n, PetscReal own[]) {
  for (PetscInt d = 0; d < n; d++) {
    own[d] = 0;
    for (PetscInt m = 1; m <= (n - 1) / 2; m++) own[d] -= 2 * PetscCosReal(2 * PETSC_PI * ((m * d) % n) / n) / m;
    if (n % 2 == 0) own[d] -= (d % 2 ? -2.0 : 2.0) / n;
    if (d) own[d] -= PetscLogReal(4 * PetscSqr(PetscSinReal(PETSC_PI * d / n)));
  }
}

PetscErrorCode SelfLayer(const LayerSetting *set, Spectral spectral, PetscInt n, const PetscReal X[], PetscReal S[]) {
  PetscReal *own, *T, pair[3];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &own));
  PetscCall(PetscCalloc1(2 * n, &T));
  SelfLogarithm(n, own);
  SpectralDerivative(spectral, 1, n / (2 * PETSC_PI), X, T);
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt i = 0; i < n; i++) { /* on the diagonal the derivative takes the place of the difference */
      const PetscReal d[2] = {i == j ? T[2 * i] : X[2 * i] - X[2 * j],
                              i == j ? T[2 * i + 1] : X[2 * i + 1] - X[2 * j + 1]};
      PetscReal *at = S + 2 * j * 2 * n + 2 * i;
      StokesletOne(set, d, own[PetscAbsInt(i - j)], pair);
      at[0] = pair[0];
      at[2 * n + 1] = pair[1];
      at[1] = at[2 * n] = pair[2];
    }
  PetscCall(PetscFree(own));
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}
