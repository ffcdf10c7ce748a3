#include "coupling/doublecurve.h"
#include "curve/modes.h"

#define FINE 4    /* points a marker */
#define CLOSE 4   /* spacings of the points within which the trapezoidal rule is corrected */
#define NEWTON 12 /* most steps */

struct _p_DoubleCurve {
  PetscInt n;
  PetscReal nu, spacing;       /* spacing: of the points, the largest */
  Point *curve, *density;      /* [n + 1] modes -n/2 .. n/2 of X and of J */
  Point *fine, *slope, *value; /* [FINE n] points, X' and J there */
};

PetscErrorCode DoubleCurveCreate(PetscInt n, PetscReal nu, const PetscReal X[], const PetscReal J[], DoubleCurve *out) {
  const PetscInt N = FINE * n;
  DoubleCurve c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->n = n;
  c->nu = nu;
  PetscCall(PetscMalloc5(n + 1, &c->curve, n + 1, &c->density, N, &c->fine, N, &c->slope, N, &c->value));
  CurveModes(n, X, c->curve);
  CurveModes(n, J, c->density);
  for (PetscInt j = 0; j < N; j++) {
    Point other;
    c->fine[j] = CurveSeries(n, c->curve, 2 * PETSC_PI * (PetscReal)j / (PetscReal)N, &c->slope[j]);
    c->value[j] = CurveSeries(n, c->density, 2 * PETSC_PI * (PetscReal)j / (PetscReal)N, &other);
    c->spacing = PetscMax(c->spacing, cabs(c->slope[j]) * 2 * PETSC_PI / (PetscReal)N);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DoubleCurveDestroy(DoubleCurve *curve) {
  PetscFunctionBeginUser;
  if (!*curve) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree5((*curve)->curve, (*curve)->density, (*curve)->fine, (*curve)->slope, (*curve)->value));
  PetscCall(PetscFree(*curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the trapezoidal rule on N points lacks of INT f dt over a period, f of period 2 pi with the pole
   double/(t - t0)^2 + single/(t - t0): exact for (1/2) cot((t - t0)/2), whose sum is -pi cot(N t0/2), and for its
   derivative by t0. With e = e^{+-i N t0}, cot(N t0/2) = -+i (1 + e)/(1 - e). */
static Point PoleError(PetscInt N, Point t0, Point twice, Point single) {
  const PetscReal side = cimag(t0) >= 0 ? 1 : -1;
  const Point e = cexp(I * side * (PetscReal)N * t0);
  const Point simple = -2 * PETSC_PI * side * I * e / (1 - e);
  return single * simple + twice * (I * side * (PetscReal)N) * simple / (1 - e);
}

/* The integrals without their factors; winding: INT Im(X'/r) dt. */
typedef struct {
  Point velocity, pressure;
  PetscReal winding;
} Sums;

/* By the finer points; the one nearest to z. */
static PetscInt FineSums(DoubleCurve c, Point z, Sums *s, PetscReal *distance) {
  const PetscInt N = FINE * c->n;
  PetscInt nearest = 0;
  PetscReal least = PETSC_MAX_REAL;
  *s = (Sums){0};
  for (PetscInt j = 0; j < N; j++) {
    const Point r = c->fine[j] - z, J = c->value[j], turn = c->slope[j] / r;
    s->velocity += cimag(turn) * (J + r / conj(r) * conj(J));
    s->pressure += J * turn / r;
    s->winding += cimag(turn);
    if (cabs(r) >= least) continue;
    least = cabs(r);
    nearest = j;
  }
  s->velocity *= 2 * PETSC_PI / N;
  s->pressure *= 2 * PETSC_PI / N;
  s->winding *= 2 * PETSC_PI / N;
  *distance = least;
  return nearest;
}

/* What they lack at the complex t0 where the curve is at z, for z close to the point `nearest`. Of the velocity, 2i
   times it is J X'/r - conj(conj(J) X'/r) + conj(J conj(X')/r) - conj(conj(r) J X'/r^2), bars meaning values at
   conj(t0); X'/r^2 = 1/(X'(t0) (t - t0)^2) without a simple pole. */
static void CorrectClose(DoubleCurve c, Point z, PetscInt nearest, Sums *s) {
  const PetscInt N = FINE * c->n;
  Point t0 = 2 * PETSC_PI * (PetscReal)nearest / (PetscReal)N, slope, step = 1, other, turned;
  for (int k = 0; k < NEWTON && cabs(step) > 1e-13; k++) {
    const Point off = z - CurveSeries(c->n, c->curve, t0, &slope);
    step = off / slope;
    t0 += step;
  }
  if (!(cabs(step) < 1e-8) || PetscAbsReal(cimag(t0)) * N > 2 * 2 * PETSC_PI * CLOSE) return;
  (void)CurveSeries(c->n, c->curve, t0, &slope);
  const Point mirror = conj(CurveSeries(c->n, c->curve, conj(t0), &turned) - z);
  const Point J = CurveSeries(c->n, c->density, t0, &other),
              bar = conj(CurveSeries(c->n, c->density, conj(t0), &(Point){0}));
  const Point h = mirror * J, dh = conj(turned) * J + mirror * other;
  const Point direct = PoleError(N, t0, 0, J), back = PoleError(N, t0, 0, bar);
  const Point across = PoleError(N, t0, 0, J * conj(turned) / slope), last = PoleError(N, t0, h / slope, dh / slope);
  s->velocity += (direct - conj(back) + conj(across) - conj(last)) / (2 * I);
  s->pressure += PoleError(N, t0, J / slope, other / slope);
  s->winding += cimag(PoleError(N, t0, 0, 1));
}

void DoubleCurveAdd(DoubleCurve c, const PetscReal x[2], PetscReal u[2], PetscReal *p, PetscBool *inside) {
  Point z = x[0] + I * x[1];
  PetscReal distance;
  Sums s;
  PetscInt nearest = FineSums(c, z, &s, &distance);
  if (distance < 1e-7 * c->spacing) { /* a point of the curve: next to it, outside */
    z = c->fine[nearest] - I * 1e-7 * c->spacing * c->slope[nearest] / cabs(c->slope[nearest]);
    nearest = FineSums(c, z, &s, &distance);
  }
  if (distance < CLOSE * c->spacing) CorrectClose(c, z, nearest, &s);
  u[0] -= creal(s.velocity) / (2 * PETSC_PI);
  u[1] -= cimag(s.velocity) / (2 * PETSC_PI);
  *p += c->nu / PETSC_PI * cimag(s.pressure);
  *inside = s.winding > PETSC_PI ? PETSC_TRUE : PETSC_FALSE;
}
