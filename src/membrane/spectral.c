#include "membrane/spectral.h"
#include <fftw3.h>

struct _p_Spectral {
  PetscInt n;
  double *line, *hat; /* hat: real and imaginary parts in turn */
  fftw_plan forward, backward;
};

PetscErrorCode SpectralCreate(PetscInt n, Spectral *out) {
  Spectral s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->n = n;
  s->hat = fftw_alloc_real(2 * (size_t)(n / 2 + 1));
  s->line = fftw_alloc_real((size_t)n);
  s->forward = fftw_plan_dft_r2c_1d((int)n, s->line, (fftw_complex *)s->hat, FFTW_ESTIMATE);
  s->backward = fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)s->hat, s->line, FFTW_ESTIMATE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpectralDestroy(Spectral *spectral) {
  Spectral s = *spectral;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  fftw_destroy_plan(s->forward);
  fftw_destroy_plan(s->backward);
  fftw_free(s->hat);
  fftw_free(s->line);
  PetscCall(PetscFree(*spectral));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void SpectralDerivative(Spectral s, int power, PetscReal scale, const PetscScalar X[], PetscScalar Y[]) {
  const PetscInt n = s->n;
  for (int c = 0; c < 2; c++) {
    for (PetscInt k = 0; k < n; k++) s->line[k] = X[2 * k + c];
    fftw_execute(s->forward);
    for (PetscInt q = 0; q <= n / 2; q++) {
      const PetscReal wave = 2 * PETSC_PI * q / n, re = s->hat[2 * q], im = s->hat[2 * q + 1];
      if (power == 1) {
        const PetscReal factor = 2 * q == n ? 0 : scale * wave / n;
        s->hat[2 * q] = -factor * im;
        s->hat[2 * q + 1] = factor * re;
      } else {
        const PetscReal factor = scale * (power == 2 ? -1 : PetscSqr(wave)) * PetscSqr(wave) / n;
        s->hat[2 * q] = factor * re;
        s->hat[2 * q + 1] = factor * im;
      }
    }
    fftw_execute(s->backward);
    for (PetscInt k = 0; k < n; k++) Y[2 * k + c] += s->line[k];
  }
}
