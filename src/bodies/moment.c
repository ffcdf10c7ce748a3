#include "bodies/moment.h"
#include "numerics/blas.h"

#define TIMES 2 /* points of the energy for each marker */

/* r at a point of the membrane, and its derivatives by a = X_s and b = X_ss. */
typedef struct {
  PetscReal r, by_a[2], by_b[2];
} MomentPoint;

typedef struct {
  Membrane membrane;  /* borrowed */
  PetscReal *kappa0;  /* [TIMES M] curvature that bending prefers, at the points */
  MomentPoint *point; /* [TIMES M] of all vesicles, where the force is placed: dense blocks may be of any of them */
  MomentPoint *other; /* [TIMES M] work: of other markers */
  PetscReal *slope;   /* [4 TIMES M] work: a = X_s at the points of one vesicle, and behind it b = X_ss */
  PetscScalar *at;    /* [2n] grad E_B - N X* at the own markers */
} Moment;

static MomentPoint MomentOf(MomentType type, PetscReal kappa0, const PetscReal a[2], const PetscReal b[2]) {
  const PetscReal q = PetscSqr(a[0]) + PetscSqr(a[1]), lambda = PetscSqrtReal(q);
  const PetscReal theta = (a[0] * b[1] - a[1] * b[0]) / q;
  const int p = type == MOMENT_HELFRICH;
  const PetscReal change = theta - (p ? kappa0 * lambda : kappa0), root = p ? 1 / PetscSqrtReal(lambda) : 1;
  MomentPoint o = {.r = root * change};
  for (int c = 0; c < 2; c++) {
    const PetscReal sign = c ? -1 : 1;
    o.by_a[c] = root * (sign * b[1 - c] - (2 * theta + p * (kappa0 * lambda + 0.5 * change)) * a[c]) / q;
    o.by_b[c] = -root * sign * a[1 - c] / q;
  }
  return o;
}

/* Slopes of one vesicle's X[2n] at the points: at the markers, and then halfway to the next ones. */
static void MomentSlopes(const Moment *o, PetscInt v, const PetscScalar X[]) {
  const PetscReal rate = LayoutCount(o->membrane->layout, v) / o->membrane->arc[v];
  SpectralSlopes(o->membrane->spectral[v], (PetscReal[]){rate, rate * rate}, X, o->slope);
}

/* G += alpha times the transpose of MomentSlopes of o->slope for the c_b ds of a point. */
static void MomentSlopesTranspose(const Moment *o, PetscInt v, PetscReal alpha, PetscScalar G[]) {
  const Membrane m = o->membrane;
  const PetscReal rate = LayoutCount(m->layout, v) / m->arc[v],
                  size = alpha * m->bending * m->part[v] * m->ds[v] / TIMES;
  SpectralSlopesTranspose(m->spectral[v], (PetscReal[]){size * rate, size * rate * rate}, o->slope, G);
}

/* The points of one vesicle's markers X[2n], among those of all. */
static void MomentPoints(const Moment *o, PetscInt v, const PetscScalar X[], MomentPoint point[]) {
  const PetscInt first = TIMES * o->membrane->layout->start[v], points = TIMES * LayoutCount(o->membrane->layout, v);
  MomentSlopes(o, v, X);
  for (PetscInt q = 0; q < points; q++)
    point[first + q] = MomentOf(o->membrane->moment, o->kappa0[first + q], o->slope + 2 * q,
                                o->slope + 2 * (points + q));
}

/* G += alpha (gradient grad E_B + rate N V), at the markers of one vesicle's points; slope: that of the motion V,
   where rate is not 0. */
static void MomentAdd(const Moment *o, PetscInt v, const MomentPoint point[], PetscReal gradient, PetscReal rate,
                      PetscReal alpha, PetscScalar G[]) {
  const PetscInt first = TIMES * o->membrane->layout->start[v], points = TIMES * LayoutCount(o->membrane->layout, v);
  for (PetscInt q = 0; q < points; q++) {
    const MomentPoint *at = &point[first + q];
    PetscReal *a = o->slope + 2 * q, *b = a + 2 * points, r = gradient * at->r;
    if (rate != 0) r += rate * (at->by_a[0] * a[0] + at->by_a[1] * a[1] + at->by_b[0] * b[0] + at->by_b[1] * b[1]);
    for (int c = 0; c < 2; c++) {
      a[c] = r * at->by_a[c];
      b[c] = r * at->by_b[c];
    }
  }
  MomentSlopesTranspose(o, v, alpha, G);
}

static PetscErrorCode MomentPlace(void *context, Instant t, const PetscReal X[]) {
  const Moment *o = (const Moment *)context;
  const Layout l = o->membrane->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(o->at, 2 * l->n));
  for (PetscInt v = 0; v < l->bodies; v++) {
    MomentPoints(o, v, X + 2 * l->start[v], o->point);
    if (v >= l->own && v < l->end) MomentAdd(o, v, o->point, 1, -1, 1, o->at + 2 * LayoutOffset(l, v));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentRate(void *context, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  const Moment *o = (const Moment *)context;
  const Layout l = o->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    MomentSlopes(o, v, V + 2 * LayoutOffset(l, v));
    MomentAdd(o, v, o->point, 0, 1, alpha, F + 2 * LayoutOffset(l, v));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const Moment *o = (const Moment *)context;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * o->membrane->layout->n; k++) F[k] += alpha * o->at[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* alpha N = A^T A. The slopes of a unit at one marker are those of all others, shifted. */
static PetscErrorCode MomentDense(void *context, PetscInt v, PetscReal alpha, PetscReal K[]) {
  const Moment *o = (const Moment *)context;
  const Membrane m = o->membrane;
  const PetscInt n = LayoutCount(m->layout, v), points = TIMES * n;
  PetscReal *unit, *A;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * n, &unit, 2 * n * points, &A));
  unit[0] = PetscSqrtReal(alpha * m->bending * m->part[v] * m->ds[v] / TIMES);
  MomentSlopes(o, v, unit);
  for (PetscInt k = 0; k < points; k++) {
    const MomentPoint *at = &o->point[TIMES * m->layout->start[v] + k];
    for (PetscInt j = 0; j < 2 * n; j++) {
      const PetscInt q = 2 * (k % n < j / 2 ? k - j / 2 + n : k - j / 2);
      A[j * points + k] = at->by_a[j % 2] * o->slope[q] + at->by_b[j % 2] * o->slope[2 * points + q];
    }
  }
  const DenseView view = {A, points, 2 * n, points};
  PetscCall(DenseProductWithin(PETSC_TRUE, view, view, 1, K, 2 * n));
  PetscCall(PetscFree2(unit, A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentAt(void *context, Instant t, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
  const Moment *o = (const Moment *)context;
  const Membrane m = o->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = 2 * LayoutOffset(l, v);
    const PetscReal size = m->bending * m->part[v] * m->ds[v] / TIMES;
    MomentPoints(o, v, X + at, o->other);
    for (PetscInt q = TIMES * l->start[v]; q < TIMES * l->start[v + 1] && E; q++)
      E[v] += 0.5 * size * PetscSqr(o->other[q].r);
    if (F) MomentAdd(o, v, o->other, 1, 0, -1, F + at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentDestroy(void *context) {
  Moment *o = (Moment *)context;
  PetscFunctionBeginUser;
  PetscCall(PetscFree5(o->kappa0, o->point, o->other, o->slope, o->at));
  PetscCall(PetscFree(context));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ForceCreate_Moment(Bodies bodies, Grid grid, Scene scene, Force *force) {
  const Membrane m = bodies->membrane;
  Moment *o;
  PetscFunctionBeginUser;
  if (m->moment == MOMENT_QUADRATIC || m->bending == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&o));
  o->membrane = m;
  const PetscInt points = TIMES * m->layout->M;
  PetscCall(PetscCalloc5(points, &o->kappa0, points, &o->point, points, &o->other, 4 * points, &o->slope,
                         2 * m->layout->n, &o->at));
  for (PetscInt v = 0; v < m->layout->bodies && m->memory; v++) {
    const PetscInt first = m->layout->start[v], n = LayoutCount(m->layout, v);
    PetscReal *kappa0 = o->kappa0 + TIMES * first;
    PetscCall(PetscArraycpy(kappa0, m->memory + first, n));
    SpectralShift(m->spectral[v], 1, PETSC_PI / n, kappa0, kappa0 + n);
  }
  *force = (Force){.name = "bending",
                   .reach = FORCE_WITHIN,
                   .context = o,
                   .place = MomentPlace,
                   .rate = MomentRate,
                   .known = MomentKnown,
                   .dense = MomentDense,
                   .law = MomentAt,
                   .energy = MomentAt,
                   .destroy = MomentDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
