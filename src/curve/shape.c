/* Curves as markers, the red cell's outline, and the centroid of a curve. */
#include "curve/curve.h"

PetscErrorCode ShapeCreate(PetscInt n, const PetscInt markers[], const CurveKind kind[], Shape *shape) {
  PetscFunctionBeginUser;
  shape->vesicles = n;
  PetscCall(PetscCalloc1(n + 1, &shape->start));
  for (PetscInt v = 0; v < n; v++) shape->start[v + 1] = shape->start[v] + markers[v];
  PetscCall(PetscMalloc1(2 * shape->start[n], &shape->X));
  if (!kind) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &shape->kind));
  PetscCall(PetscArraycpy(shape->kind, kind, n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ShapeDestroy(Shape *shape) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(shape->start));
  PetscCall(PetscFree(shape->X));
  PetscCall(PetscFree(shape->kind));
  shape->vesicles = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ShapeRadius(const Shape *shape, PetscInt v) {
  const PetscInt first = shape->start[v], n = shape->start[v + 1] - first;
  PetscReal length = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *a = shape->X + 2 * (first + k), *b = shape->X + 2 * (first + (k + 1) % n);
    length += PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
  }
  return length / (2 * PETSC_PI);
}

void CurvesReverse(PetscInt curves, const PetscInt start[], const PetscBool marked[], PetscReal X[]) {
  for (PetscInt v = 0; v < curves; v++)
    for (PetscInt k = start[v], j = start[v + 1] - 1; k < j && marked[v]; k++, j--)
      for (int c = 0; c < 2; c++) {
        const PetscReal low = X[2 * k + c];
        X[2 * k + c] = X[2 * j + c];
        X[2 * j + c] = low;
      }
}

void ShapeMiddle(const Shape *shape, PetscInt v, PetscReal X[2]) {
  const PetscInt first = shape->start[v], n = shape->start[v + 1] - first;
  X[0] = X[1] = 0;
  for (PetscInt k = 0; k < 2 * n; k++) X[k % 2] += shape->X[2 * first + k] / (PetscReal)n;
}

/* By the number of edges that a ray crosses from the image of the point that is nearest to the curve's middle. */
PetscBool ShapeHolds(const Shape *shape, PetscInt v, const PetscReal point[2], const PetscReal period[2]) {
  const PetscInt M = shape->start[v + 1] - shape->start[v];
  const PetscReal *X = shape->X + 2 * shape->start[v];
  PetscReal box[4] = CURVE_NOWHERE, at[2];
  PetscBool inside = PETSC_FALSE;
  if (shape->kind && shape->kind[v].type == CURVE_SPANNING) return PETSC_FALSE;
  CurveBounds(M, X, box);
  for (int d = 0; d < 2; d++) {
    const PetscReal off = point[d] - 0.5 * (box[2 * d] + box[2 * d + 1]);
    at[d] = period[d] > 0 ? point[d] - period[d] * PetscFloorReal(off / period[d] + 0.5) : point[d];
    if (at[d] < box[2 * d] || at[d] > box[2 * d + 1]) return PETSC_FALSE;
  }
  for (PetscInt k = 0, p = M - 1; k < M; p = k++)
    if ((X[2 * k + 1] > at[1]) != (X[2 * p + 1] > at[1]) &&
        at[0] < (X[2 * p] - X[2 * k]) * (at[1] - X[2 * k + 1]) / (X[2 * p + 1] - X[2 * k + 1]) + X[2 * k])
      inside = !inside;
  return inside;
}

#define OUTLINE_POINTS 1024 /* of an outline: the error of its spline is 1e-9 */
#define OUTLINE_HALVINGS 60

/* The outline X and dX/dt at parameter t (E. Evans and Y. C. Fung, Microvascular Research 4 (1972) 335, with mid =
   0.207):

     x = cos t,   y = (sin t)/2 (mid + C2 cos^2 t + C4 cos^4 t). */
#define C2 2.003
#define C4 -1.123
static void RedCellOutline(PetscReal mid, PetscReal t, PetscReal X[2], PetscReal slope[2]) {
  const PetscReal c = PetscCosReal(t), s = PetscSinReal(t), q = c * c, f = mid + C2 * q + C4 * q * q;
  X[0] = c;
  X[1] = 0.5 * s * f;
  slope[0] = -s;
  slope[1] = 0.5 * (c * f - 2 * s * s * c * (C2 + 2 * C4 * q));
}

/* Area and reduced area 4 pi area/length^2 of the outline, by sums over equal steps, to rounding. */
static void RedCellMeasure(PetscReal mid, PetscReal *area, PetscReal *reduced) {
  const PetscReal dt = 2 * PETSC_PI / OUTLINE_POINTS;
  PetscReal length = 0, X[2], slope[2];
  *area = 0;
  for (PetscInt k = 0; k < OUTLINE_POINTS; k++) {
    RedCellOutline(mid, dt * k, X, slope);
    length += dt * PetscHypotReal(slope[0], slope[1]);
    *area += dt * 0.5 * (X[0] * slope[1] - X[1] * slope[0]);
  }
  *reduced = 4 * PETSC_PI * *area / PetscSqr(length);
}

PetscErrorCode BiconcaveCurve(PetscReal area, PetscReal reduced_area, Curve *curve) {
  PetscReal low = 0.01, high = 1.6, xy[2 * OUTLINE_POINTS], unit = 1, reduced; /* reduced areas 0.32 and 0.91 */
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < OUTLINE_HALVINGS; k++) { /* the reduced area grows with mid */
    RedCellMeasure((low + high) / 2, &unit, &reduced);
    *(reduced < reduced_area ? &low : &high) = (low + high) / 2;
  }
  for (PetscInt k = 0; k < OUTLINE_POINTS; k++) {
    PetscReal slope[2];
    RedCellOutline((low + high) / 2, 2 * PETSC_PI * k / OUTLINE_POINTS, xy + 2 * k, slope);
    for (int d = 0; d < 2; d++) xy[2 * k + d] *= PetscSqrtReal(area / unit);
  }
  PetscCall(CurveFromPoints(&(CurveKind){0}, OUTLINE_POINTS, xy, curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CurveCentroid(const Curve *curve, PetscReal centroid[2]) {
  PetscReal first[2], a[2], b[2], area = 0;
  CurveEvaluate(curve, 0, first);
  for (int d = 0; d < 2; d++) a[d] = centroid[d] = 0;
  for (PetscInt k = 1; k <= 4 * OUTLINE_POINTS; k++) { /* sum over triangles from the first point */
    CurveEvaluate(curve, k / (4. * OUTLINE_POINTS), b);
    for (int d = 0; d < 2; d++) b[d] -= first[d];
    const PetscReal twice = a[0] * b[1] - a[1] * b[0];
    area += twice;
    for (int d = 0; d < 2; d++) {
      centroid[d] += twice * (a[d] + b[d]) / 3;
      a[d] = b[d];
    }
  }
  for (int d = 0; d < 2; d++) centroid[d] = first[d] + centroid[d] / area;
}
