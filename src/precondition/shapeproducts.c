/* The preconditioner's part of the vesicles: shapes' matrices on the columns of all vesicles that take them. */
#include "precondition/shapeset.h"

/* Columns of own vesicle v's numbers in the frame of its shape: U and, unless NULL, sigma behind it. Returns how many.
 */
static PetscInt IntoFrame(SharedShapes s, PetscInt v, const PetscScalar U[], const PetscScalar sigma[],
                          PetscReal column[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, v), at = LayoutOffset(l, v);
  RigidFitInto(&s->fit[v - l->own], 2, n, U + 2 * at, column);
  if (sigma) RigidFitInto(&s->fit[v - l->own], 1, n, sigma + at, column + 2 * n);
  return sigma ? 3 * n : 2 * n;
}

/* A matrix of a shape times the columns of the vesicles that take it: s->to. */
static void ShapeProduct(SharedShapes s, const SharedShape *q, const PackedMatrix *A, const PetscScalar U[],
                         const PetscScalar sigma[]) {
  PetscReal *x = s->from;
  PetscInt inner = 0;
  for (PetscInt k = q->begin; k < q->end; k++, x += inner) inner = IntoFrame(s, s->order[k], U, sigma, x);
  PackedMatrixProduct(A, inner, q->end - q->begin, s->from, s->to);
}

void SharedShapeSources(SharedShapes s, const SharedShape *q, const PetscScalar U[], const PetscScalar sigma[],
                        const ShapeSources *sources) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  const PetscReal *y = s->to;
  ShapeProduct(s, q, &q->sources, U, sigma);
  for (PetscInt k = q->begin; k < q->end; k++, y += PackedMatrixRows(&q->sources)) {
    const PetscInt v = s->order[k], at = 2 * LayoutOffset(l, v);
    RigidFitBack(&s->fit[v - l->own], 2, n, y, sources->force + at);
    if (q->sources.rows > 2 * n)
      RigidFitBack(&s->fit[v - l->own], 2, n, y + 2 * n, sources->jump + at);
    else if (sources->jump)
      (void)PetscArrayzero(sources->jump + at, 2 * n);
  }
}

void SharedShapeSolve(SharedShapes s, const SharedShape *q, PetscScalar U[], PetscScalar sigma[]) {
  const Layout l = s->coupling->membrane->layout;
  const PetscInt n = LayoutCount(l, q->like);
  const PetscReal *y = s->to;
  ShapeProduct(s, q, &q->inverse, U, sigma);
  for (PetscInt k = q->begin; k < q->end; k++, y += PackedMatrixRows(&q->inverse)) {
    const PetscInt v = s->order[k], at = LayoutOffset(l, v);
    RigidFitBack(&s->fit[v - l->own], 2, n, y, U + 2 * at);
    RigidFitBack(&s->fit[v - l->own], 1, n, y + 2 * n, sigma + at);
  }
}
