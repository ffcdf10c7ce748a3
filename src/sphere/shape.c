#include "sphere/shape.h"
#include "numerics/blas.h"

/* Reduced volume of a spheroid with half axes r along and 1 across. */
static PetscReal SpheroidReducedVolume(PetscReal r) {
  const PetscReal e = PetscSqrtReal(r > 1 ? 1 - 1 / (r * r) : 1 - r * r);
  const PetscReal cap = e < 1e-4 ? 1 : r > 1 ? r * PetscAsinReal(e) / e : r * r * PetscAtanhReal(e) / e;
  return 4 * r / PetscPowReal(1 + cap, 1.5) / PETSC_SQRT2;
}

void ShapeSpheroid(PetscReal v, PetscBool oblate, PetscReal R, PetscReal *along, PetscReal *across) {
  PetscReal low = oblate ? 1e-3 : 1, high = oblate ? 1 : 1e3;
  for (int k = 0; k < 200; k++) {
    const PetscReal r = 0.5 * (low + high);
    if ((SpheroidReducedVolume(r) > v) == oblate)
      high = r;
    else
      low = r;
  }
  *across = R / PetscCbrtReal(low);
  *along = *across * low;
}

PetscErrorCode ShapeCapsule(Sphere s, PetscReal v, PetscReal R, PetscReal c[]) {
  const SphereGrid *g = &s->fine.grid;
  PetscReal low = 1, high = 100, volume = 1, *X; /* length over breadth */
  Surface surface;
  PetscFunctionBeginUser;
  PetscCall(SurfaceCreate(s, &surface));
  PetscCall(PetscCalloc1(3 * g->n, &X));
  for (int pass = 0; pass < 60; pass++) {
    const PetscReal length = 0.5 * (low + high);
    for (PetscInt i = 0; i < g->n; i++) {
      const PetscReal x = PetscCosReal(g->theta[i]);
      X[i] = length * x;
      X[g->n + i] = PetscSinReal(g->theta[i]) * (1 + 0.5 * x * x);
    }
    PetscCall(SphereFieldProject(&s->fine, X, c));
    PetscCall(SurfacePlace(surface, c, PETSC_FALSE));
    volume = surface->volume;
    if (6 * PetscSqrtReal(PETSC_PI) * volume / PetscPowReal(surface->area, 1.5) > v)
      low = length;
    else
      high = length;
  }
  for (PetscInt k = 0; k < s->size; k++) c[k] *= R * PetscCbrtReal(4 * PETSC_PI / (3 * volume));
  PetscCall(PetscFree(X));
  PetscCall(SurfaceDestroy(&surface));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ShapeAlign(PetscInt count, const PetscReal axis[3], const PetscReal center[3], PetscReal c[]) {
  const PetscReal length = PetscSqrtReal(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  PetscReal h[3] = {1 + axis[0] / length, axis[1] / length, axis[2] / length},
            h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
  if (h2 < 1e-12) h[1] = h2 = 1;         /* along -x: half a turn about y */
  for (PetscInt k = 0; k < count; k++) { /* half a turn about the middle h of x and the axis */
    PetscReal x[3] = {c[k], c[count + k], c[2 * count + k]};
    const PetscReal s = 2 * (h[0] * x[0] + h[1] * x[1] + h[2] * x[2]) / h2;
    for (int d = 0; d < 3; d++) c[d * count + k] = s * h[d] - x[d];
  }
  for (int d = 0; d < 3 && center; d++) c[d * count] += PetscSqrtReal(4 * PETSC_PI) * center[d];
}

PetscErrorCode ShapeMeasure(Surface s, ShapeMoments *m) {
  const PetscInt n = s->n;
  PetscReal second[9] = {0}, l[3];
  PetscFunctionBeginUser;
  (void)PetscArrayzero(m->center, 3);
  const PetscBool revolved = (PetscBool)(s->sphere->symmetry == SPHERE_REVOLVED);
  for (int pass = 0; pass < 2; pass++)
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal dA = s->sphere->fine.grid.weight[i] * s->J[i];
      PetscReal r[3], rn = 0;
      for (int d = 0; d < 3; d++) {
        r[d] = s->D[HARMONIC][d * n + i] - (pass ? m->center[d] : 0);
        rn += r[d] * s->normal[d * n + i];
      }
      for (int d = 0; d < 3; d++) {
        if (!pass && (d == 0 || !revolved)) m->center[d] += dA * rn * r[d] / (4 * s->volume);
        for (int e = 0; e < 3 && pass; e++) second[3 * d + e] += dA * rn * r[d] * r[e] / 5;
      }
    }
  if (revolved) { /* of all turns of the meridian, on which z = 0 */
    second[1] = second[3] = 0;
    second[4] = second[8] = second[4] / 2;
  }
  PetscCall(DenseEigen(3, second, l));
  for (int j = 0; j < 3; j++) {
    m->axis[j] = PetscSqrtReal(5 * l[j] / s->volume);
    PetscCall(PetscArraycpy(m->direction[j], second + 3 * j, 3));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ShapeTail(Sphere sphere, const PetscReal c[]) {
  PetscReal tail = 0, all = 0;
  for (PetscInt k = 0; k < sphere->size; k++) {
    const PetscInt l = sphere->degree[k];
    if (l > 0) all += c[k] * c[k];
    if (4 * l >= 3 * sphere->p) tail += c[k] * c[k];
  }
  return PetscSqrtReal(tail / all);
}

#define FIT_PASSES 5  /* each with the moments of the surface before */
#define FIT_RANK 1e-6 /* over the largest singular value: smaller ones are those of directions without points */

/* Angles [n] of the points in the sphere that the ellipsoid of these moments is mapped to. */
static void FitDirections(const ShapeMoments *m, PetscInt n, const PetscReal x[], PetscReal theta[], PetscReal phi[]) {
  for (PetscInt i = 0; i < n; i++) {
    PetscReal w[3] = {0};
    for (int j = 0; j < 3; j++) {
      const PetscReal *axis = m->direction[j];
      PetscReal along = 0;
      for (int d = 0; d < 3; d++) along += axis[d] * (x[3 * i + d] - m->center[d]) / m->axis[j];
      for (int d = 0; d < 3; d++) w[d] += along * axis[d];
    }
    theta[i] = PetscAtan2Real(PetscHypotReal(w[0], w[1]), w[2]);
    phi[i] = PetscAtan2Real(w[1], w[0]);
  }
}

PetscErrorCode ShapeFit(Sphere sphere, PetscInt n, const PetscReal x[], PetscReal c[], PetscReal *spread,
                        PetscReal *off) {
  ShapeMoments m = {.axis = {1, 1, 1}, .direction = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const PetscInt count = sphere->count;
  PetscReal *theta, *phi, *Y, *b, *singular, square = 0;
  Surface at;
  PetscFunctionBeginUser;
  PetscCall(SurfaceCreate(sphere, &at));
  PetscCall(PetscMalloc5(n, &theta, n, &phi, count * n, &Y, 3 * n, &b, count, &singular));
  for (PetscInt i = 0; i < 3 * n; i++) m.center[i % 3] += x[i] / (PetscReal)n;
  for (int pass = 0; pass < FIT_PASSES; pass++) {
    FitDirections(&m, n, x, theta, phi);
    PetscCall(HarmonicsAt(sphere->p, sphere->p, n, theta, phi, 1, Y));
    for (PetscInt i = 0; i < 3 * n; i++) b[i % 3 * n + i / 3] = x[i];
    PetscCall(DenseLeastSquares(n, count, Y, 3, b, FIT_RANK, singular));
    *spread = singular[count - 1] / singular[0];
    for (int d = 0; d < 3; d++) PetscCall(PetscArraycpy(c + d * count, b + d * n, count));
    PetscCall(SurfacePlace(at, c, PETSC_FALSE));
    if (*spread < FIT_RANK || !ShapeIsStar(at, m.center)) break; /* no surface whose moments mean something */
    PetscCall(ShapeMeasure(at, &m));
  }
  for (PetscInt k = 0; k < 3 * n; k++) square += k % n < count ? 0 : PetscSqr(b[k]); /* what is left of the points */
  *off = PetscSqrtReal(square / (PetscReal)n);
  PetscCall(PetscFree5(theta, phi, Y, b, singular));
  PetscCall(SurfaceDestroy(&at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool ShapeIsStar(Surface s, const PetscReal center[3]) {
  const PetscInt n = s->n;
  for (PetscInt i = 0; i < n; i++) {
    PetscReal outward = 0;
    for (int d = 0; d < 3; d++) outward += (s->D[HARMONIC][d * n + i] - center[d]) * s->normal[d * n + i];
    if (!(outward > 0)) return PETSC_FALSE; /* or not a number, where the surface has no normal */
  }
  return PETSC_TRUE;
}
