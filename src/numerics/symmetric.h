/* Symmetric matrices in single precision, one triangle of them, for preconditioners: a product reads every number once,
   in a fixed order. (OpenBLAS 0.3.21 has an ssymv for AVX2 after which its caller found wrong numbers.) */
#pragma once
#include "base/base.h"

#define SYMMETRIC_PANEL 4 /* columns that are stored, and taken, together: each from the panel's first row down */

/* SymmetricSize - numbers of a matrix (n x n). Not collective. */
static inline size_t SymmetricSize(PetscInt n) {
  size_t size = 0;
  for (PetscInt j = 0; j < n; j += SYMMETRIC_PANEL) size += SYMMETRIC_PANEL * (size_t)(n - j);
  return size;
}

/* SymmetricInvert - the inverse of A (n x n), in single precision; done is false when A is singular. Not collective. */
PETSC_EXTERN PetscErrorCode SymmetricInvert(PetscInt n, const PetscReal A[], float inverse[], PetscBool *done);

/* SymmetricPack - of A (n x n). SymmetricMult - y = A x. Not collective. */
PETSC_EXTERN void SymmetricPack(PetscInt n, const float A[], float packed[]);
PETSC_EXTERN void SymmetricMult(PetscInt n, const float packed[], const float x[], float y[]);
