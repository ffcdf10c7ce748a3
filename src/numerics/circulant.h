/* Products with circulant matrices, which are the same sum at every point of a closed curve:

       sum_k = SUM_q weight_q x_{k - q},   indices modulo n.

   The points are laid out more than once in a row, so that no index is taken modulo n, and a few vectors of sums are
   kept in registers while the weights pass by. All functions work on one rank. */
#pragma once
#include "base/base.h"

/* Numbers that an array of sums or of repeated points has behind its entries. */
#define CIRCULANT_PADDING 32

/* CirculantConvolve - the sums of n entries of `each` numbers, or, with `ahead`, those of the transposed matrix, SUM_q
   weight_q x_{k + q}. twice[2 each n + CIRCULANT_PADDING] has the entries two times, sum[each n + CIRCULANT_PADDING].
   Not collective. */
PETSC_EXTERN void CirculantConvolve(PetscInt n, int each, PetscBool ahead, const PetscReal weight[],
                                    const PetscReal twice[], PetscReal sum[]);
