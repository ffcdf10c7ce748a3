/* Short sine and cosine transforms as products with their orthonormal matrices: to SINE_MATRIX_MOST entries these take
   fewer instructions than FFTW's, which allocate memory in each. */
#pragma once
#include "base/base.h"

#define SINE_MATRIX_MOST 48

/* Entry j of row i of a symmetric pair: sines between walls on the entries (before the first and after the last), or
   sines or cosines of half samples. */
typedef enum { SINE_MATRIX_ENTRIES, SINE_MATRIX_HALF_SINES, SINE_MATRIX_HALF_COSINES } SineMatrixKind;

typedef struct {
  PetscInt n, stride;   /* entries, as many modes; numbers from row to row, the rows' ends are zeros */
  PetscReal *matrix[2]; /* forward and backward, its transpose; NULL where there is none */
} SineMatrix;

/* SineMatrixCreate - of n entries, orthonormal; none where they are too many. SineMatrixWave - modes
   k = 0 .. n - 1 are waves of phase pi SineMatrixWave(kind, n, k) per entry. Not collective. */
PETSC_EXTERN PetscErrorCode SineMatrixCreate(SineMatrixKind kind, PetscInt n, SineMatrix *m);
PETSC_EXTERN PetscErrorCode SineMatrixDestroy(SineMatrix *m);
PETSC_EXTERN PetscReal SineMatrixWave(SineMatrixKind kind, PetscInt n, PetscInt k);

/* SineMatrixApply - y[n] = the transform of x[n], another array; way: 0 forward, 1 backward. Not collective. */
PETSC_EXTERN void SineMatrixApply(const SineMatrix *m, int way, const PetscReal x[], PetscReal y[]);
