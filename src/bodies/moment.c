#include "bodies/moment.h"

#define TIMES 2 /* points of the energy for each marker */

/* The change of bending at a point of the membrane, theta - kappa0 lambda^p, and its derivatives. */
typedef struct {
  PetscReal change, weight;   /* the energy of a length at rest is c_b/2 weight change^2, weight = lambda^-p */
  PetscReal by_a[2], by_b[2]; /* derivatives of the change by a = X_s and b = X_ss */
  PetscReal weight_by_a[2];   /* derivative of the weight by a, over the weight */
} MomentPoint;

typedef struct {
  Membrane membrane;  /* borrowed */
  MomentPoint *point; /* [TIMES M] of all vesicles, where the force is placed: dense blocks may be of any of them */
  PetscScalar *at;    /* [2n] grad E_B - N X* at the own markers */
} Moment;

static MomentPoint *MomentPointsOf(const Moment *o, PetscInt v) {
  return o->point + TIMES * o->membrane->layout->start[v];
}

static MomentPoint MomentOf(MomentType type, PetscReal kappa0, const PetscReal a[2], const PetscReal b[2]) {
  const PetscReal q = PetscSqr(a[0]) + PetscSqr(a[1]), lambda = PetscSqrtReal(q);
  const PetscReal theta = (a[0] * b[1] - a[1] * b[0]) / q;
  const int p = type == MOMENT_HELFRICH;
  MomentPoint o = {.change = theta - (p ? kappa0 * lambda : kappa0), .weight = p ? 1 / lambda : 1};
  for (int c = 0; c < 2; c++) {
    const PetscReal sign = c ? -1 : 1;
    o.by_a[c] = (sign * b[1 - c] - (2 * theta + p * kappa0 * lambda) * a[c]) / q;
    o.by_b[c] = -sign * a[1 - c] / q;
    o.weight_by_a[c] = -p * a[c] / q;
  }
  return o;
}

/* X_s and X_ss of one vesicle's X[2n] at the points: a[2 TIMES n], b[2 TIMES n]. */
static void MomentSlopes(Membrane m, PetscInt v, const PetscScalar X[], PetscReal a[], PetscReal b[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscScalar *own = m->work.bending;
  for (int power = 1; power <= 2; power++) {
    (void)PetscArrayzero(own, 2 * n);
    SpectralDerivative(m->spectral[v], power, PetscPowRealInt(n / m->arc[v], power), X, own);
    TrigonometricPoints(n, own, TIMES, power == 1 ? a : b);
  }
}

/* G += alpha times the transpose of MomentSlopes for the c_b ds of a point; the first derivative is antisymmetric. */
static void MomentSlopesTranspose(Membrane m, PetscInt v, PetscReal alpha, const PetscReal a[], const PetscReal b[],
                                  PetscScalar G[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  const PetscReal size = alpha * m->bending * m->part[v] * m->ds[v] / TIMES;
  PetscScalar *own = m->work.bending;
  for (int power = 1; power <= 2; power++) {
    TrigonometricPointsTranspose(n, power == 1 ? a : b, TIMES, own);
    SpectralDerivative(m->spectral[v], power, (power == 1 ? -size : size) * PetscPowRealInt(n / m->arc[v], power), own,
                       G);
  }
}

/* The points of one vesicle's markers X[2n]. */
static PetscErrorCode MomentPoints(Membrane m, PetscInt v, const PetscScalar X[], MomentPoint point[]) {
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal *a, *b, *kappa0, *own;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(2 * n, &own, 2 * TIMES * n, &a, 2 * TIMES * n, &b, 2 * TIMES * n, &kappa0));
  for (PetscInt k = 0; k < n && m->memory; k++) own[2 * k] = m->memory[m->layout->start[v] + k];
  TrigonometricPoints(n, own, TIMES, kappa0);
  MomentSlopes(m, v, X, a, b);
  for (PetscInt q = 0; q < TIMES * n; q++) point[q] = MomentOf(m->moment, kappa0[2 * q], a + 2 * q, b + 2 * q);
  PetscCall(PetscFree4(own, a, b, kappa0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* G += alpha grad E_B, or with a motion V[2n] that is not NULL alpha N V, at the markers of these points. */
static PetscErrorCode MomentAdd(Membrane m, PetscInt v, PetscReal alpha, const MomentPoint point[],
                                const PetscScalar V[], PetscScalar G[]) {
  const PetscInt fine = TIMES * LayoutCount(m->layout, v);
  PetscReal *a, *b;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(2 * fine, &a, 2 * fine, &b));
  if (V) MomentSlopes(m, v, V, a, b);
  for (PetscInt q = 0; q < fine; q++) {
    const MomentPoint *o = &point[q];
    PetscReal change = V ? 0 : o->change;
    for (int c = 0; c < 2; c++) change += o->by_a[c] * a[2 * q + c] + o->by_b[c] * b[2 * q + c];
    for (int c = 0; c < 2; c++) {
      a[2 * q + c] = o->weight * change * (o->by_a[c] + (V ? 0 : 0.5 * change * o->weight_by_a[c]));
      b[2 * q + c] = o->weight * change * o->by_b[c];
    }
  }
  MomentSlopesTranspose(m, v, alpha, a, b, G);
  PetscCall(PetscFree2(a, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentPlace(void *context, Instant t, const PetscReal X[]) {
  const Moment *o = (const Moment *)context;
  const Membrane m = o->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(o->at, 2 * l->n));
  for (PetscInt v = 0; v < l->bodies; v++) PetscCall(MomentPoints(m, v, X + 2 * l->start[v], MomentPointsOf(o, v)));
  for (PetscInt v = l->own; v < l->end; v++) {
    PetscScalar *at = o->at + 2 * LayoutOffset(l, v);
    PetscCall(MomentAdd(m, v, 1, MomentPointsOf(o, v), NULL, at));
    PetscCall(MomentAdd(m, v, -1, MomentPointsOf(o, v), X + 2 * l->start[v], at));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentRate(void *context, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  const Moment *o = (const Moment *)context;
  const Membrane m = o->membrane;
  const Layout l = m->layout;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = LayoutOffset(l, v);
    PetscCall(MomentAdd(m, v, alpha, MomentPointsOf(o, v), V + 2 * at, F + 2 * at));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const Moment *o = (const Moment *)context;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * o->membrane->layout->n; k++) F[k] += alpha * o->at[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentDense(void *context, PetscInt v, PetscReal alpha, PetscReal K[]) {
  const Moment *o = (const Moment *)context;
  const Membrane m = o->membrane;
  const PetscInt n = LayoutCount(m->layout, v);
  PetscReal *unit;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * n, &unit));
  for (PetscInt k = 0; k < 2 * n; k++) {
    unit[k] = 1;
    PetscCall(MomentAdd(m, v, alpha, MomentPointsOf(o, v), unit, K + 2 * n * k));
    unit[k] = 0;
  }
  PetscCall(PetscFree(unit));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F -= grad E_B, E[vesicles] += E_B of the own vesicles at the markers X[2n]; NULL: not wanted. */
static PetscErrorCode MomentOfMarkers(const Moment *o, const PetscScalar X[], PetscScalar F[], PetscReal E[]) {
  const Membrane m = o->membrane;
  MomentPoint *point;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(TIMES * m->layout->n, &point));
  for (PetscInt v = m->layout->own; v < m->layout->end; v++) {
    const PetscInt at = 2 * LayoutOffset(m->layout, v), fine = TIMES * LayoutCount(m->layout, v);
    const PetscReal size = m->bending * m->part[v] * m->ds[v] / TIMES;
    PetscCall(MomentPoints(m, v, X + at, point));
    for (PetscInt q = 0; q < fine && E; q++) E[v] += 0.5 * size * point[q].weight * PetscSqr(point[q].change);
    if (F) PetscCall(MomentAdd(m, v, -1, point, NULL, F + at));
  }
  PetscCall(PetscFree(point));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MomentLaw(void *context, Instant t, const PetscScalar X[], PetscScalar F[]) {
  return MomentOfMarkers((const Moment *)context, X, F, NULL);
}

static PetscErrorCode MomentEnergy(void *context, Instant t, const PetscScalar X[], PetscReal E[]) {
  return MomentOfMarkers((const Moment *)context, X, NULL, E);
}

static PetscErrorCode MomentDestroy(void *context) {
  Moment *o = (Moment *)context;
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(o->point, o->at));
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
  PetscCall(PetscCalloc2(TIMES * m->layout->M, &o->point, 2 * m->layout->n, &o->at));
  *force = (Force){.name = "bending",
                   .reach = FORCE_WITHIN,
                   .context = o,
                   .place = MomentPlace,
                   .rate = MomentRate,
                   .known = MomentKnown,
                   .dense = MomentDense,
                   .law = MomentLaw,
                   .energy = MomentEnergy,
                   .destroy = MomentDestroy};
  PetscFunctionReturn(PETSC_SUCCESS);
}
