/* Closed curves as markers. */
#include "curve/curve.h"

PetscErrorCode ShapeDestroy(Shape *shape) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(shape->start));
  PetscCall(PetscFree(shape->X));
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
