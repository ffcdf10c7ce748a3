/* Sums over the points of a curve, with the same weights at each of them: convolutions round n points. */
#pragma once
#include "base/base.h"

/* ConvolveRound - sum_k = SUM_q weight_q x_{k - q}, or (ahead) x_{k + q}, of n entries of `each` numbers round a curve,
   given twice[2 each n + CONVOLVE_ROUND], which has them twice; sum[each n + CONVOLVE_ROUND]. Not collective. */
#define CONVOLVE_ROUND 32
PETSC_EXTERN void ConvolveRound(PetscInt n, int each, PetscBool ahead, const PetscReal weight[],
                                const PetscReal twice[], PetscReal sum[]);

/* Weights that are odd or even, weight_{n-q} = -weight_q or weight_q: half of the products. */
typedef struct _p_RoundWeights *RoundWeights;

/* RoundWeightsCreate - of weight[n]. */
PETSC_EXTERN PetscErrorCode RoundWeightsCreate(PetscInt n, PetscBool odd, const PetscReal weight[], RoundWeights *w);
PETSC_EXTERN PetscErrorCode RoundWeightsDestroy(RoundWeights *w);

/* RoundRoom - how many numbers the points of such sums take. RoundUnroll - those of X[2n] less its first point, to
   points[RoundRoom]. RoundSums - sum[2n + CONVOLVE_ROUND], interlaced: sum_k = SUM_q weight_q x_{k-q}. Not collective.
 */
PETSC_EXTERN PetscInt RoundRoom(PetscInt n);
PETSC_EXTERN void RoundUnroll(PetscInt n, const PetscReal X[], PetscReal points[]);
PETSC_EXTERN void RoundSums(RoundWeights w, const PetscReal points[], PetscReal sum[]);
