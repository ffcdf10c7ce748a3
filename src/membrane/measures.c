/* Measures of a vesicle (DESIGN section 9). */
#include "membrane/membrane.h"

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

/* The same moments of the spectral curve, by the trapezoidal rule on x dy - y dx and its like: spectrally accurate. */
static void SpectralMoments(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar e[],
                            const PetscReal about[2], PetscReal *area, PetscReal first[2], PetscReal second[3]) {
  *area = first[0] = first[1] = second[0] = second[1] = second[2] = 0;
  for (PetscInt k = 0; k < m->start[v + 1] - m->start[v]; k++) {
    const PetscReal *p = &X[2 * (m->start[v] + k)], x = p[0] - about[0], y = p[1] - about[1];
    const PetscReal dx = e[2 * k], dy = e[2 * k + 1];
    *area += 0.5 * (x * dy - y * dx);
    first[0] += 0.5 * x * x * dy;
    first[1] -= 0.5 * y * y * dx;
    second[0] += x * x * x * dy / 3;
    second[1] += 0.25 * (x * x * y * dy - x * y * y * dx);
    second[2] -= y * y * y * dx / 3;
  }
}

void MembraneMeasure(Membrane m, PetscInt v, const PetscScalar X[], Measures *out) {
  const PetscInt k0 = m->start[v], n = m->start[v + 1] - k0;
  PetscReal about[2] = {X[2 * k0], X[2 * k0 + 1]}, area = 0, first[2], second[3], shortest = PETSC_MAX_REAL,
            longest = 0;
  PetscScalar *e = m->work;
  MembraneEdges(m, v, X + 2 * k0, e);
  for (int pass = 0; pass < 2; pass++) { /* about a marker, then about the centroid */
    if (m->derivative == DERIVATIVE_SPECTRAL)
      SpectralMoments(m, v, X, e, about, &area, first, second);
    else
      PolygonMoments(m, v, X, about, &area, first, second);
    for (int c = 0; c < 2; c++) about[c] += pass ? 0 : first[c] / area;
  }
  out->area = area;
  for (int c = 0; c < 2; c++) out->center[c] = about[c];
  out->inclination = 0.5 * PetscAtan2Real(2 * second[1], second[0] - second[2]);
  if (out->inclination < -PETSC_PI / 2 + 1e-9)
    out->inclination += PETSC_PI; /* an upright axis must not flip by round-off */
  out->length = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal edge = PetscSqrtReal(PetscSqr(e[2 * k]) + PetscSqr(e[2 * k + 1]));
    out->length += edge;
    shortest = PetscMin(shortest, edge);
    longest = PetscMax(longest, edge);
  }
  out->edge_ratio = shortest > 0 ? longest / shortest : PETSC_MAX_REAL;
}

PetscErrorCode MembraneFrequency(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[], PetscReal *f) {
  const PetscInt first = m->start[v], n = m->start[v + 1] - first;
  PetscReal mean[2] = {0, 0}, *T, sum = 0;
  PetscInt positive = 0, negative = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &T));
  SpectralDerivative(m->spectral[v], 1, n / (2 * PETSC_PI), X + 2 * first, T);
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
