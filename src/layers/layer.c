#include "layers/layer.h"
#include "base/lanes.h"
#include "layers/doublecurve.h"
#include "numerics/spectral.h"

#define FINE 4  /* points of the finer curve a marker */
#define NEAR 6  /* spacings of markers from a membrane, within which the finer curve is summed */
#define CLOSE 3 /* spacings of its points, within which the trapezoidal rule is corrected */

/* One membrane, a trigonometric polynomial of the parameter t: marker k at t = 2 pi k/n. */
struct _p_LayerCurve {
  PetscInt n;
  PetscReal spacing;            /* of the markers, the mean */
  const PetscReal *X, *F;       /* [2n] markers and forces */
  Point *curve, *force;         /* [n + 1] modes -n/2 .. n/2, of X and of F; NULL: not made */
  PetscReal *fine, *fine_force; /* [2 FINE n] the finer curve; forces, 1/FINE of a marker's; whole vectors */
};

static PetscErrorCode CreateCurve(LayerCurve *c, PetscInt n, const PetscReal X[], const PetscReal F[]) {
  const PetscInt N = FINE * n;
  PetscReal length = 0;
  PetscFunctionBeginUser;
  c->n = n;
  c->X = X;
  c->F = F;
  PetscCall(
      PetscMalloc4(n + 1, &c->curve, n + 1, &c->force, 2 * (N + LANES), &c->fine, 2 * (N + LANES), &c->fine_force));
  FourierSeriesModes(n, X, c->curve);
  FourierSeriesModes(n, F, c->force);
  TrigonometricPoints(n, X, FINE, c->fine);
  TrigonometricPoints(n, F, FINE, c->fine_force);
  for (PetscInt j = 0; j < 2 * N; j++) c->fine_force[j] /= FINE;
  for (PetscInt j = 2 * N; j < 2 * (N + LANES); j++) c->fine[j] = c->fine_force[j] = 0;
  for (PetscInt j = 0, k = N - 1; j < N; k = j++)
    length += PetscHypotReal(c->fine[2 * j] - c->fine[2 * k], c->fine[2 * j + 1] - c->fine[2 * k + 1]);
  c->spacing = length / (PetscReal)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerCreate(PetscReal nu, Layout l, const PetscScalar X[], const PetscScalar F[], Layer *out) {
  Layer s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->nu = nu;
  s->layout = l;
  PetscCall(PetscCalloc1(l->bodies, &s->curve));
  PetscCall(PetscCalloc2(2 * (l->M + LANES), &s->X, 2 * (l->M + LANES), &s->F));
  PetscCall(LayoutGather(l, 2, X, s->X));
  PetscCall(LayoutGather(l, 2, F, s->F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerUse(Layer s, PetscInt v) {
  const PetscInt first = s->layout->start[v];
  PetscFunctionBeginUser;
  if (!s->curve[v].curve)
    PetscCall(CreateCurve(&s->curve[v], s->layout->start[v + 1] - first, s->X + 2 * first, s->F + 2 * first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LayerDestroy(Layer *layer) {
  Layer s = *layer;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < s->layout->bodies; v++) {
    LayerCurve *c = &s->curve[v];
    PetscCall(PetscFree4(c->curve, c->force, c->fine, c->fine_force));
  }
  PetscCall(PetscFree(s->curve));
  PetscCall(PetscFree2(s->X, s->F));
  PetscCall(PetscFree(*layer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of n points X[2n] with forces F[2n], whole vectors: 4 pi nu u and 2 pi p. Those of a point at z itself are lost.
 */
static void Sums(PetscInt n, const PetscReal X[], const PetscReal F[], Point z, Point *u, PetscReal *p) {
  const Lanes order = {0, 1, 2, 3};
  Lanes sum[3] = {{0}, {0}, {0}};
  for (PetscInt j = 0; j < n; j += LANES) {
    const LanesBits so = (LanesBits)(order < (Lanes){0} + (PetscReal)(n - j));
    Lanes x, y, f, g;
    LanesPairs(X + 2 * j, &x, &y);
    LanesPairs(F + 2 * j, &f, &g);
    x = creal(z) - x;
    y = cimag(z) - y;
    const Lanes r2 = x * x + y * y, along = (x * f + y * g) / r2, logarithm = 0.5 * LanesLog(r2);
    sum[0] += LanesWhere(so, x * along - logarithm * f);
    sum[1] += LanesWhere(so, y * along - logarithm * g);
    sum[2] += LanesWhere(so, along);
  }
  *u = LanesSum(sum[0]) + I * LanesSum(sum[1]);
  *p = LanesSum(sum[2]);
}

/* Corrections of the finer curve's sums for z close to its point `nearest`: poles, and a logarithm, of the analytic
   integrands at the complex parameter t0 where the curve is at z. Pressure: Re F/(z - X(t)). Velocity: of x (x.F)/r^2
   the part conj[F conj(z - X)/(z - X)]/2; of -ln r, whose error per density is that of ln|2 sin((t - t0)/2)|. */
static void CorrectClose(const LayerCurve *c, Point z, PetscInt nearest, Point *u, PetscReal *p) {
  const PetscInt N = FINE * c->n;
  const PetscReal per = (PetscReal)c->n / (2 * PETSC_PI);
  Point t0 = 2 * PETSC_PI * (PetscReal)nearest / (PetscReal)N, slope, mirror, other;
  if (!CurveRoot(c->n, c->curve, N, CLOSE, z, &t0, &slope)) return;
  mirror = conj(FourierSeriesAt(c->n, c->curve, conj(t0), &other));
  const Point F = FourierSeriesAt(c->n, c->force, t0, &other), residue = -F / slope;
  const Point density = FourierSeriesAt(c->n, c->force, creal(t0), &other);
  const PetscReal side = cimag(t0) >= 0 ? 1 : -1;
  const PetscReal logarithm = PetscLogReal(cabs(1 - cexp(I * side * (PetscReal)N * t0)));
  *p += per * creal(CurvePole(N, t0, 0, residue));
  *u += 0.5 * per * conj(CurvePole(N, t0, 0, residue * (conj(z) - mirror))) + density * logarithm / FINE;
}

void LayerAdd(Layer s, PetscInt v, const PetscReal x[2], PetscReal u[2], PetscReal *p) {
  const LayerCurve *c = &s->curve[v];
  const PetscInt N = FINE * c->n;
  Point z = x[0] + I * x[1], velocity;
  PetscReal pressure, distance;
  (void)CurveNearest(c->n, c->X, z, &distance);
  if (distance < NEAR * c->spacing) {
    const PetscInt nearest = CurveNearest(N, c->fine, z, &distance);
    const PetscBool close = distance < CLOSE * c->spacing / FINE ? PETSC_TRUE : PETSC_FALSE;
    if (distance < 1e-7 * c->spacing) /* a point of the curve: next to it */
      z = c->fine[2 * nearest] + 1e-7 * c->spacing + I * c->fine[2 * nearest + 1];
    Sums(N, c->fine, c->fine_force, z, &velocity, &pressure);
    if (close) CorrectClose(c, z, nearest, &velocity, &pressure);
  } else
    Sums(c->n, c->X, c->F, z, &velocity, &pressure);
  u[0] += creal(velocity) / (4 * PETSC_PI * s->nu);
  u[1] += cimag(velocity) / (4 * PETSC_PI * s->nu);
  *p += pressure / (2 * PETSC_PI);
}
