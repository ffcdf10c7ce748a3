/* Curves: ellipses and cubic splines, and equal chords along them. */
#include "curve/curve.h"
#include <petscblaslapack.h>

#define CURVE_SAMPLES 4000 /* parts of a curve that integrals along it are summed over */

void CurveEvaluate(const Curve *c, PetscReal t, PetscReal X[2]) {
  const PetscReal all = t;
  if (c->kind.type == CURVE_OPEN)
    t = PetscMax(0, PetscMin(1, t));
  else
    t -= PetscFloorReal(t);
  if (!c->n) {
    X[0] = c->axes[0] * PetscCosReal(2 * PETSC_PI * t);
    X[1] = c->axes[1] * PetscSinReal(2 * PETSC_PI * t);
    return;
  }
  PetscInt lo = 0, hi = c->n;
  while (hi - lo > 1) {
    const PetscInt mid = (lo + hi) / 2;
    if (c->t[mid] <= t)
      lo = mid;
    else
      hi = mid;
  }
  const PetscReal d = c->t[hi] - c->t[lo], a = (c->t[hi] - t) / d, b = 1 - a;
  for (int k = 0; k < 2; k++) {
    X[k] = a * c->x[k][lo] + b * c->x[k][hi] +
           ((a * a * a - a) * c->m[k][lo] + (b * b * b - b) * c->m[k][hi]) * d * d / 6;
    if (c->kind.type == CURVE_SPANNING) X[k] += c->kind.span[k] * all;
  }
}

/* Perimeter of an ellipse to rounding, by the arithmetic-geometric mean M(a, b) (NIST Handbook of Mathematical
   Functions, 19.8.6):

     2 pi (a^2 - SUM 2^(n-1) c_n^2)/M(a, b),   c_0^2 = a^2 - b^2,   c_(n+1) = (a_n - b_n)/2. */
static PetscReal EllipsePerimeter(PetscReal x, PetscReal y) {
  PetscReal a = PetscMax(x, y), b = PetscMin(x, y), power = 0.5, sum = (a + b) * (a - b) / 2;
  const PetscReal square = a * a;
  while (a - b > 1e-9 * a) { /* every turn doubles the digits: after the next the error is below rounding */
    const PetscReal mean = (a + b) / 2, c = (a - b) / 2;
    b = PetscSqrtReal(a * b);
    a = mean;
    power *= 2;
    sum += power * c * c;
  }
  return 2 * PETSC_PI * (square - sum) / ((a + b) / 2);
}

/* Length of the curve from t = `from` to `to`, or the area between it and its first point there. Richardson
   extrapolation of sums over chords: error h^4 for a smooth curve. */
static PetscReal CurveIntegral(const Curve *c, PetscBool area, PetscReal from, PetscReal to) {
  PetscReal sum[2] = {0, 0};
  for (int level = 0; level < 2; level++) {
    const PetscInt n = CURVE_SAMPLES << level;
    PetscReal first[2], last[2], X[2];
    CurveEvaluate(c, from, first);
    CurveEvaluate(c, from, last);
    for (PetscInt i = 1; i <= n; i++) {
      CurveEvaluate(c, from + (to - from) * (PetscReal)i / n, X);
      sum[level] += area ? 0.5 * ((last[0] - first[0]) * (X[1] - first[1]) - (X[0] - first[0]) * (last[1] - first[1]))
                         : PetscSqrtReal(PetscSqr(X[0] - last[0]) + PetscSqr(X[1] - last[1]));
      last[0] = X[0];
      last[1] = X[1];
    }
  }
  return (4 * sum[1] - sum[0]) / 3;
}

PetscReal CurvePartLength(const Curve *c, PetscReal from, PetscReal to) {
  return CurveIntegral(c, PETSC_FALSE, from, to);
}

PetscReal CurveLength(const Curve *c) {
  return c->n ? CurvePartLength(c, 0, 1) : EllipsePerimeter(c->axes[0], c->axes[1]);
}

PetscReal CurveArea(const Curve *c) {
  return c->n ? CurveIntegral(c, PETSC_TRUE, 0, 1) : PETSC_PI * c->axes[0] * c->axes[1];
}

/* Arc lengths of n equal parts of the parameter between two: s[n + 1] up to the end of each part, middle[n] up to its
   middle. By Richardson extrapolation of chords and half chords, relative error h^4. */
static void CurveArcs(const Curve *c, const PetscReal between[2], PetscInt n, PetscReal s[], PetscReal middle[]) {
  const PetscReal from = between[0], all = between[1] - from;
  PetscReal a[2], b[2], m[2];
  CurveEvaluate(c, from, a);
  s[0] = 0;
  for (PetscInt i = 0; i < n; i++) {
    CurveEvaluate(c, from + all * ((i + 0.5) / n), m);
    CurveEvaluate(c, from + all * ((i + 1.) / n), b);
    const PetscReal first = PetscHypotReal(m[0] - a[0], m[1] - a[1]), second = PetscHypotReal(b[0] - m[0], b[1] - m[1]);
    const PetscReal whole = (4 * (first + second) - PetscHypotReal(b[0] - a[0], b[1] - a[1])) / 3;
    middle[i] = s[i] + whole * first / (first + second);
    s[i + 1] = s[i] + whole;
    for (int k = 0; k < 2; k++) a[k] = b[k];
  }
}

/* t[M]: parameters of M points between which all arcs are equal (CurveEqualEdges). */
static PetscErrorCode CurveArcSteps(const Curve *c, const PetscReal part[2], PetscInt M, PetscReal t[]) {
  const PetscReal all[2] = {0, 1}, *between = part ? part : all;
  const PetscInt arcs = part ? M - 1 : M, n = PetscMax(CURVE_SAMPLES, 20 * M);
  PetscReal *s, *middle;
  PetscInt i = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n + 1, &s, n, &middle));
  CurveArcs(c, between, n, s, middle);
  for (PetscInt k = 0; k < M; k++) {
    const PetscReal want = s[n] * k / arcs;
    while (i < n - 1 && s[i + 1] < want) i++;
    /* t(s) is the parabola through both ends and the middle of the part */
    const PetscReal x = (want - s[i]) / (s[i + 1] - s[i]), m = (middle[i] - s[i]) / (s[i + 1] - s[i]);
    const PetscReal bend = (0.5 - m) / (m * (m - 1));
    t[k] = between[0] + (between[1] - between[0]) * ((i + x + bend * x * (x - 1)) / n);
  }
  PetscCall(PetscFree2(s, middle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Move the parameters t[M + 1] of M chords from t[0] = 0 to t[M] = 1 until all chords are equal. */
static PetscErrorCode CurveChordSteps(const Curve *c, PetscInt M, PetscReal t[]) {
  PetscReal *s, *next, change = 1;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(M + 1, &s, M, &next));
  for (int it = 0; it < 500 && change >= 1e-15; it++) {
    PetscReal a[2], b[2];
    CurveEvaluate(c, 0, a);
    for (PetscInt k = 1; k <= M; k++) { /* s: lengths of chords up to t */
      CurveEvaluate(c, t[k], b);
      s[k] = s[k - 1] + PetscHypotReal(b[0] - a[0], b[1] - a[1]);
      PetscCall(PetscArraycpy(a, b, 2));
    }
    change = 0;
    for (PetscInt k = 1, i = 0; k < M; k++) { /* equal steps of the piecewise linear function s(t) */
      const PetscReal want = s[M] * k / M;
      while (i < M - 1 && s[i + 1] < want) i++;
      next[k] = t[i] + (t[i + 1] - t[i]) * (want - s[i]) / (s[i + 1] - s[i]);
      change = PetscMax(change, PetscAbsReal(next[k] - t[k]));
    }
    PetscCall(PetscArraycpy(t + 1, next + 1, M - 1));
  }
  PetscCall(PetscFree2(s, next));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveEqualEdges(const Curve *c, const PetscReal part[2], PetscBool chords, PetscInt M, PetscReal X[]) {
  PetscReal *t;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(M + 1, &t));
  PetscCall(CurveArcSteps(c, part, M, t));
  t[M] = 1;
  if (chords) PetscCall(CurveChordSteps(c, M, t));
  for (PetscInt k = 0; k < M; k++) CurveEvaluate(c, t[k], &X[2 * k]);
  PetscCall(PetscFree(t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EllipseAxes(PetscReal area, PetscReal reduced_area, PetscReal axes[2]) {
  /* Bisection: the reduced area rises with b/a from 0 to 1. The perimeter lies between 4 a and 2 pi a, which bounds
   * b/a. */
  PetscReal lo = 0.4 * reduced_area, hi = reduced_area;
  Curve c = {0};
  PetscFunctionBeginUser;
  for (int it = 0; it < 60; it++) {
    const PetscReal ratio = 0.5 * (lo + hi);
    c.axes[0] = 1;
    c.axes[1] = ratio;
    const PetscReal length = CurveLength(&c);
    if (4 * PETSC_PI * PETSC_PI * ratio / PetscSqr(length) < reduced_area)
      lo = ratio;
    else
      hi = ratio;
  }
  axes[0] = PetscSqrtReal(area / (PETSC_PI * hi));
  axes[1] = axes[0] * hi;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Second derivatives m_i of the cubic spline at its knots, with the parts h_i = t_{i+1} - t_i and the slopes s_i of the
   chords:

     h_{i-1}/6 m_{i-1} + (h_{i-1} + h_i)/3 m_i + h_i/6 m_{i+1} = s_i - s_{i-1},   i modulo n.

   The equations 1 .. n - 1 are solved for both coordinates with m_0 = 0, and for what m_0 = 1 adds; equation 0 gives
   m_0, which is zero where the curve is open. */
static PetscErrorCode CurveSplineSetUp(Curve *c) {
  const PetscBLASInt n = (PetscBLASInt)c->n, unknowns = n - 1, columns = 3;
  PetscReal *diag, *off, *y[3];
  PetscBLASInt info;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &diag, n, &off));
  PetscCall(PetscCalloc1(3 * n, &y[0]));
  for (int k = 1; k < 3; k++) y[k] = y[0] + k * n;
  for (PetscInt i = 0; i < n; i++) {
    const PetscInt p = (i + n - 1) % n;
    const PetscReal before = c->t[p + 1] - c->t[p], after = c->t[i + 1] - c->t[i];
    diag[i] = (before + after) / 3;
    off[i] = after / 6;
    for (int k = 0; k < 2; k++)
      y[k][i] = (c->x[k][i + 1] - c->x[k][i]) / after - (c->x[k][p + 1] - c->x[k][p]) / before;
  }
  y[2][1] = -off[0];
  y[2][n - 1] = -off[n - 1];
  PetscCallBLAS("LAPACKpttrf", LAPACKpttrf_(&unknowns, diag + 1, off + 1, &info));
  PetscCallBLAS("LAPACKpttrs", LAPACKpttrs_(&unknowns, &columns, diag + 1, off + 1, y[0] + 1, &n, &info));
  const PetscReal corner = diag[0] + off[0] * y[2][1] + off[n - 1] * y[2][n - 1];
  for (int k = 0; k < 2; k++) {
    const PetscReal first = (y[k][0] - off[0] * y[k][1] - off[n - 1] * y[k][n - 1]) / corner;
    c->m[k][0] = c->m[k][n] = c->kind.type == CURVE_OPEN ? 0 : first;
    for (PetscInt i = 1; i < n; i++) c->m[k][i] = y[k][i] + c->m[k][0] * y[2][i];
  }
  PetscCall(PetscFree2(diag, off));
  PetscCall(PetscFree(y[0]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveDestroy(Curve *c) {
  PetscFunctionBeginUser;
  if (c->n) PetscCall(PetscFree5(c->t, c->x[0], c->x[1], c->m[0], c->m[1]));
  c->n = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFromPoints(const CurveKind *kind, PetscInt points, const PetscReal xy[], Curve *c) {
  const PetscInt n = kind->type == CURVE_OPEN ? points - 1 : points;
  PetscReal length = 0;
  PetscFunctionBeginUser;
  c->n = n;
  c->kind = *kind;
  PetscCall(PetscMalloc5(n + 1, &c->t, n + 1, &c->x[0], n + 1, &c->x[1], n + 1, &c->m[0], n + 1, &c->m[1]));
  for (PetscInt i = 0; i <= n; i++) {
    const PetscInt k = i % points;
    for (int d = 0; d < 2; d++) c->x[d][i] = xy[2 * k + d] + (i == points ? kind->span[d] : 0);
    if (i) length += PetscSqrtReal(PetscSqr(c->x[0][i] - c->x[0][i - 1]) + PetscSqr(c->x[1][i] - c->x[1][i - 1]));
    c->t[i] = length;
  }
  for (PetscInt i = 0; i <= n; i++) c->t[i] /= length;
  for (PetscInt i = 0; i <= n; i++)
    for (int d = 0; d < 2; d++) c->x[d][i] -= kind->span[d] * c->t[i];
  PetscCall(CurveSplineSetUp(c));
  PetscFunctionReturn(PETSC_SUCCESS);
}
