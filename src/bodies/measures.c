#include "bodies/membrane.h"
#include "base/lanes.h"

#define ROUNDING 1e-12 /* over the largest tangential speed: a smaller speed has no sign */

/* Area, first and second moments of the polygon about `about`, by Green's theorem over its edges. */
static void PolygonMoments(PetscInt markers, const PetscScalar X[], const PetscReal about[2], PetscReal *area,
                           PetscReal first[2], PetscReal second[3]) {
  *area = first[0] = first[1] = second[0] = second[1] = second[2] = 0;
  for (PetscInt k = 0; k < markers; k++) {
    const PetscInt n = k + 1 < markers ? k + 1 : 0;
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

/* Add four points to the integrals round the curve that give area, first and second moments by Green's theorem. */
static inline void MomentsAdd(Lanes x, Lanes y, Lanes dx, Lanes dy, Lanes sum[6]) {
  sum[0] += x * dy - y * dx;
  sum[1] += x * x * dy;
  sum[2] -= y * y * dx;
  sum[3] += x * x * x * dy;
  sum[4] += x * y * (x * dy - y * dx);
  sum[5] -= y * y * y * dx;
}

/* Area, first and second moments of the spectral curve about `about`, by the trapezoidal rule: spectrally accurate. */
static void SpectralMoments(PetscInt markers, const PetscScalar X[], const PetscScalar e[], const PetscReal about[2],
                            PetscReal *area, PetscReal first[2], PetscReal second[3]) {
  Lanes sum[6] = {{0}}, x, y, dx, dy;
  PetscInt k = 0;
  for (; k + LANES <= markers; k += LANES) {
    LanesPairs(X + 2 * k, &x, &y);
    LanesPairs(e + 2 * k, &dx, &dy);
    MomentsAdd(x - about[0], y - about[1], dx, dy, sum);
  }
  for (; k < markers; k++)
    MomentsAdd(X[2 * k] - about[0] - (Lanes){0}, X[2 * k + 1] - about[1] - (Lanes){0}, (Lanes){e[2 * k]},
               (Lanes){e[2 * k + 1]}, sum);
  *area = LanesSum(sum[0]) / 2;
  for (int c = 0; c < 2; c++) first[c] = LanesSum(sum[1 + c]) / 2;
  for (int c = 0; c < 3; c++) second[c] = LanesSum(sum[3 + c]) / (c == 1 ? 4 : 3);
}

void MembraneMeasure(Membrane m, PetscInt v, const PetscScalar X[], Measures *out) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal about[2] = {X[0], X[1]}, area = 0, first[2], second[3], shortest = PETSC_MAX_REAL, longest = 0;
  PetscScalar *e = m->work.measures;
  MembraneEdges(m, v, X, e);
  for (int pass = 0; pass < 2; pass++) { /* moments about a marker, then about the centroid */
    if (m->derivative == DERIVATIVE_SPECTRAL)
      SpectralMoments(n, X, e, about, &area, first, second);
    else
      PolygonMoments(n, X, about, &area, first, second);
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

PetscReal MembraneFrequency(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal mean[2] = {0, 0}, *T = m->work.measures, sum = 0, least = PETSC_MAX_REAL, most = -PETSC_MAX_REAL;
  (void)PetscArrayzero(T, 2 * n);
  SpectralDerivative(m->spectral[v], 1, n / (2 * PETSC_PI), X, T);
  for (PetscInt k = 0; k < n; k++)
    for (int c = 0; c < 2; c++) mean[c] += U[2 * k + c] / n;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal speed = PetscSqrtReal(PetscSqr(T[2 * k]) + PetscSqr(T[2 * k + 1]));
    const PetscReal tangential = ((U[2 * k] - mean[0]) * T[2 * k] + (U[2 * k + 1] - mean[1]) * T[2 * k + 1]) / speed;
    least = PetscMin(least, tangential);
    most = PetscMax(most, tangential);
    sum += speed / tangential; /* dl = 2 pi/n speed */
  }
  const PetscReal rounding = ROUNDING * PetscMax(most, -least);
  return least > rounding || most < -rounding ? n / PetscAbsReal(sum) : NAN;
}

PetscReal MembraneNormalSpeed(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal *T = m->work.measures, largest = 0;
  (void)PetscArrayzero(T, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, T);
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal across = T[2 * k + 1] * U[2 * k] - T[2 * k] * U[2 * k + 1];
    largest = PetscMax(largest, PetscAbsReal(across) / PetscHypotReal(T[2 * k], T[2 * k + 1]));
  }
  return largest;
}

void MembraneCentroidVelocity(Membrane m, PetscInt v, const PetscScalar X[], const PetscScalar U[],
                              PetscReal velocity[2]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *T = m->work.measures;
  Measures measures;
  MembraneMeasure(m, v, X, &measures);
  (void)PetscArrayzero(T, 2 * n);
  SpectralDerivative(m->spectral[v], 1, 1, X, T);
  velocity[0] = velocity[1] = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal across = U[2 * k] * T[2 * k + 1] - U[2 * k + 1] * T[2 * k];
    for (int c = 0; c < 2; c++) velocity[c] += (X[2 * k + c] - measures.center[c]) * across / measures.area;
  }
}
