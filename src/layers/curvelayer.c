#include "layers/curvelayer.h"

#define FINE 4    /* finer points a marker */
#define CLOSE 4   /* spacings of the finer points within which the trapezoidal rule is corrected */
#define NEWTON 12 /* most steps */

/* Points at equal steps of the parameter, x and y apart, of the curve, its slope X' and its density. Whole vectors:
   behind the last point are points without slope and density. */
enum { AT, SLOPE = 2, DENSITY = 4, PARTS = 6 };
typedef struct {
  PetscInt n;
  PetscReal *each[PARTS];
} LayerPoints;

/* Integrals over t without their factors; winding: INT Im(X'/r) dt. */
typedef struct {
  Point velocity;
  PetscReal pressure, winding;
} CurveSums;

/* What the two layers differ in: what makes integrals of sums of the kernel, without their factors; these factors of
   velocity and pressure, for viscosity 1 and (a power of n) one marker; the spacings of the markers within which the
   finer points are summed: everywhere where slope times density has modes that the markers do not resolve; what sums
   lack at the complex t0 where the curve is at z. */
typedef struct {
  const PairKernel *pair;
  PetscReal velocity, pressure, factor[2];
  int markers;
  PetscReal near;
  void (*correct)(CurveLayer layer, Point z, Point t0, Point slope, CurveSums *sums);
} CurveKernel;

struct _p_CurveLayer {
  const CurveKernel *kernel;
  PetscInt n;
  PetscReal spacing;         /* of the finer points, the largest */
  PetscReal factor[2];       /* of the integrals: velocity, pressure */
  Point *curve, *density;    /* [n + 1] modes -n/2 .. n/2 */
  LayerPoints markers, fine; /* n and FINE n points */
};

/* What the trapezoidal rule on N points lacks of INT f dt over a period, f of period 2 pi with the pole
   twice/(t - t0)^2 + once/(t - t0): exact for (1/2) cot((t - t0)/2), whose sum is -pi cot(N t0/2), and for its
   derivative by t0. With e = e^{+-i N t0}, cot(N t0/2) = -+i (1 + e)/(1 - e). */
static Point CurvePole(PetscInt N, Point t0, Point twice, Point once) {
  const PetscReal side = cimag(t0) >= 0 ? 1 : -1;
  const Point e = cexp(I * side * (PetscReal)N * t0);
  const Point simple = -2 * PETSC_PI * side * I * e / (1 - e);
  return once * simple + twice * (I * side * (PetscReal)N) * simple / (1 - e);
}

static CurveSums CurveSumsOf(const CurveKernel *k, const LayerPoints *c, Point z) {
  const PetscReal step = 2 * PETSC_PI / (PetscReal)c->n;
  Lanes sum[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt j = 0; j < c->n; j += LANES) {
    const Lanes x = creal(z) - LanesAt(c->each[AT] + j), y = cimag(z) - LanesAt(c->each[AT + 1] + j);
    const Lanes N[2] = {LanesAt(c->each[SLOPE + 1] + j), -LanesAt(c->each[SLOPE] + j)};
    const Lanes J[2] = {LanesAt(c->each[DENSITY] + j), LanesAt(c->each[DENSITY + 1] + j)};
    Lanes K[3], P[2];
    k->pair->velocity(x, y, N, K);
    k->pair->pressure(x, y, N, P);
    sum[0] += K[0] * J[0] + K[2] * J[1];
    sum[1] += K[2] * J[0] + K[1] * J[1];
    sum[2] += P[0] * J[0] + P[1] * J[1];
    sum[3] -= (x * N[0] + y * N[1]) / (x * x + y * y);
  }
  return (CurveSums){step * k->velocity * (LanesSum(sum[0]) + I * LanesSum(sum[1])),
                     step * k->pressure * LanesSum(sum[2]), step * LanesSum(sum[3])};
}

/* Poles, and a logarithm, of the analytic integrands. Pressure: Re F/(z - X(t)). Velocity: of r (r.F)/r^2 the part
   conj[F conj(z - X)/(z - X)]/2; of -ln r, whose error per density is that of ln|2 sin((t - t0)/2)|. */
static void SingleCorrect(CurveLayer c, Point z, Point t0, Point slope, CurveSums *s) {
  const PetscInt N = c->fine.n;
  Point other;
  const Point mirror = conj(FourierSeriesAt(c->n, c->curve, conj(t0), &other));
  const Point residue = -FourierSeriesAt(c->n, c->density, t0, &other) / slope;
  const Point density = FourierSeriesAt(c->n, c->density, creal(t0), &other);
  const PetscReal side = cimag(t0) >= 0 ? 1 : -1;
  const PetscReal logarithm = PetscLogReal(cabs(1 - cexp(I * side * (PetscReal)N * t0)));
  s->pressure += creal(CurvePole(N, t0, 0, residue));
  s->velocity += 0.5 * conj(CurvePole(N, t0, 0, residue * (conj(z) - mirror))) +
                 2 * PETSC_PI / (PetscReal)N * density * logarithm;
}

/* Of the velocity, 2i times it is J X'/r - conj(conj(J) X'/r) + conj(J conj(X')/r) - conj(conj(r) J X'/r^2), bars
   meaning values at conj(t0); X'/r^2 = 1/(X'(t0) (t - t0)^2) without a simple pole. */
static void DoubleCorrect(CurveLayer c, Point z, Point t0, Point slope, CurveSums *s) {
  const PetscInt N = c->fine.n;
  Point other, turned;
  const Point mirror = conj(FourierSeriesAt(c->n, c->curve, conj(t0), &turned) - z);
  const Point J = FourierSeriesAt(c->n, c->density, t0, &other),
              bar = conj(FourierSeriesAt(c->n, c->density, conj(t0), &(Point){0}));
  const Point h = mirror * J, dh = conj(turned) * J + mirror * other;
  const Point direct = CurvePole(N, t0, 0, J), back = CurvePole(N, t0, 0, bar);
  const Point across = CurvePole(N, t0, 0, J * conj(turned) / slope), last = CurvePole(N, t0, h / slope, dh / slope);
  s->velocity += (direct - conj(back) + conj(across) - conj(last)) / (2 * I);
  s->pressure += cimag(CurvePole(N, t0, J / slope, other / slope));
}

static const CurveKernel curve_kernels[] = {
    {&stokeslet,
     4 * PETSC_PI,
     2 * PETSC_PI,
     {0.125 / (PETSC_PI * PETSC_PI), 0.25 / (PETSC_PI * PETSC_PI)},
     1,
     6,
     SingleCorrect},
    {&stresslet, -2 * PETSC_PI, PETSC_PI, {-0.5 / PETSC_PI, 1 / PETSC_PI}, 0, PETSC_INFINITY, DoubleCorrect}};

static void LayerPointsPut(LayerPoints *c, int what, PetscInt j, Point value) {
  c->each[what][j] = creal(value);
  c->each[what + 1][j] = cimag(value);
}

static Point LayerPointsGet(const LayerPoints *c, int what, PetscInt j) {
  return c->each[what][j] + I * c->each[what + 1][j];
}

static PetscErrorCode LayerPointsCreate(CurveLayer c, PetscInt n, LayerPoints *p) {
  const PetscInt room = n + LANES;
  PetscFunctionBeginUser;
  p->n = n;
  PetscCall(PetscCalloc1(PARTS * room, &p->each[0]));
  for (int k = 1; k < PARTS; k++) p->each[k] = p->each[0] + k * room;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)j / (PetscReal)n;
    Point slope, other;
    LayerPointsPut(p, AT, j, FourierSeriesAt(c->n, c->curve, t, &slope));
    LayerPointsPut(p, SLOPE, j, slope);
    LayerPointsPut(p, DENSITY, j, FourierSeriesAt(c->n, c->density, t, &other));
  }
  for (PetscInt j = n; j < room; j++) LayerPointsPut(p, AT, j, LayerPointsGet(p, AT, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveLayerCreate(const PairKernel *kernel, PetscInt n, PetscReal nu, const PetscReal X[],
                                const PetscReal density[], CurveLayer *out) {
  CurveLayer c;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  *out = c;
  c->kernel = curve_kernels;
  while (c->kernel->pair != kernel) c->kernel++;
  c->n = n;
  for (int q = 0; q < 2; q++)
    c->factor[q] = c->kernel->factor[q] * PetscPowRealInt(n, c->kernel->markers) *
                   PetscPowRealInt(nu, kernel->viscosity + q);
  PetscCall(PetscMalloc2(n + 1, &c->curve, n + 1, &c->density));
  FourierSeriesModes(n, X, c->curve);
  FourierSeriesModes(n, density, c->density);
  PetscCall(LayerPointsCreate(c, n, &c->markers));
  PetscCall(LayerPointsCreate(c, FINE * n, &c->fine));
  for (PetscInt j = 0; j < FINE * n; j++)
    c->spacing = PetscMax(c->spacing, cabs(LayerPointsGet(&c->fine, SLOPE, j)) * 2 * PETSC_PI / (PetscReal)(FINE * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveLayerDestroy(CurveLayer *layer) {
  PetscFunctionBeginUser;
  if (!*layer) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFree2((*layer)->curve, (*layer)->density));
  PetscCall(PetscFree((*layer)->markers.each[0]));
  PetscCall(PetscFree((*layer)->fine.each[0]));
  PetscCall(PetscFree(*layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The point nearest to z, and how far it is. */
static PetscInt CurveNearest(const LayerPoints *c, Point z, PetscReal *distance) {
  PetscInt nearest = 0;
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt j = 0; j < c->n; j++) {
    const PetscReal r2 = PetscSqr(c->each[AT][j] - creal(z)) + PetscSqr(c->each[AT + 1][j] - cimag(z));
    if (r2 >= least) continue;
    least = r2;
    nearest = j;
  }
  *distance = PetscSqrtReal(least);
  return nearest;
}

/* The complex parameter t0, from about t0 on, where the curve is at z, and the slope there; false unless it is found so
   near to the real line that the trapezoidal rule lacks something. */
static PetscBool CurveRoot(CurveLayer c, Point z, Point *t0, Point *slope) {
  Point step = 1;
  for (int k = 0; k < NEWTON && cabs(step) > 1e-13; k++) {
    const Point off = z - FourierSeriesAt(c->n, c->curve, *t0, slope);
    step = off / *slope;
    *t0 += step;
  }
  (void)FourierSeriesAt(c->n, c->curve, *t0, slope);
  return cabs(step) < 1e-8 && PetscAbsReal(cimag(*t0)) * c->fine.n <= 2 * 2 * PETSC_PI * CLOSE;
}

/* The sums over the finer points, with what the trapezoidal rule lacks at the poles. */
static CurveSums CurveNearSums(CurveLayer c, Point z) {
  PetscReal distance;
  const PetscInt nearest = CurveNearest(&c->fine, z, &distance);
  const Point along = LayerPointsGet(&c->fine, SLOPE, nearest);
  Point t0 = 2 * PETSC_PI * (PetscReal)nearest / (PetscReal)c->fine.n, slope;
  if (distance < 1e-7 * c->spacing) /* a point of the curve: next to it, outside */
    z = LayerPointsGet(&c->fine, AT, nearest) - I * 1e-7 * c->spacing * along / cabs(along);
  CurveSums s = CurveSumsOf(c->kernel, &c->fine, z);
  if (distance < CLOSE * c->spacing && CurveRoot(c, z, &t0, &slope)) {
    s.winding += cimag(CurvePole(c->fine.n, t0, 0, 1));
    c->kernel->correct(c, z, t0, slope, &s);
  }
  return s;
}

void CurveLayerAdd(CurveLayer c, const PetscReal x[2], PetscReal u[2], PetscReal *p, PetscBool *inside) {
  const Point z = x[0] + I * x[1];
  PetscReal distance;
  (void)CurveNearest(&c->markers, z, &distance);
  const CurveSums s = distance < c->kernel->near * FINE * c->spacing ? CurveNearSums(c, z)
                                                                     : CurveSumsOf(c->kernel, &c->markers, z);
  u[0] += c->factor[0] * creal(s.velocity);
  u[1] += c->factor[0] * cimag(s.velocity);
  *p += c->factor[1] * s.pressure;
  *inside = s.winding > PETSC_PI;
}

PetscBool CurveLayerContains(CurveLayer c, const PetscReal x[2]) {
  const PetscInt N = c->fine.n;
  const PetscReal *X = c->fine.each[AT], *Y = c->fine.each[AT + 1];
  PetscBool inside = PETSC_FALSE;
  for (PetscInt j = 0, k = N - 1; j < N; k = j++)
    if ((Y[j] > x[1]) != (Y[k] > x[1]) && x[0] < X[j] + (X[k] - X[j]) * (x[1] - Y[j]) / (Y[k] - Y[j])) inside = !inside;
  return inside;
}
