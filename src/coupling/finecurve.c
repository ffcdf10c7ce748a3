#include "coupling/finecurve.h"
#include "coupling/blas.h"
#include "curve/spectral.h"

PetscErrorCode FineCurveCreate(NearField f, PetscInt v, const PetscReal shift[2], PetscInt factor, FineCurve *c) {
  const PetscInt n = LayoutCount(f->membrane->layout, v), Q = n * factor;
  const PetscReal *X = f->markers->X + 2 * f->membrane->layout->start[v];
  PetscFunctionBeginUser;
  *c = (FineCurve){.n = n, .f = factor};
  PetscCall(PetscMalloc3(Q, &c->weight, 2 * Q, &c->x, Q, &c->used));
  for (PetscInt q = 0; q < Q; q++) c->weight[q] = TrigonometricCardinal(n, 2 * PETSC_PI * q / Q);
  for (PetscInt q = 0; q < Q; q++)
    for (int d = 0; d < 2; d++) {
      PetscReal sum = shift[d];
      for (PetscInt k = 0; k < n; k++) sum += c->weight[((q - factor * k) % Q + Q) % Q] * X[2 * k + d];
      c->x[2 * q + d] = sum;
    }
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

static PetscReal Distance2(const PetscReal a[2], const PetscReal b[2]) {
  return PetscSqr(a[0] - b[0]) + PetscSqr(a[1] - b[1]);
}

PetscReal FineCurveGap(const FineCurve *a, const FineCurve *b) {
  PetscReal least = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < a->n * a->f; p++)
    for (PetscInt q = 0; q < b->n * b->f; q++) least = PetscMin(least, Distance2(a->x + 2 * p, b->x + 2 * q));
  return PetscSqrtReal(least);
}

/* The points of a with a point of b in the window, and their rows of P. */
static PetscErrorCode Use(FineCurve *a, const FineCurve *b, PetscReal window) {
  const PetscInt Q = a->n * a->f;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < Q; p++)
    for (PetscInt q = 0; q < b->n * b->f; q++)
      if (Distance2(a->x + 2 * p, b->x + 2 * q) < window * window) {
        a->used[a->count++] = p;
        break;
      }
  PetscCall(PetscMalloc1(a->n * a->count, &a->P));
  for (PetscInt k = 0; k < a->n; k++)
    for (PetscInt p = 0; p < a->count; p++)
      a->P[k * a->count + p] = a->weight[((a->used[p] - a->f * k) % Q + Q) % Q] / a->f;
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
