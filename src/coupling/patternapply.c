/* The preconditioner's part of the vesicles: patterns' matrices on the columns of all vesicles that take them. */
#include "coupling/blas.h"
#include "coupling/patterns.h"

/* y = x turned by the angle of cosine c and sine s, n pairs. */
static void Turn(PetscReal c, PetscReal s, PetscInt n, const PetscReal x[], PetscReal y[]) {
  for (PetscInt k = 0; k < n; k++) {
    y[2 * k] = c * x[2 * k] - s * x[2 * k + 1];
    y[2 * k + 1] = s * x[2 * k] + c * x[2 * k + 1];
  }
}

/* y = (U, sigma) of a vesicle in its pattern's frame. */
static void ToPattern(const Pose *p, PetscInt n, const PetscScalar U[], const PetscScalar sigma[], PetscReal y[]) {
  const PetscInt j = p->shift;
  Turn(p->turn[0], -p->turn[1], n - j, U + 2 * j, y);
  Turn(p->turn[0], -p->turn[1], j, U, y + 2 * (n - j));
  (void)PetscArraycpy(y + 2 * n, sigma + j, n - j);
  (void)PetscArraycpy(y + 3 * n - j, sigma, j);
}

/* And back: added to (U, sigma). */
static void AddFromPattern(const Pose *p, PetscInt n, const PetscReal y[], PetscScalar U[], PetscScalar sigma[]) {
  const PetscReal c = p->turn[0], s = p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = k + p->shift < n ? k + p->shift : k + p->shift - n;
    U[2 * at] += c * y[2 * k] - s * y[2 * k + 1];
    U[2 * at + 1] += s * y[2 * k] + c * y[2 * k + 1];
    sigma[at] += y[2 * n + k];
  }
}

static PetscInt Points(Patterns s, const Pattern *q) {
  return s->coarse ? LayoutCount(s->coarse->layout, q->like) : 0;
}

/* (U, sigma) := each vesicle's own answer, and its forces F at the coarse points. */
static PetscErrorCode First(Patterns s, const Pattern *q, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like), points = Points(s, q), rows = 3 * n + 2 * points;
  PetscReal *x = s->from, *y = s->to;
  PetscFunctionBeginUser;
  for (PetscInt k = q->begin; k < q->end; k++, x += 3 * n) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    ToPattern(&s->pose[v - l->own], n, U + 2 * at, sigma + at, x);
    PetscCall(PetscArrayzero(U + 2 * at, 2 * n));
    PetscCall(PetscArrayzero(sigma + at, n));
  }
  PetscCall(DenseProduct(PETSC_FALSE, rows, q->end - q->begin, 3 * n, q->first, s->from, s->to));
  for (PetscInt k = q->begin; k < q->end; k++, y += rows) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    const Pose *p = &s->pose[v - l->own];
    AddFromPattern(p, n, y, U + 2 * at, sigma + at);
    if (points) Turn(p->turn[0], p->turn[1], points, y + 3 * n, s->F + 2 * LayoutOffset(s->coarse->layout, v));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (U, sigma) += each vesicle's own answer to W, less what its own forces F have made of W. */
static PetscErrorCode Second(Patterns s, const Pattern *q, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout, coarse = s->coarse->layout;
  const PetscInt n = LayoutCount(l, q->like), points = Points(s, q), columns = q->end - q->begin;
  PetscReal *x = s->from, *y = s->to;
  PetscFunctionBeginUser;
  for (PetscInt k = q->begin; k < q->end; k++, x += 2 * points) {
    const Pose *p = &s->pose[s->order[k] - l->own];
    Turn(p->turn[0], -p->turn[1], points, s->F + 2 * LayoutOffset(coarse, s->order[k]), x);
  }
  PetscCall(DenseProduct(PETSC_FALSE, 2 * points, columns, 2 * points, q->self, s->from, s->to));
  x = s->from;
  for (PetscInt k = q->begin; k < q->end; k++, x += 2 * points) {
    const Pose *p = &s->pose[s->order[k] - l->own];
    Turn(p->turn[0], -p->turn[1], points, s->W + 2 * LayoutOffset(coarse, s->order[k]), x);
  }
  for (PetscInt i = 0; i < 2 * points * columns; i++) s->from[i] += s->to[i];
  PetscCall(DenseProduct(PETSC_FALSE, 3 * n, columns, 2 * points, q->second, s->from, s->to));
  for (PetscInt k = q->begin; k < q->end; k++, y += 3 * n) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    AddFromPattern(&s->pose[v - l->own], n, y, U + 2 * at, sigma + at);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternsSolve(Patterns s, PetscScalar U[], PetscScalar sigma[]) {
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->count; k++) PetscCall(First(s, &s->pattern[k], U, sigma));
  if (!s->coarse) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArraycpy(s->W, s->F, 2 * s->coarse->layout->n));
  PetscCall(CoarseApply(s->coarse, s->W));
  for (PetscInt k = 0; k < s->count; k++) PetscCall(Second(s, &s->pattern[k], U, sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}
