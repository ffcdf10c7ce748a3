#include "curve/spectral.h"
#include "base/lanes.h"
#include <fftw3.h>

#define CONVOLVED 128        /* most markers whose sums take less time than transforms */
#define CONVOLVED_ROUGH 1024 /* with a prime factor above 13, for which a transform takes many times longer */
#define TURNS 3              /* a step turns the states before it by as many different angles */
#define ROUND CONVOLVE_ROUND

struct _p_Spectral {
  PetscInt n;
  fftw_complex *line, *hat; /* x + i y of the points, and its modes */
  fftw_plan forward, backward;
  PetscReal *derivative[3], *turn[TURNS], phi[TURNS]; /* weights [n], where sums are taken, else NULL; of which phi */
  PetscReal *twice, *sum;                             /* rooms of the sums */
  int next;                                           /* turn to be replaced */
};

static PetscBool IsConvolved(PetscInt n) {
  PetscInt rest = n;
  for (PetscInt prime = 2; prime <= 13; prime++)
    while (rest % prime == 0) rest /= prime;
  return n <= (rest > 1 ? CONVOLVED_ROUGH : CONVOLVED) ? PETSC_TRUE : PETSC_FALSE;
}

/* Both coordinates at once: x + i y is an array of complex numbers as it is, and a derivative is linear. */
static void Transformed(Spectral s, int power, PetscReal scale, const PetscScalar X[], PetscScalar Y[]) {
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

/* What a 1 at marker 0 has at marker q; the first derivative of it is odd, the others are even. */
static PetscErrorCode DerivativeWeights(Spectral s) {
  const PetscInt n = s->n;
  PetscReal *one, *found;
  PetscFunctionBeginUser;
  for (int p = 0; p < 3; p++) {
    PetscCall(PetscCalloc2(2 * n, &one, 2 * n, &found));
    one[0] = 1;
    Transformed(s, 1 << p, 1, one, found);
    for (PetscInt q = 0; q < n; q++)
      s->derivative[p][q] = 0.5 * (found[2 * q] + (p ? 1 : -1) * found[2 * ((n - q) % n)]);
    PetscCall(PetscFree2(one, found));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
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
  if (!IsConvolved(n)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(4 * n + ROUND, &s->twice, 2 * n + ROUND, &s->sum));
  for (int p = 0; p < 3; p++) PetscCall(PetscMalloc1(n, &s->derivative[p]));
  for (int t = 0; t < TURNS; t++) {
    PetscCall(PetscMalloc1(n, &s->turn[t]));
    s->phi[t] = NAN;
  }
  PetscCall(DerivativeWeights(s));
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
  for (int t = 0; t < TURNS; t++) PetscCall(PetscFree(s->turn[t]));
  PetscCall(PetscFree2(s->twice, s->sum));
  PetscCall(PetscFree(*spectral));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ConvolveRound(PetscInt n, int each, PetscBool ahead, const PetscReal weight[], const PetscReal twice[],
                   PetscReal sum[]) {
  const PetscInt width = each * n, step = ahead ? each : -each;
  for (PetscInt i = 0; i < width; i += ROUND) {
    const PetscReal *x = twice + (ahead ? 0 : width) + i;
    Lanes part[ROUND / LANES] = {{0}};
    for (PetscInt q = 0; q < n; q++, x += step)
      for (int r = 0; r < ROUND / LANES; r++) part[r] += weight[q] * LanesAt(x + LANES * r);
    for (int r = 0; r < ROUND / LANES; r++) LanesPut(part[r], sum + i + LANES * r);
  }
}

/* sum_k = SUM_q weight_q (X_{k-q} - X_0), with markers counted round the curve. */
static void Convolve(Spectral s, int each, const PetscReal weight[], const PetscScalar X[]) {
  const PetscInt width = each * s->n;
  for (PetscInt i = 0; i < width; i++) s->twice[i] = s->twice[width + i] = X[i] - X[i % each];
  ConvolveRound(s->n, each, PETSC_FALSE, weight, s->twice, s->sum);
}

void SpectralDerivative(Spectral s, int power, PetscReal scale, const PetscScalar X[], PetscScalar Y[]) {
  if (!s->sum) {
    Transformed(s, power, scale, X, Y);
    return;
  }
  Convolve(s, 2, s->derivative[power / 2], X);
  for (PetscInt k = 0; k < 2 * s->n; k++) Y[k] += scale * s->sum[k];
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

static void ShiftTransformed(Spectral s, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]) {
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

/* The trigonometric cardinal function at phi and the markers' labels before it. With phi = d + 2 pi m/n, d at most half
   a label, that at d + 2 pi j/n is sin(n d/2) (-1)^j/(n sin(d/2 + pi j/n)), for even n by the tangent: no small
   differences. */
static const PetscReal *TurnWeights(Spectral s, PetscReal phi) {
  const PetscReal labels = PetscFloorReal(phi * s->n / (2 * PETSC_PI) + 0.5);
  const PetscInt n = s->n, m = PetscAbsReal(labels) < 1e9 ? (PetscInt)labels : 0;
  const PetscReal half = 0.5 * phi - PETSC_PI * m / n, top = PetscSinReal(n * half) / n;
  PetscReal *weight = s->turn[s->next];
  for (int t = 0; t < TURNS; t++)
    if (s->phi[t] == phi) return s->turn[t];
  s->phi[s->next] = phi;
  s->next = (s->next + 1) % TURNS;
  for (PetscInt j = (1 - n) / 2; j <= n / 2; j++) {
    const PetscReal at = half + PETSC_PI * j / n, value = top / (n % 2 ? PetscSinReal(at) : PetscTanReal(at));
    const PetscInt q = (((j - m) % n) + n) % n;
    weight[q] = !j && half == 0 ? 1 : (j % 2 ? -value : value);
  }
  return weight;
}

void SpectralShift(Spectral s, int each, PetscReal phi, const PetscScalar X[], PetscScalar Y[]) {
  if (!s->sum) {
    ShiftTransformed(s, each, phi, X, Y);
    return;
  }
  Convolve(s, each, TurnWeights(s, phi), X);
  const PetscReal first[2] = {X[0], X[each - 1]};
  for (PetscInt i = 0; i < each * s->n; i++) Y[i] = first[i % each] + s->sum[i];
}
