#include "sphere/surface.h"
#include "numerics/blas.h"
#include "sphere/spherelayer.h"

/* C[columns_B][columns_A] = SUM over points of factor A B, A[columns_A][n], B[columns_B][n]. */
static PetscErrorCode SurfaceProduct(PetscInt n, const PetscReal factor[], DenseView A, DenseView B, PetscReal C[]) {
  PetscReal *scaled;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n * A.columns, &scaled));
  for (PetscInt k = 0; k < A.columns; k++)
    for (PetscInt i = 0; i < n; i++) scaled[k * n + i] = factor[i] * A.a[k * n + i];
  PetscCall(DenseProduct(PETSC_TRUE, A.columns, B.columns, n, scaled, B.a, C));
  PetscCall(PetscFree(scaled));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* C[columns][columns] = SUM over points of the grid's weight times A A, A[columns][n]. */
static PetscErrorCode SurfaceGram(Surface s, PetscInt columns, const PetscReal A[], PetscReal C[]) {
  PetscReal *scaled, *root;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->n * columns, &scaled, s->n, &root));
  for (PetscInt i = 0; i < s->n; i++) root[i] = PetscSqrtReal(s->sphere->fine.grid.weight[i]);
  for (PetscInt k = 0; k < columns; k++)
    for (PetscInt i = 0; i < s->n; i++) scaled[k * s->n + i] = root[i] * A[k * s->n + i];
  PetscCall(DenseGram(columns, s->n, scaled, C));
  PetscCall(PetscFree2(scaled, root));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static DenseView Columns(PetscInt n, PetscInt columns, const PetscReal a[]) {
  return (DenseView){.a = a, .rows = n, .columns = columns, .apart = n};
}

PetscErrorCode SurfaceGradient(Surface s, PetscReal g[]) {
  PetscFunctionBeginUser;
  PetscCall(SurfaceProduct(s->n, s->sphere->fine.grid.weight, Columns(s->n, 1, s->h),
                           Columns(s->n, s->sphere->size, s->dh), g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceBending(Surface s, PetscReal K[]) {
  PetscFunctionBeginUser;
  PetscCall(SurfaceGram(s, s->sphere->size, s->dh, K));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceAreaRows(Surface s, PetscReal A[]) {
  const PetscInt count = s->sphere->count;
  PetscFunctionBeginUser;
  PetscCall(SurfaceProduct(s->n, s->sphere->fine.grid.weight, Columns(s->n, count, s->sphere->fine.part[HARMONIC]),
                           Columns(s->n, s->sphere->size, s->dJ), A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfaceNormals(Surface s, PetscReal N[]) {
  PetscReal *normal;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->sphere->size * s->n, &normal));
  SurfaceCombine(s, HARMONIC, HARMONIC, s->normal, normal);
  PetscCall(SurfaceGram(s, s->sphere->size, normal, N));
  PetscCall(PetscFree(normal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* L[count][count] = INT max(sigma, 0) grad_s Y_k . grad_s Y_l dA. */
static PetscErrorCode SurfaceTensionGradients(Surface s, const PetscReal sigma[], PetscReal L[]) {
  const PetscInt n = s->n, count = s->sphere->count;
  const PetscReal *T = s->D[HARMONIC_T], *P = s->D[HARMONIC_P];
  PetscReal *at, *factor, *block;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(n, &at, 3 * n, &factor, count * count, &block));
  PetscCall(SphereTableValues(&s->sphere->fine, HARMONIC, count, 1, sigma, at));
  for (PetscInt i = 0; i < n; i++) {
    PetscReal E = 0, F = 0, G = 0;
    for (int d = 0; d < 3; d++) {
      E += T[d * n + i] * T[d * n + i];
      F += T[d * n + i] * P[d * n + i];
      G += P[d * n + i] * P[d * n + i];
    }
    const PetscReal a = s->sphere->fine.grid.weight[i] * s->J[i] * PetscMax(at[i], 0) / (E * G - F * F);
    factor[i] = a * G;
    factor[n + i] = -a * F;
    factor[2 * n + i] = a * E;
  }
  PetscCall(PetscArrayzero(L, count * count));
  for (int q = 0; q < 4; q++) {
    const DenseView A = Columns(n, count, s->sphere->fine.part[q / 2 ? HARMONIC_P : HARMONIC_T]),
                    B = Columns(n, count, s->sphere->fine.part[q % 2 ? HARMONIC_P : HARMONIC_T]);
    PetscCall(SurfaceProduct(n, factor + (q / 2 + q % 2) * n, A, B, block));
    for (PetscInt k = 0; k < count * count; k++) L[k] += block[k];
  }
  PetscCall(PetscFree3(at, factor, block));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SurfacePull(Surface s, const PetscReal sigma[], PetscReal K[]) {
  const PetscInt n = s->n, count = s->sphere->count, size = s->sphere->size;
  PetscReal *L, *normal, *projected, *LP;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc4(count * count, &L, size * n, &normal, size * count, &projected, size * count, &LP));
  PetscCall(SurfaceTensionGradients(s, sigma, L));
  SurfaceCombine(s, HARMONIC, HARMONIC, s->normal, normal);
  PetscCall(SurfaceProduct(n, s->sphere->fine.grid.weight, Columns(n, count, s->sphere->fine.part[HARMONIC]),
                           Columns(n, size, normal), projected));
  PetscCall(DenseProduct(PETSC_FALSE, count, size, count, L, projected, LP));
  PetscCall(DenseProduct(PETSC_TRUE, size, size, count, projected, LP, K));
  PetscCall(PetscFree4(L, normal, projected, LP));
  PetscFunctionReturn(PETSC_SUCCESS);
}
