/* Measures of a vesicle (DESIGN section 9). */
#include "membrane/membrane.h"
#include <fftw3.h>

/* Area, first and second moments of the polygon about `about`, by Green's theorem over its edges. */
static void PolygonMoments(Membrane m, PetscInt v, const PetscScalar X[], const PetscReal about[2], PetscReal *area,
                           PetscReal first[2], PetscReal second[3]) {
  *area = first[0] = first[1] = second[0] = second[1] = second[2] = 0;
  for (PetscInt k = m->start[v]; k < m->start[v + 1]; k++) {
    const PetscInt n = m->next[k];
    const PetscReal x = X[2 * k] - about[0], y = X[2 * k + 1] - about[1];
    const PetscReal xn = X[2 * n] - about[0], yn = X[2 * n + 1] - about[1];
    const PetscReal cross = x * yn - xn * y;
    *area += cross / 2;
    first[0] += cross * (x + xn) / 6;
    first[1] += cross * (y + yn) / 6;
    second[0] += cross * (x * x + x * xn + xn * xn) / 12;
    second[1] += cross * (x * yn + 2 * x * y + 2 * xn * yn + xn * y) / 24;
    second[2] += cross * (y * y + y * yn + yn * yn) / 12;
  }
}

void MembraneMeasure(Membrane m, PetscInt v, const PetscScalar X[], Measures *out) {
  const PetscInt k0 = m->start[v];
  const PetscReal origin[2] = {X[2 * k0], X[2 * k0 + 1]};
  PetscReal area, first[2], second[3], shortest = PETSC_MAX_REAL, longest = 0;
  PolygonMoments(m, v, X, origin, &area, first, second);
  out->area = area;
  for (int c = 0; c < 2; c++) out->center[c] = origin[c] + first[c] / area;
  PolygonMoments(m, v, X, out->center, &area, first, second);
  out->inclination = 0.5 * PetscAtan2Real(2 * second[1], second[0] - second[2]);
  if (out->inclination < -PETSC_PI / 2 + 1e-9)
    out->inclination += PETSC_PI; /* an upright axis must not flip by round-off */
  out->length = 0;
  for (PetscInt k = k0; k < m->start[v + 1]; k++) {
    const PetscInt p = m->previous[k];
    const PetscReal e = PetscSqrtReal(PetscSqr(X[2 * k] - X[2 * p]) + PetscSqr(X[2 * k + 1] - X[2 * p + 1]));
    out->length += e;
    shortest = PetscMin(shortest, e);
    longest = PetscMax(longest, e);
  }
  out->edge_ratio = shortest > 0 ? longest / shortest : PETSC_MAX_REAL;
}

/* Spectral derivative of X with respect to the marker index times M/(2 pi); T[2n]. The Nyquist mode is dropped. */
static PetscErrorCode SpectralDerivative(PetscInt n, const PetscScalar X[], PetscReal T[]) {
  double *line, *hat; /* hat: real and imaginary parts in turn */
  fftw_plan forward, backward;
  PetscFunctionBeginUser;
  hat = fftw_alloc_real(2 * (size_t)(n / 2 + 1));
  line = fftw_alloc_real((size_t)n);
  forward = fftw_plan_dft_r2c_1d((int)n, line, (fftw_complex *)hat, FFTW_ESTIMATE);
  backward = fftw_plan_dft_c2r_1d((int)n, (fftw_complex *)hat, line, FFTW_ESTIMATE);
  for (int c = 0; c < 2; c++) {
    for (PetscInt k = 0; k < n; k++) line[k] = X[2 * k + c];
    fftw_execute(forward);
    for (PetscInt q = 0; q <= n / 2; q++) {
      const double factor = 2 * q == n ? 0 : (double)q / n, re = hat[2 * q];
      hat[2 * q] = -factor * hat[2 * q + 1];
      hat[2 * q + 1] = factor * re;
    }
    fftw_execute(backward);
    for (PetscInt k = 0; k < n; k++) T[2 * k + c] = line[k];
  }
  fftw_destroy_plan(forward);
  fftw_destroy_plan(backward);
  fftw_free(hat);
  fftw_free(line);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MembraneFrequency(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal *f) {
  const PetscInt first = m->start[v], n = m->start[v + 1] - first;
  PetscReal mean[2] = {0, 0}, *T, sum = 0;
  PetscInt positive = 0, negative = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &T));
  PetscCall(SpectralDerivative(n, X + 2 * first, T));
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) mean[c] += U[2 * (first + k) + c] / n;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal speed = PetscSqrtReal(PetscSqr(T[2 * k]) + PetscSqr(T[2 * k + 1]));
    const PetscReal tangential = ((U[2 * (first + k)] - mean[0]) * T[2 * k] +
                                  (U[2 * (first + k) + 1] - mean[1]) * T[2 * k + 1]) /
                                 speed;
    positive += tangential > 0;
    negative += tangential < 0;
    sum += speed / tangential; /* dl = speed 2 pi/n a marker */
  }
  *f = positive == n || negative == n ? n / PetscAbsReal(sum) : NAN;
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal MembraneNormalSpeed(Membrane m, const PetscScalar X[], const PetscScalar U[]) {
  PetscReal largest = 0;
  for (PetscInt k = 0; k < m->M; k++) {
    const PetscInt p = m->previous[k], n = m->next[k];
    const PetscReal tx = X[2 * n] - X[2 * p], ty = X[2 * n + 1] - X[2 * p + 1];
    const PetscReal speed = PetscAbsReal(ty * U[2 * k] - tx * U[2 * k + 1]) / PetscSqrtReal(tx * tx + ty * ty);
    largest = PetscMax(largest, speed);
  }
  return largest;
}
