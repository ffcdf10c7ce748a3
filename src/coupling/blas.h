/* Small dense matrices, columns contiguous, by LAPACK and BLAS. */
#pragma once
#include "base/base.h"
#include <petscblaslapack.h>

/* DenseFactor - LU factors of A (n x n) in place; factored is false when A is singular. */
PETSC_EXTERN PetscErrorCode DenseFactor(PetscInt n, PetscReal A[], PetscBLASInt pivot[], PetscBool *factored);

/* DenseSolve - X := A^-1 X or (transpose) A^-T X for the factored A, X of nrhs columns. */
PETSC_EXTERN PetscErrorCode DenseSolve(PetscInt n, const PetscReal A[], const PetscBLASInt pivot[], PetscBool transpose,
                                       PetscInt nrhs, PetscReal X[]);

/* DenseSolveSingle - X := A^-1 X for the factored A in single precision, which takes half the time; X of nrhs columns,
   in double. */
PETSC_EXTERN PetscErrorCode DenseSolveSingle(PetscInt n, const float A[], const PetscBLASInt pivot[], PetscInt nrhs,
                                             PetscReal X[]);

/* DenseMultAdd - y += alpha A x, or (transpose) alpha A^T x, A (m x n). */
PETSC_EXTERN PetscErrorCode DenseMultAdd(PetscBool transpose, PetscInt m, PetscInt n, PetscReal alpha,
                                         const PetscReal A[], const PetscReal x[], PetscReal y[]);

/* DenseProduct - C = A B, or (transpose) A^T B: C (m x n), B (k x n), A (m x k) or (k x m). */
PETSC_EXTERN PetscErrorCode DenseProduct(PetscBool transpose, PetscInt m, PetscInt n, PetscInt k, const PetscReal A[],
                                         const PetscReal B[], PetscReal C[]);

/* DenseEigen - eigenvalues l[n], ascending, of the symmetric A (n x n), whose columns become the eigenvectors. */
PETSC_EXTERN PetscErrorCode DenseEigen(PetscInt n, PetscReal A[], PetscReal l[]);
