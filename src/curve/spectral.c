#include "curve/spectral.h"
#include <fftw3.h>

struct _p_Spectral {
  PetscInt n;
  fftw_complex *line, *hat; /* x + i y of the points, and its modes */
  fftw_plan forward, backward;
};

PetscErrorCode SpectralCreate(PetscInt n, Spectral *out) {
  Spectral s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->n = n;
  s->hat = fftw_alloc_complex((size_t)n);
  s->line = fftw_alloc_complex((size_t)n);
  s->forward = fftw_plan_dft_1d((int)n, s->line, s->hat, FFTW_FORWARD, FFTW_ESTIMATE);
  s->backward = fftw_plan_dft_1d((int)n, s->hat, s->line, FFTW_BACKWARD, FFTW_ESTIMATE);
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

/* Both coordinates at once: x + i y is an array of complex numbers as it is, and a derivative is linear. */
void SpectralDerivative(Spectral s, int power, PetscReal scale, const PetscScalar X[], PetscScalar Y[]) {
  const PetscInt n = s->n;
  double *line = (double *)s->line, *hat = (double *)s->hat;
  memcpy(line, X, 2 * (size_t)n * sizeof(double));
  fftw_execute(s->forward);
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal wave = 2 * PETSC_PI * (2 * q > n ? q - n : q) / n, re = hat[2 * q], im = hat[2 * q + 1];
    if (power == 1) {
      const PetscReal factor = 2 * q == n ? 0 : scale * wave / n;
      hat[2 * q] = -factor * im;
      hat[2 * q + 1] = factor * re;
    } else {
      const PetscReal factor = scale * (power == 2 ? -1 : PetscSqr(wave)) * PetscSqr(wave) / n;
      hat[2 * q] = factor * re;
      hat[2 * q + 1] = factor * im;
    }
  }
  fftw_execute(s->backward);
  for (PetscInt k = 0; k < 2 * n; k++) Y[k] += line[k];
}

PetscReal SpectralTail(Spectral s, PetscReal part, const PetscScalar X[]) {
  const PetscInt n = s->n;
  const double *hat = (double *)s->hat;
  PetscReal all = 0, tail = 0;
  memcpy(s->line, X, 2 * (size_t)n * sizeof(double));
  fftw_execute(s->forward);
  for (PetscInt q = 1; q < n; q++) {
    const PetscInt m = PetscMin(q, n - q);
    const PetscReal bending = PetscSqr((PetscReal)m * m) * (PetscSqr(hat[2 * q]) + PetscSqr(hat[2 * q + 1]));
    all += bending;
    if (2 * m > part * (n - 1)) tail += bending;
  }
  return all > 0 ? PetscSqrtReal(tail / all) : 0;
}

PetscReal TrigonometricCardinal(PetscInt n, PetscReal t) {
  const PetscReal s = PetscSinReal(0.5 * t);
  if (PetscAbsReal(s) < 1e-14) return 1;
  return PetscSinReal(0.5 * n * t) / (n * (n % 2 ? s : PetscTanReal(0.5 * t)));
}

/* The points between the same two markers of every pair have the same weights. */
void TrigonometricPoints(PetscInt n, const PetscReal X[], PetscInt times, PetscReal Y[]) {
  for (PetscInt q = 0; q < 2 * n * times; q++) Y[q] = 0;
  for (PetscInt between = 0; between < times; between++)
    for (PetscInt off = 0; off < n; off++) {
      const PetscReal weight = TrigonometricCardinal(n, 2 * PETSC_PI * (between + times * off) / (n * times));
      PetscReal *y = Y + 2 * between;
      for (PetscInt p = 0; p < n; p++, y += 2 * times) {
        const PetscReal *x = X + 2 * (p < off ? p - off + n : p - off);
        y[0] += weight * x[0];
        y[1] += weight * x[1];
      }
    }
}

void SpectralShift(Spectral s, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]) {
  const PetscInt n = s->n;
  double *line = (double *)s->line, *hat = (double *)s->hat;
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) line[2 * k + c] = c < each ? X[each * k + c] : 0;
  fftw_execute(s->forward);
  for (PetscInt q = 0; q < n; q++) {
    const PetscReal angle = (PetscReal)(2 * q > n ? q - n : q) * phi, re = hat[2 * q], im = hat[2 * q + 1];
    const PetscReal a = PetscCosReal(angle) / n, b = 2 * q == n ? 0 : PetscSinReal(angle) / n;
    hat[2 * q] = a * re - b * im;
    hat[2 * q + 1] = a * im + b * re;
  }
  fftw_execute(s->backward);
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < each; c++) Y[each * k + c] = line[2 * k + c];
}
