/* The preconditioner's part of the vesicles: shapes' matrices on the columns of all vesicles that take them. */
#include "precondition/shapeset.h"

/* (U, sigma) += y, back from the shape's frame. */
static void AddFromShape(const RigidFit *p, PetscInt n, const PetscReal y[], PetscScalar U[], PetscScalar sigma[]) {
  const PetscReal c = p->turn[0], s = p->turn[1];
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt at = k + p->shift < n ? k + p->shift : k + p->shift - n;
    U[2 * at] += c * y[2 * k] - s * y[2 * k + 1];
    U[2 * at + 1] += s * y[2 * k] + c * y[2 * k + 1];
    sigma[at] += y[2 * n + k];
  }
}

/* Columns W of the vesicles that take a shape, in its frame, to s->from, `each` numbers apart. */
static void GatherShapeColumns(SharedShapes s, const SharedShape *q, PetscInt each, const PetscScalar W[]) {
  const Layout l = s->coupling->membrane->layout;
  PetscReal *x = s->from;
  for (PetscInt k = q->begin; k < q->end; k++, x += each) {
    const PetscInt v = s->order[k];
    RigidFitInto(&s->fit[v - l->own], 2, LayoutCount(l, v), W + 2 * LayoutOffset(l, v), x);
  }
}

/* F and J of each vesicle, from the columns gathered. */
static void FindSources(SharedShapes s, const SharedShape *q, PetscInt inner, const ShapeSources *sources) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  const PetscReal *y = s->to;
  PackedMatrixProduct(&q->sources, inner, q->end - q->begin, s->from, s->to);
  for (PetscInt k = q->begin; k < q->end; k++, y += PackedMatrixRows(&q->sources)) {
    const PetscInt v = s->order[k], at = 2 * LayoutOffset(l, v);
    RigidFitBack(&s->fit[v - l->own], 2, n, y, sources->force + at);
    if (q->sources.rows > 2 * n)
      RigidFitBack(&s->fit[v - l->own], 2, n, y + 2 * n, sources->jump + at);
    else if (sources->jump)
      (void)PetscArrayzero(sources->jump + at, 2 * n);
  }
}

/* (V, sigma) of each vesicle, added. */
static void AddAnswers(SharedShapes s, const SharedShape *q, PetscInt inner, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscReal *y = s->to;
  PackedMatrixProduct(&q->inverse, inner, q->end - q->begin, s->from, s->to);
  for (PetscInt k = q->begin; k < q->end; k++, y += PackedMatrixRows(&q->inverse)) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    AddFromShape(&s->fit[v - l->own], LayoutCount(l, v), y, U + 2 * at, sigma + at);
  }
}

void SharedShapeSolveAlone(SharedShapes s, const SharedShape *q, PetscScalar U[], PetscScalar sigma[],
                           const ShapeSources *sources) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  PetscReal *x = s->from + 2 * n;
  GatherShapeColumns(s, q, 3 * n, U);
  for (PetscInt k = q->begin; k < q->end; k++, x += 3 * n) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    RigidFitInto(&s->fit[v - l->own], 1, n, sigma + at, x);
    (void)PetscArrayzero(U + 2 * at, 2 * n);
    (void)PetscArrayzero(sigma + at, n);
  }
  AddAnswers(s, q, 3 * n, U, sigma);
  if (sources) FindSources(s, q, 3 * n, sources);
}

void SharedShapeSources(SharedShapes s, const SharedShape *q, const PetscScalar W[], const ShapeSources *sources) {
  const PetscInt inner = 2 * LayoutCount(s->coupling->membrane->layout, q->like);
  GatherShapeColumns(s, q, inner, W);
  FindSources(s, q, inner, sources);
}

void SharedShapeAddAnswer(SharedShapes s, const SharedShape *q, const PetscScalar W[], PetscScalar U[],
                          PetscScalar sigma[]) {
  const PetscInt inner = 2 * LayoutCount(s->coupling->membrane->layout, q->like);
  GatherShapeColumns(s, q, inner, W);
  AddAnswers(s, q, inner, U, sigma);
}
