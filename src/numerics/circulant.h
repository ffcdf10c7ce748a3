/* Products with circulant matrices, which are the same sum at every point of a closed curve:

       sum_k = SUM_q weight_q x_{k - q},   indices modulo n.

   The points are laid out more than once in a row, so that no index is taken modulo n, and a few vectors of sums are
   kept in registers while the weights pass by. Where weights are odd or even in q, as those of derivatives are, the
   sums

       sum_k = SUM_q weight_q (x_{k - q} -+ x_{k + q}),   q <= n/2,

   take half of the products. All functions work on one rank. */
#pragma once
#include "base/base.h"

/* Numbers that an array of sums or of unrolled points has behind its entries. */
#define CIRCULANT_PADDING 32

/* CirculantConvolve - the sums of n entries of `each` numbers, or, with `ahead`, those of the transposed matrix, SUM_q
   weight_q x_{k + q}. twice[2 each n + CIRCULANT_PADDING] has the entries two times, sum[each n + CIRCULANT_PADDING].
   Not collective. */
PETSC_EXTERN void CirculantConvolve(PetscInt n, int each, PetscBool ahead, const PetscReal weight[],
                                    const PetscReal twice[], PetscReal sum[]);

/* Weights that are odd, weight_{n-q} = -weight_q, or even, weight_{n-q} = weight_q. */
typedef struct _p_CirculantWeights *CirculantWeights;

/* CirculantWeightsCreate - of weight[n]. Not collective. */
PETSC_EXTERN PetscErrorCode CirculantWeightsCreate(PetscInt n, PetscBool odd, const PetscReal weight[],
                                                   CirculantWeights *w);
PETSC_EXTERN PetscErrorCode CirculantWeightsDestroy(CirculantWeights *w);

/* CirculantRoom - numbers that unrolled points take. CirculantUnroll - points[CirculantRoom(n)] of X[2n] less its first
   point. CirculantSums - sum[2n + CIRCULANT_PADDING], interlaced. Not collective. */
PETSC_EXTERN PetscInt CirculantRoom(PetscInt n);
PETSC_EXTERN void CirculantUnroll(PetscInt n, const PetscReal X[], PetscReal points[]);
PETSC_EXTERN void CirculantSums(CirculantWeights w, const PetscReal points[], PetscReal sum[]);
