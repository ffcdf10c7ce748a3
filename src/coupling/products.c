#include "coupling/products.h"

PetscErrorCode ProductsNext(Products *q, Vec w, DM da, Vec x, PetscInt *place) {
  PetscFunctionBeginUser;
  *place = PetscMin(q->count, PRODUCTS_KEPT);
  q->count++;
  if (w && !q->w[*place]) {
    PetscCall(VecDuplicate(w, &q->w[*place]));
    PetscCall(DMCreateGlobalVector(da, &q->p[*place]));
  }
  if (*place == PRODUCTS_KEPT || q->z[*place]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDuplicate(x, &q->z[*place]));
  PetscCall(VecDuplicate(x, &q->Az[*place]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Least squares by modified Gram-Schmidt: x = SUM y_j z_j + rest, rest orthogonal to every z. The z are overwritten by
   an orthonormal basis q of them, z_j = SUM_{i <= j} upper_ij q_i. */
static PetscErrorCode Expand(PetscInt n, Vec z[], Vec rest, PetscReal y[]) {
  PetscReal upper[PRODUCTS_KEPT][PRODUCTS_KEPT];
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < n; j++) {
    for (PetscInt i = 0; i < j; i++) {
      PetscCall(VecDot(z[j], z[i], &upper[i][j]));
      PetscCall(VecAXPY(z[j], -upper[i][j], z[i]));
    }
    PetscCall(VecNormalize(z[j], &upper[j][j]));
    PetscCall(VecDot(rest, z[j], &y[j]));
    PetscCall(VecAXPY(rest, -y[j], z[j]));
  }
  for (PetscInt j = n - 1; j >= 0; j--) { /* y := upper^-1 y */
    for (PetscInt i = j + 1; i < n; i++) y[j] -= upper[j][i] * y[i];
    y[j] = upper[j][j] > 0 ? y[j] / upper[j][j] : 0;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The change x is a sum of the vectors z_j whose products have left their velocities and pressures behind: the same sum
   of those is what it changes on the grid. */
PetscErrorCode ProductsCombine(Products *q, Vec rest, Vec x, Vec w, Vec p, Vec residual) {
  PetscReal y[PRODUCTS_KEPT];
  PetscFunctionBeginUser;
  PetscCall(VecCopy(x, rest));
  PetscCall(Expand(q->count, q->z, rest, y));
  PetscCall(VecAXPY(x, -1, rest));
  if (q->w[0]) {
    PetscCall(VecMAXPY(w, q->count, y, q->w));
    PetscCall(VecMAXPY(p, q->count, y, q->p));
  }
  for (PetscInt j = 0; j < q->count; j++) PetscCall(VecAXPY(residual, -y[j], q->Az[j]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProductsDestroy(Products *q) {
  PetscFunctionBeginUser;
  for (int k = 0; k <= PRODUCTS_KEPT; k++) {
    PetscCall(VecDestroy(&q->w[k]));
    PetscCall(VecDestroy(&q->p[k]));
    if (k == PRODUCTS_KEPT) break;
    PetscCall(VecDestroy(&q->z[k]));
    PetscCall(VecDestroy(&q->Az[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
