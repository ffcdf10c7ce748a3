#include "numerics/blas.h"

/* Divide and conquer, which PETSc does not declare. */
#define LAPACKsyevd_ PETSCBLAS(syevd, SYEVD)
BLAS_EXTERN void LAPACKsyevd_(const char *, const char *, const PetscBLASInt *, PetscReal *, const PetscBLASInt *,
                              PetscReal *, PetscReal *, const PetscBLASInt *, PetscBLASInt *, const PetscBLASInt *,
                              PetscBLASInt *);

PetscErrorCode DenseFactor(PetscInt n, PetscReal A[], PetscBLASInt pivot[], PetscBool *factored) {
  PetscBLASInt size, info;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCallBLAS("LAPACKgetrf", LAPACKgetrf_(&size, &size, A, &size, pivot, &info));
  *factored = info ? PETSC_FALSE : PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseSolve(PetscInt n, const PetscReal A[], const PetscBLASInt pivot[], PetscBool transpose,
                          PetscInt nrhs, PetscReal X[]) {
  PetscBLASInt size, columns, info;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(nrhs, &columns));
  PetscCallBLAS("LAPACKgetrs", LAPACKgetrs_(transpose ? "T" : "N", &size, &columns, (PetscReal *)A, &size,
                                            (PetscBLASInt *)pivot, X, &size, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* PETSc names the routines of its own precision only. */
extern void sgemv_(const char *, const PetscBLASInt *, const PetscBLASInt *, const float *, const float *,
                   const PetscBLASInt *, const float *, const PetscBLASInt *, const float *, float *,
                   const PetscBLASInt *);

PetscErrorCode DenseSingleMultAdd(PetscBool transpose, PetscInt m, PetscInt n, float alpha, const float A[],
                                  const float x[], float y[]) {
  PetscBLASInt rows, columns;
  const PetscBLASInt step = 1;
  const float one = 1;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(m, &rows));
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCallBLAS("sgemv", sgemv_(transpose ? "T" : "N", &rows, &columns, &alpha, A, &rows, x, &step, &one, y, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseMultAdd(PetscBool transpose, PetscInt m, PetscInt n, PetscReal alpha, const PetscReal A[],
                            const PetscReal x[], PetscReal y[]) {
  PetscBLASInt rows, columns;
  const PetscBLASInt step = 1;
  const PetscReal one = 1;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(m, &rows));
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCallBLAS("BLASgemv",
                BLASgemv_(transpose ? "T" : "N", &rows, &columns, &alpha, A, &rows, x, &step, &one, y, &step));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseProductWithin(PetscBool transpose, DenseView A, DenseView B, PetscReal beta, PetscReal C[],
                                  PetscInt apart) {
  const PetscInt m = transpose ? A.columns : A.rows;
  const PetscInt sizes[] = {m, B.columns, B.rows, PetscMax(1, A.apart), PetscMax(1, B.apart), PetscMax(1, apart)};
  const PetscReal one = 1;
  PetscBLASInt size[6];
  PetscFunctionBeginUser;
  if (!m || !B.columns) PetscFunctionReturn(PETSC_SUCCESS);
  for (int q = 0; q < 6; q++) PetscCall(PetscBLASIntCast(sizes[q], &size[q]));
  PetscCallBLAS("BLASgemm", BLASgemm_(transpose ? "T" : "N", "N", &size[0], &size[1], &size[2], &one, A.a, &size[3],
                                      B.a, &size[4], &beta, C, &size[5]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseProduct(PetscBool transpose, PetscInt m, PetscInt n, PetscInt k, const PetscReal A[],
                            const PetscReal B[], PetscReal C[]) {
  const PetscInt rows = transpose ? k : m;
  PetscFunctionBeginUser;
  PetscCall(
      DenseProductWithin(transpose, (DenseView){A, rows, transpose ? m : k, rows}, (DenseView){B, k, n, k}, 0, C, m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseGram(PetscInt n, PetscInt k, const PetscReal A[], PetscReal C[]) {
  const PetscReal one = 1, zero = 0;
  PetscBLASInt columns, rows;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCall(PetscBLASIntCast(k, &rows));
  PetscCallBLAS("BLASsyrk", BLASsyrk_("U", "T", &columns, &rows, &one, A, &rows, &zero, C, &columns));
  for (PetscInt l = 0; l < n; l++)
    for (PetscInt m = 0; m < l; m++) C[m * n + l] = C[l * n + m];
  PetscFunctionReturn(PETSC_SUCCESS);
}

void DenseAddCirculant(PetscInt n, const PetscReal first[], PetscInt lda, PetscReal A[]) {
  for (PetscInt j = 0; j < n; j++)
    for (PetscInt k = 0; k < n; k++)
      for (int c = 0; c < 2; c++) A[(2 * j + c) * lda + 2 * k + c] += first[2 * (k < j ? k - j + n : k - j)];
}

PetscErrorCode DenseLeastSquares(PetscInt m, PetscInt n, PetscReal A[], PetscInt nrhs, PetscReal B[], PetscReal least,
                                 PetscReal singular[]) {
  PetscBLASInt rows, columns, sides, room, rank, info;
  PetscReal *work;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(m, &rows));
  PetscCall(PetscBLASIntCast(n, &columns));
  PetscCall(PetscBLASIntCast(nrhs, &sides));
  PetscCall(PetscBLASIntCast(8 * (m + n), &room));
  PetscCall(PetscMalloc1(room, &work));
  PetscCallBLAS("LAPACKgelss",
                LAPACKgelss_(&rows, &columns, &sides, A, &rows, B, &rows, singular, &least, &rank, work, &room, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "LAPACK's gelss failed: %d", (int)info);
  PetscCall(PetscFree(work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DenseEigen(PetscInt n, PetscReal A[], PetscReal l[]) {
  PetscBLASInt size, room, integers, info, *iwork;
  PetscReal *work;
  PetscFunctionBeginUser;
  PetscCall(PetscBLASIntCast(n, &size));
  PetscCall(PetscBLASIntCast(1 + 6 * n + 2 * n * n, &room)); /* as LAPACK wants it, at least */
  PetscCall(PetscBLASIntCast(3 + 5 * n, &integers));
  PetscCall(PetscMalloc2(room, &work, integers, &iwork));
  PetscCallBLAS("LAPACKsyevd", LAPACKsyevd_("V", "L", &size, A, &size, l, work, &room, iwork, &integers, &info));
  PetscCheck(!info, PETSC_COMM_SELF, PETSC_ERR_LIB, "eigenvalues of a matrix of %d rows: LAPACK says %d", (int)n,
             (int)info);
  PetscCall(PetscFree2(work, iwork));
  PetscFunctionReturn(PETSC_SUCCESS);
}
