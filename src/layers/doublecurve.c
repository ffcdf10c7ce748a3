#include "layers/doublecurve.h"
#include "base/lanes.h"

#define FINE 4    /* points a marker */
#define CLOSE 4   /* spacings of the points within which the trapezoidal rule is corrected */
#define NEWTON 12 /* most steps */

struct _p_DoubleCurve {
  PetscInt n;
  PetscReal nu, spacing;  /* spacing: of the points, the largest */
  Point *curve, *density; /* [n + 1] modes -n/2 .. n/2 of X and of J */
  Point *fine, *slope;    /* [FINE n] points, X' there */
  PetscReal *each[6];     /* [FINE n] the same and J there, x and y apart: for sums */
};

enum { AT, SLOPE = 2, JUMP = 4 };

static void Put(DoubleCurve c, int what, PetscInt j, Point value) {
  c->each[what][j] = creal(value);
  c->each[what + 1][j] = cimag(value);
}

PetscErrorCode DoubleCurveCreate(PetscInt n, PetscReal nu, const PetscReal X[], const PetscReal J[], DoubleCurve *out) {
  const PetscInt N = FINE * n;
  DoubleCurve c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->n = n;
  c->nu = nu;
  PetscCall(PetscMalloc4(n + 1, &c->curve, n + 1, &c->density, N, &c->fine, N, &c->slope));
  PetscCall(PetscMalloc1(6 * N, &c->each[0]));
  for (int k = 1; k < 6; k++) c->each[k] = c->each[0] + k * N;
  FourierSeriesModes(n, X, c->curve);
  FourierSeriesModes(n, J, c->density);
  for (PetscInt j = 0; j < N; j++) {
    Point other;
    c->fine[j] = FourierSeriesAt(n, c->curve, 2 * PETSC_PI * (PetscReal)j / (PetscReal)N, &c->slope[j]);
    Put(c, AT, j, c->fine[j]);
    Put(c, SLOPE, j, c->slope[j]);
    Put(c, JUMP, j, FourierSeriesAt(n, c->density, 2 * PETSC_PI * (PetscReal)j / (PetscReal)N, &other));
    c->spacing = PetscMax(c->spacing, cabs(c->slope[j]) * 2 * PETSC_PI / (PetscReal)N);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCurveDestroy(DoubleCurve *curve) {
  PetscFunctionBeginUser;
  if (!*curve) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree4((*curve)->curve, (*curve)->density, (*curve)->fine, (*curve)->slope));
  PetscCall(PetscFree((*curve)->each[0]));
  PetscCall(PetscFree(*curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the trapezoidal rule on N points lacks of INT f dt over a period, f of period 2 pi with the pole
   double/(t - t0)^2 + single/(t - t0): exact for (1/2) cot((t - t0)/2), whose sum is -pi cot(N t0/2), and for its
   derivative by t0. With e = e^{+-i N t0}, cot(N t0/2) = -+i (1 + e)/(1 - e). */
Point CurvePole(PetscInt N, Point t0, Point twice, Point once) {
  const PetscReal side = cimag(t0) >= 0 ? 1 : -1;
  const Point e = cexp(I * side * (PetscReal)N * t0);
  const Point simple = -2 * PETSC_PI * side * I * e / (1 - e);
  return once * simple + twice * (I * side * (PetscReal)N) * simple / (1 - e);
}

PetscBool CurveRoot(PetscInt n, const Point curve[], PetscInt N, PetscReal close, Point z, Point *t0, Point *slope) {
  Point step = 1;
  for (int k = 0; k < NEWTON && cabs(step) > 1e-13; k++) {
    const Point off = z - FourierSeriesAt(n, curve, *t0, slope);
    step = off / *slope;
    *t0 += step;
  }
  (void)FourierSeriesAt(n, curve, *t0, slope);
  return cabs(step) < 1e-8 && PetscAbsReal(cimag(*t0)) * N <= 2 * 2 * PETSC_PI * close ? PETSC_TRUE : PETSC_FALSE;
}

/* The integrals without their factors; winding: INT Im(X'/r) dt. */
typedef struct {
  Point velocity, pressure;
  PetscReal winding;
} Sums;

PetscInt CurveNearest(PetscInt n, const PetscReal X[], Point z, PetscReal *distance) {
  PetscInt nearest = 0;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal r2 = PetscSqr(X[2 * j] - creal(z)) + PetscSqr(X[2 * j + 1] - cimag(z));
    if (r2 >= least) continue;
    least = r2;
    nearest = j;
  }
  *distance = PetscSqrtReal(least);
  return nearest;
}

/* By the finer points, LANES of them at once. */
static void FineSums(DoubleCurve c, Point z, Sums *s) {
  const PetscInt N = FINE * c->n;
  const PetscReal step = 2 * PETSC_PI / N;
  Lanes sum[5] = {{0}, {0}, {0}, {0}, {0}};
  for (PetscInt j = 0; j < N; j += LANES) {
    Lanes r[2], t[2], J[2];
    for (int d = 0; d < 2; d++) {
      r[d] = LanesAt(c->each[AT + d] + j) - (d ? cimag(z) : creal(z));
      t[d] = LanesAt(c->each[SLOPE + d] + j);
      J[d] = LanesAt(c->each[JUMP + d] + j);
    }
    const Lanes over = 1 / (r[0] * r[0] + r[1] * r[1]);
    const Lanes along = (t[0] * r[0] + t[1] * r[1]) * over, turn = (t[1] * r[0] - t[0] * r[1]) * over; /* X'/r */
    const Lanes c2 = (r[0] * r[0] - r[1] * r[1]) * over, s2 = 2 * r[0] * r[1] * over;                  /* r/conj(r) */
    const Lanes p[2] = {J[0] * along - J[1] * turn, J[0] * turn + J[1] * along};                       /* J X'/r */
    sum[0] += turn * (J[0] + c2 * J[0] + s2 * J[1]);
    sum[1] += turn * (J[1] + s2 * J[0] - c2 * J[1]);
    sum[2] += (p[0] * r[0] + p[1] * r[1]) * over;
    sum[3] += (p[1] * r[0] - p[0] * r[1]) * over;
    sum[4] += turn;
  }
  s->velocity = step * (LanesSum(sum[0]) + I * LanesSum(sum[1]));
  s->pressure = step * (LanesSum(sum[2]) + I * LanesSum(sum[3]));
  s->winding = step * LanesSum(sum[4]);
}

/* What they lack at the complex t0 where the curve is at z, for z close to the point `nearest`. Of the velocity, 2i
   times it is J X'/r - conj(conj(J) X'/r) + conj(J conj(X')/r) - conj(conj(r) J X'/r^2), bars meaning values at
   conj(t0); X'/r^2 = 1/(X'(t0) (t - t0)^2) without a simple pole. */
static void CorrectClose(DoubleCurve c, Point z, PetscInt nearest, Sums *s) {
  const PetscInt N = FINE * c->n;
  Point t0 = 2 * PETSC_PI * (PetscReal)nearest / (PetscReal)N, slope, other, turned;
  if (!CurveRoot(c->n, c->curve, N, CLOSE, z, &t0, &slope)) return;
  const Point mirror = conj(FourierSeriesAt(c->n, c->curve, conj(t0), &turned) - z);
  const Point J = FourierSeriesAt(c->n, c->density, t0, &other),
              bar = conj(FourierSeriesAt(c->n, c->density, conj(t0), &(Point){0}));
  const Point h = mirror * J, dh = conj(turned) * J + mirror * other;
  const Point direct = CurvePole(N, t0, 0, J), back = CurvePole(N, t0, 0, bar);
  const Point across = CurvePole(N, t0, 0, J * conj(turned) / slope), last = CurvePole(N, t0, h / slope, dh / slope);
  s->velocity += (direct - conj(back) + conj(across) - conj(last)) / (2 * I);
  s->pressure += CurvePole(N, t0, J / slope, other / slope);
  s->winding += cimag(CurvePole(N, t0, 0, 1));
}

void DoubleCurveAdd(DoubleCurve c, const PetscReal x[2], PetscReal u[2], PetscReal *p, PetscBool *inside) {
  Point z = x[0] + I * x[1];
  PetscReal distance;
  Sums s;
  const PetscInt nearest = CurveNearest(FINE * c->n, (const PetscReal *)c->fine, z, &distance);
  if (distance < 1e-7 * c->spacing) /* a point of the curve: next to it, outside */
    z = c->fine[nearest] - I * 1e-7 * c->spacing * c->slope[nearest] / cabs(c->slope[nearest]);
  FineSums(c, z, &s);
  if (distance < CLOSE * c->spacing) CorrectClose(c, z, nearest, &s);
  u[0] -= creal(s.velocity) / (2 * PETSC_PI);
  u[1] -= cimag(s.velocity) / (2 * PETSC_PI);
  *p += c->nu / PETSC_PI * cimag(s.pressure);
  *inside = s.winding > PETSC_PI ? PETSC_TRUE : PETSC_FALSE;
}

PetscBool DoubleCurveContains(DoubleCurve c, const PetscReal x[2]) {
  const PetscInt N = FINE * c->n;
  const PetscReal *X = c->each[AT], *Y = c->each[AT + 1];
  PetscBool inside = PETSC_FALSE;
  for (PetscInt j = 0, k = N - 1; j < N; k = j++)
    if ((Y[j] > x[1]) != (Y[k] > x[1]) && x[0] < X[j] + (X[k] - X[j]) * (x[1] - Y[j]) / (Y[k] - Y[j])) inside = !inside;
  return inside;
}
