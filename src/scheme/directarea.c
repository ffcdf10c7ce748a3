/* The area target in the matrix of the scheme direct (coupling/arearow.h): the part of a vesicle's motion along z is an
   unknown of its own, V + ... + z m = k, beside the row z.V = s, which gives the same V without full rows. */
#include "scheme/directrows.h"

PetscErrorCode DirectAddArea(DirectSolver d, Mat A, PetscInt U) {
  const Layout l = d->coupling->membrane->layout;
  const AreaRow r = d->coupling->area;
  PetscFunctionBeginUser;
  for (PetscInt v = l->own; v < l->end && r; v++)
    for (PetscInt k = 0; k < 2 * LayoutCount(l, v); k++) {
      const PetscReal z = r->z[2 * LayoutOffset(l, v) + k];
      const PetscInt row = U + 2 * l->start[v] + k, area = FirstArea(d) + v;
      PetscCall(MatSetValue(A, row, area, z, ADD_VALUES));
      PetscCall(MatSetValue(A, area, row, z, ADD_VALUES));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectAreaTarget(DirectSolver d) {
  const Layout l = d->coupling->membrane->layout;
  const AreaRow r = d->coupling->area;
  PetscFunctionBeginUser;
  if (!r) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = l->own; v < l->end; v++) PetscCall(VecSetValue(d->b, FirstArea(d) + v, r->speed[v], INSERT_VALUES));
  PetscCall(VecAssemblyBegin(d->b));
  PetscCall(VecAssemblyEnd(d->b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
