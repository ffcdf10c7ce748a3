/* The preconditioner's part of the vesicles: patterns' matrices on the columns of all vesicles that take them. */
#include "coupling/blas.h"
#include "coupling/patternapply.h"

void PoseTurn(const Pose *p, PetscBool back, PetscInt n, const PetscReal x[], PetscReal y[]) {
  const PetscReal c = p->turn[0], s = back ? -p->turn[1] : p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    y[2 * k] = c * x[2 * k] - s * x[2 * k + 1];
    y[2 * k + 1] = s * x[2 * k] + c * x[2 * k + 1];
  }
}

/* y = the velocities or forces U of a vesicle's n markers in its pattern's frame. */
static void ToPattern(const Pose *p, PetscInt n, const PetscScalar U[], PetscReal y[]) {
  const PetscInt j = p->shift;
  PoseTurn(p, PETSC_TRUE, n - j, U + 2 * j, y);
  PoseTurn(p, PETSC_TRUE, j, U, y + 2 * (n - j));
}

/* And back. */
static void FromPattern(const Pose *p, PetscInt n, const PetscReal y[], PetscScalar U[]) {
  const PetscInt j = p->shift;
  PoseTurn(p, PETSC_FALSE, n - j, y, U + 2 * j);
  PoseTurn(p, PETSC_FALSE, j, y + 2 * (n - j), U);
}

/* (U, sigma) += y, back from the pattern's frame. */
static void AddFromPattern(const Pose *p, PetscInt n, const PetscReal y[], PetscScalar U[], PetscScalar sigma[]) {
  const PetscReal c = p->turn[0], s = p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = k + p->shift < n ? k + p->shift : k + p->shift - n;
    U[2 * at] += c * y[2 * k] - s * y[2 * k + 1];
    U[2 * at + 1] += s * y[2 * k] + c * y[2 * k + 1];
    sigma[at] += y[2 * n + k];
  }
}

/* Columns W of the vesicles that take a pattern, in its frame, to s->from, `each` numbers apart. */
static void GatherColumns(Patterns s, const Pattern *q, PetscInt each, const PetscScalar W[]) {
  const Layout l = s->coupling->membrane->layout;
  PetscReal *x = s->from;
  for (PetscInt k = q->begin; k < q->end; k++, x += each) {
    const PetscInt v = s->order[k];
    ToPattern(&s->pose[v - l->own], LayoutCount(l, v), W + 2 * LayoutOffset(l, v), x);
  }
}

/* A vesicle's numbers in a column of a product that is `each` numbers long, from the `at`-th on, to F. */
static void ScatterForces(Patterns s, const Pattern *q, PetscInt each, PetscInt at, PetscScalar F[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscReal *y = s->to + at;
  for (PetscInt k = q->begin; k < q->end; k++, y += each) {
    const PetscInt v = s->order[k];
    FromPattern(&s->pose[v - l->own], LayoutCount(l, v), y, F + 2 * LayoutOffset(l, v));
  }
}

/* The same of (V, sigma), added. */
static void AddAnswers(Patterns s, const Pattern *q, PetscInt each, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscReal *y = s->to;
  for (PetscInt k = q->begin; k < q->end; k++, y += each) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    AddFromPattern(&s->pose[v - l->own], LayoutCount(l, v), y, U + 2 * at, sigma + at);
  }
}

PetscErrorCode PatternSolveAlone(Patterns s, const Pattern *q, PetscScalar U[], PetscScalar sigma[], PetscScalar F[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like), rows = F ? 5 * n : 3 * n;
  PetscReal *x = s->from + 2 * n;
  PetscFunctionBeginUser;
  GatherColumns(s, q, 3 * n, U);
  for (PetscInt k = q->begin; k < q->end; k++, x += 3 * n) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v), shift = s->pose[v - l->own].shift;
    PetscCall(PetscArraycpy(x, sigma + at + shift, n - shift));
    PetscCall(PetscArraycpy(x + n - shift, sigma + at, shift));
    PetscCall(PetscArrayzero(U + 2 * at, 2 * n));
    PetscCall(PetscArrayzero(sigma + at, n));
  }
  PetscCall(DensePartProduct(rows, q->end - q->begin, 3 * n, q->inverse, 5 * n, s->from, s->to));
  AddAnswers(s, q, rows, U, sigma);
  if (F) ScatterForces(s, q, rows, 3 * n, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternForces(Patterns s, const Pattern *q, const PetscScalar W[], PetscScalar F[]) {
  const PetscInt n = LayoutCount(s->coupling->membrane->layout, q->like);
  PetscFunctionBeginUser;
  GatherColumns(s, q, 2 * n, W);
  PetscCall(DensePartProduct(2 * n, q->end - q->begin, 2 * n, q->inverse + 3 * n, 5 * n, s->from, s->to));
  ScatterForces(s, q, 2 * n, 0, F);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PatternAddAnswer(Patterns s, const Pattern *q, const PetscScalar W[], PetscScalar U[],
                                PetscScalar sigma[]) {
  const PetscInt n = LayoutCount(s->coupling->membrane->layout, q->like);
  PetscFunctionBeginUser;
  GatherColumns(s, q, 2 * n, W);
  PetscCall(DensePartProduct(3 * n, q->end - q->begin, 2 * n, q->inverse, 5 * n, s->from, s->to));
  AddAnswers(s, q, 3 * n, U, sigma);
  PetscFunctionReturn(PETSC_SUCCESS);
}
