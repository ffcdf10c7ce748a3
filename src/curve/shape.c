/* Curves as markers. */
#include "curve/curve.h"

PetscErrorCode ShapeDestroy(Shape *shape) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(shape->start));
  PetscCall(PetscFree(shape->X));
  PetscCall(PetscFree(shape->kind));
  shape->vesicles = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ShapeRadius(const Shape *shape, PetscInt v) {
  const PetscInt first = shape->start[v], n = shape->start[v + 1] - first;
  PetscReal length = 0;
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal *a = shape->X + 2 * (first + k), *b = shape->X + 2 * (first + (k + 1) % n);
    length += PetscSqrtReal(PetscSqr(b[0] - a[0]) + PetscSqr(b[1] - a[1]));
  }
  return length / (2 * PETSC_PI);
}

/* By the number of edges that a ray from (x, y) crosses. */
PetscBool ShapeHolds(const Shape *shape, PetscInt v, PetscReal x, PetscReal y) {
  const PetscInt M = shape->start[v + 1] - shape->start[v];
  const PetscReal *X = shape->X + 2 * shape->start[v];
  PetscBool inside = PETSC_FALSE;
  for (PetscInt k = 0, p = M - 1; k < M; p = k++)
    if ((X[2 * k + 1] > y) != (X[2 * p + 1] > y) &&
        x < (X[2 * p] - X[2 * k]) * (y - X[2 * k + 1]) / (X[2 * p + 1] - X[2 * k + 1]) + X[2 * k])
      inside = !inside;
  return inside;
}
