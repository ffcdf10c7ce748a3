#include "numerics/spectral.h"
#include "numerics/circulant.h"
#include <complex.h>
#include <fftw3.h>

#define SLOPES 4 /* parts of the slopes: of the powers 1 and 2, at the points and halfway */

struct _p_Spectral {
  PetscInt n;
  fftw_complex *line, *hat; /* x + i y of the points, and its modes */
  fftw_plan forward, backward;
  fftw_complex *modes;      /* [n] work: modes */
  fftw_complex *factor;     /* [SLOPES][n] of the modes, over n */
  PetscReal *derivative[3]; /* weights [n] of powers 1, 2, 4 */
  PetscReal *turn;          /* work: weights [n] of a shift */
  PetscReal *round;         /* cos and sin of pi j/n, j = 0 .. n/2, interlaced */
  PetscReal *twice, *sum;   /* work arrays of the sums */
};

/* Set the weights of the derivatives, which are those of the trigonometric cardinal function,

     SUM_m (2 pi i m/n)^power e^{2 pi i m q/n}/n,   |m| <= n/2,

   without the Nyquist mode of an even n where the power is odd. They are odd for the first derivative and else even. */
static void SpectralSetWeights(Spectral s) {
  const PetscInt n = s->n;
  for (int p = 0; p < 3; p++)
    for (PetscInt q = 0; 2 * q <= n; q++) {
      PetscReal sum = 0;
      for (PetscInt m = 1; 2 * m <= n; m++) {
        const PetscReal wave = 2 * PETSC_PI * m / n, angle = 2 * PETSC_PI * (m * q % n) / n;
        const PetscReal both = 2 * m < n ? 2 : p ? 1 : 0; /* modes m and -m */
        if (p)
          sum += both * (p == 1 ? -1 : PetscSqr(wave)) * PetscSqr(wave) * PetscCosReal(angle);
        else
          sum -= both * wave * PetscSinReal(angle);
      }
      s->derivative[p][(n - q) % n] = (p ? sum : -sum) / n;
      s->derivative[p][q] = sum / n;
    }
}

/* Set the factors of the slopes, (2 pi i m/n)^power e^{pi i m/n} halfway; there the Nyquist mode of an even n is 0. */
static void SpectralSetFactors(Spectral s) {
  const PetscInt n = s->n;
  for (int part = 0; part < SLOPES; part++)
    for (PetscInt q = 0; q < n; q++) {
      const PetscReal wave = 2 * PETSC_PI * (2 * q <= n ? q : q - n) / n;
      const fftw_complex slope = part < 2 ? I * wave : -wave * wave;
      s->factor[part * n + q] = 2 * q == n && part != 2 ? 0 : slope * cexp(I * (part % 2 * wave / 2)) / n;
    }
}

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
  PetscCall(PetscCalloc5(4 * n, &s->twice, 2 * n, &s->sum, n + 2, &s->round, n, &s->modes, SLOPES * n, &s->factor));
  for (PetscInt j = 0; j <= n / 2; j++) {
    s->round[2 * j] = PetscCosReal(PETSC_PI * j / n);
    s->round[2 * j + 1] = PetscSinReal(PETSC_PI * j / n);
  }
  PetscCall(PetscMalloc1(n, &s->turn));
  for (int p = 0; p < 3; p++) PetscCall(PetscMalloc1(n, &s->derivative[p]));
  SpectralSetWeights(s);
  SpectralSetFactors(s);
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
  for (int p = 0; p < 3; p++) PetscCall(PetscFree(s->derivative[p]));
  PetscCall(PetscFree(s->turn));
  PetscCall(PetscFree5(s->twice, s->sum, s->round, s->modes, s->factor));
  PetscCall(PetscFree(*spectral));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The points X less the first one, and after them the same numbers again, for a sum around the curve. */
static void SpectralRepeat(Spectral s, int each, const PetscScalar X[]) {
  const PetscInt n = each * s->n;
  for (int c = 0; c < each; c++)
    for (PetscInt k = c; k < n; k += each) s->twice[k] = s->twice[n + k] = X[k] - X[c];
}

void SpectralDerivative(Spectral s, int power, PetscReal scale, const PetscScalar X[], PetscScalar Y[]) {
  SpectralRepeat(s, 2, X);
  CirculantConvolve(s->n, 2, PETSC_FALSE, s->derivative[power / 2], s->twice, s->sum);
  for (PetscInt k = 0; k < 2 * s->n; k++) Y[k] += scale * s->sum[k];
}

void SpectralSlopes(Spectral s, const PetscReal scale[2], const PetscScalar X[], PetscReal slope[]) {
  const PetscInt n = s->n;
  const size_t bytes = (size_t)n * sizeof(*s->line);
  memcpy(s->line, X, bytes);
  fftw_execute(s->forward);
  memcpy(s->modes, s->hat, bytes);
  for (int part = 0; part < SLOPES; part++) {
    for (PetscInt q = 0; q < n; q++) s->hat[q] = scale[part / 2] * s->factor[part * n + q] * s->modes[q];
    fftw_execute(s->backward);
    memcpy(slope + part * 2 * n, s->line, bytes);
  }
}

void SpectralSlopesTranspose(Spectral s, const PetscReal scale[2], const PetscReal slope[], PetscScalar Y[]) {
  const PetscInt n = s->n;
  const size_t bytes = (size_t)n * sizeof(*s->line);
  const PetscReal *line = (PetscReal *)s->line;
  memset(s->modes, 0, bytes);
  for (int part = 0; part < SLOPES; part++) {
    memcpy(s->line, slope + part * 2 * n, bytes);
    fftw_execute(s->forward);
    for (PetscInt q = 0; q < n; q++) s->modes[q] += scale[part / 2] * conj(s->factor[part * n + q]) * s->hat[q];
  }
  memcpy(s->hat, s->modes, bytes);
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

/* A point at the same place between every two markers has the same weights. */
void TrigonometricPoints(PetscInt n, const PetscReal X[], PetscInt times, PetscReal Y[]) {
  for (PetscInt q = 0; q < 2 * n * times; q++) Y[q] = 0;
  for (PetscInt between = 0; between < times; between++)
    for (PetscInt off = 0; off < n; off++) {
      const PetscReal weight = TrigonometricCardinal(n, 2 * PETSC_PI * (between + times * off) / (n * times));
      PetscReal *y = Y + 2 * between;
      for (PetscInt p = 0; p < n; p++, y += 2 * times) {
        const PetscReal *x = X + 2 * (p < off ? p - off + n : p - off);
        for (int c = 0; c < 2; c++) y[c] += weight * x[c];
      }
    }
}

/* Weights of the shift by phi = d + 2 pi m/n, |d| at most pi/n: the values at d + 2 pi j/n of the trigonometric
   cardinal function,

     (-1)^j sin(n d/2)/(n sin(d/2 + pi j/n)),

   for even n with the tangent in the denominator. No difference of nearly equal numbers is taken. */
static const PetscReal *SpectralShiftWeights(Spectral s, PetscReal phi) {
  const PetscReal labels = PetscFloorReal(phi * s->n / (2 * PETSC_PI) + 0.5);
  const PetscInt n = s->n, m = PetscAbsReal(labels) < 1e9 ? (PetscInt)labels : 0;
  const PetscReal half = 0.5 * phi - PETSC_PI * m / n, top = PetscSinReal(n * half) / n;
  const PetscReal sine = PetscSinReal(half), cosine = PetscCosReal(half);
  PetscReal *weight = s->turn;
  PetscInt q = ((((1 - n) / 2 - m) % n) + n) % n;
  for (PetscInt j = (1 - n) / 2; j <= n / 2; j++, q = q + 1 < n ? q + 1 : 0) {
    const PetscReal a = s->round[2 * PetscAbsInt(j)], b = j < 0 ? -s->round[2 * -j + 1] : s->round[2 * j + 1];
    const PetscReal bottom = n % 2 ? sine * a + cosine * b : (sine * a + cosine * b) / (cosine * a - sine * b);
    weight[q] = !j && half == 0 ? 1 : (j % 2 ? -top : top) / bottom;
  }
  return weight;
}

void SpectralShift(Spectral s, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]) {
  const PetscReal first[2] = {X[0], X[1]};
  SpectralRepeat(s, each, X);
  CirculantConvolve(s->n, each, PETSC_FALSE, SpectralShiftWeights(s, phi), s->twice, s->sum);
  for (int c = 0; c < each; c++)
    for (PetscInt k = c; k < each * s->n; k += each) Y[k] = first[c] + s->sum[k];
}
