#include "coupling/finecurve.h"
#include "coupling/blas.h"
#include "curve/spectral.h"

static PetscReal Distance2(const PetscReal a[2], const PetscReal b[2]) {
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]);
}

PetscErrorCode FineCurveCreate(NearField f, PetscInt v, const PetscReal shift[2], PetscInt factor, FineCurve *c) {
  const PetscInt n = LayoutCount(f->bodies->layout, v), Q = n * factor;
  const PetscReal *X = f->markers->X + 2 * f->bodies->layout->start[v];
  PetscFunctionBeginUser;
  *c = (FineCurve){.kind = &f->bodies->kind[v], .n = n, .f = factor};
  PetscCall(PetscMalloc3(Q, &c->weight, 2 * Q, &c->x, Q, &c->used));
  for (PetscInt q = 0; q < Q && c->kind->type != CURVE_OPEN; q++)
    c->weight[q] = TrigonometricCardinal(n, 2 * PETSC_PI * q / Q);
  PetscCall(CurveFinePoints(c->kind, n, X, factor, c->x));
  for (PetscInt q = 0; q < 2 * Q; q++) c->x[q] += shift[q % 2];
  for (PetscInt q = 0; q + 1 < Q; q++) c->edge = PetscMax(c->edge, Distance2(c->x + 2 * q, c->x + 2 * (q + 1)));
  c->edge = PetscSqrtReal(c->edge);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FineCurveDestroy(FineCurve *c) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(c->weight, c->x, c->used));
  PetscCall(PetscFree(c->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FineCurveReflect(FineCurve *c, int direction, PetscReal wall) {
  for (PetscInt q = 0; q < c->n * c->f; q++) c->x[2 * q + direction] = 2 * wall - c->x[2 * q + direction];
}

/* The distance from x to the points of a curve where it is below `least`, which else is returned. Along the curve it
   changes by an edge a point at most: points that cannot be near are left out. */
static PetscReal DistanceBelow(const PetscReal x[2], const FineCurve *c, PetscReal least) {
  PetscInt skip;
  for (PetscInt q = 0; q < c->n * c->f; q += PetscMax(1, skip)) {
    const PetscReal distance = PetscSqrtReal(Distance2(x, c->x + 2 * q));
    least = PetscMin(least, distance);
    skip = (PetscInt)PetscMin((distance - least) / c->edge, c->n * c->f);
  }
  return least;
}

PetscReal FineCurveGap(const FineCurve *a, const FineCurve *b) {
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < a->n * a->f; p++) least = DistanceBelow(a->x + 2 * p, b, least);
  return least;
}

/* P/f of the points in use. */
static PetscErrorCode Weigh(FineCurve *a) {
  const PetscInt Q = a->n * a->f;
  PetscReal *weight;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->n * a->count, &a->P));
  if (a->kind->type != CURVE_OPEN) {
    for (PetscInt k = 0; k < a->n; k++)
      for (PetscInt p = 0; p < a->count; p++)
        a->P[k * a->count + p] = a->weight[a->used[p] - a->f * k + (a->used[p] < a->f * k ? Q : 0)] / a->f;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscMalloc1(a->n, &weight));
  for (PetscInt p = 0; p < a->count; p++) {
    CurveOpenWeights(a->n, a->f, a->used[p], weight);
    for (PetscInt k = 0; k < a->n; k++) a->P[k * a->count + p] = weight[k] / a->f;
  }
  PetscCall(PetscFree(weight));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The points of a with a point of b in the window, and their rows of P. */
static PetscErrorCode Use(FineCurve *a, const FineCurve *b, PetscReal window) {
  const PetscInt Q = a->n * a->f;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < Q; p++)
    if (DistanceBelow(a->x + 2 * p, b, window) < window) a->used[a->count++] = p;
  PetscCall(Weigh(a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FineCurvePair(FineCurve *a, FineCurve *b, PetscReal window) {
  PetscFunctionBeginUser;
  PetscCall(Use(a, b, window));
  PetscCall(Use(b, a, window));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FineCurveProject(const FineCurve *a, const FineCurve *b, const PetscReal K[], PetscReal part[]) {
  PetscReal *half;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(a->n * b->count, &half));
  PetscCall(DenseProduct(PETSC_TRUE, a->n, b->count, a->count, a->P, K, half));
  PetscCall(DenseProduct(PETSC_FALSE, a->n, b->n, b->count, half, b->P, part));
  PetscCall(PetscFree(half));
  PetscFunctionReturn(PETSC_SUCCESS);
}
