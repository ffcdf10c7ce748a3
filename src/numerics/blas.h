/* Small dense matrices, columns contiguous, by LAPACK and BLAS. */
#pragma once
#include "base/base.h"
#include <petscblaslapack.h>

/* DenseFactor - LU factors of A (n x n) in place; factored is false when A is singular. */
PETSC_EXTERN PetscErrorCode DenseFactor(PetscInt n, PetscReal A[], PetscBLASInt pivot[], PetscBool *factored);

/* DenseSolve - X := A^-1 X or (transpose) A^-T X for the factored A, X of nrhs columns. */
PETSC_EXTERN PetscErrorCode DenseSolve(PetscInt n, const PetscReal A[], const PetscBLASInt pivot[], PetscBool transpose,
                                       PetscInt nrhs, PetscReal X[]);

/* DenseSingle - single[n] = x[n]. */
static inline void DenseSingle(PetscInt n, const PetscReal x[], float single[]) {
  for (PetscInt k = 0; k < n; k++) single[k] = (float)x[k];
}

/* DenseMultAdd - y += alpha A x, or (transpose) alpha A^T x, A (m x n). */
PETSC_EXTERN PetscErrorCode DenseMultAdd(PetscBool transpose, PetscInt m, PetscInt n, PetscReal alpha,
                                         const PetscReal A[], const PetscReal x[], PetscReal y[]);

/* DenseSingleMultAdd - y += alpha A x, or (transpose) alpha A^T x, in single precision. */
PETSC_EXTERN PetscErrorCode DenseSingleMultAdd(PetscBool transpose, PetscInt m, PetscInt n, float alpha,
                                               const float A[], const float x[], float y[]);

/* DenseProduct - C = A B, or (transpose) A^T B: C (m x n), B (k x n), A (m x k) or (k x m). */
PETSC_EXTERN PetscErrorCode DenseProduct(PetscBool transpose, PetscInt m, PetscInt n, PetscInt k, const PetscReal A[],
                                         const PetscReal B[], PetscReal C[]);

/* A matrix whose columns are `apart` numbers from one to the next: a part of a larger one. */
typedef struct {
  const PetscReal *a;
  PetscInt rows, columns, apart;
} DenseView;

/* DenseProductWithin - C = A B + beta C, or (transpose) A^T B + beta C, columns of C `apart` numbers from one to the
   next. */
PETSC_EXTERN PetscErrorCode DenseProductWithin(PetscBool transpose, DenseView A, DenseView B, PetscReal beta,
                                               PetscReal C[], PetscInt apart);

/* DenseGram - C[n][n] = A^T A, A (k x n). */
PETSC_EXTERN PetscErrorCode DenseGram(PetscInt n, PetscInt k, const PetscReal A[], PetscReal C[]);

/* DenseAddCirculant - A[2n][2n], columns lda apart, += a circulant map of n points that treats both components alike,
   by first[2n], what the map makes of a unit of the first component at point 0. Not collective. */
PETSC_EXTERN void DenseAddCirculant(PetscInt n, const PetscReal first[], PetscInt lda, PetscReal A[]);

/* DenseLeastSquares - the x of least |A x - b| for each of nrhs columns b of B, which its first n numbers become; A (m
   x n), m >= n, is work. singular[n], descending: its singular values; those up to `least` of the first count as 0. */
PETSC_EXTERN PetscErrorCode DenseLeastSquares(PetscInt m, PetscInt n, PetscReal A[], PetscInt nrhs, PetscReal B[],
                                              PetscReal least, PetscReal singular[]);

/* DenseEigen - eigenvalues l[n], ascending, of the symmetric A (n x n), whose columns become the eigenvectors. */
PETSC_EXTERN PetscErrorCode DenseEigen(PetscInt n, PetscReal A[], PetscReal l[]);
