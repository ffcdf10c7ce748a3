/* Products with circulant matrices, which are the same sum at every point of a closed curve:

       sum_k = SUM_q weight_q x_{k - q},   indices modulo n.

   The points are laid out twice in a row, so that no index is taken modulo n. All functions work on one rank. */
#pragma once
#include "base/base.h"

/* CirculantConvolve - the sums of n entries of `each` numbers, or, with `ahead`, those of the transposed matrix, SUM_q
   weight_q x_{k + q}. twice[2 each n] has the entries two times, sum[each n]. Not collective. */
PETSC_EXTERN void CirculantConvolve(PetscInt n, int each, PetscBool ahead, const PetscReal weight[],
                                    const PetscReal twice[], PetscReal sum[]);
