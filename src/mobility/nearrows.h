/* Products with rows of blocks (nearblock.h, neardistant.h), each read once for the velocity of the row's markers and
   for what their forces do back,

       u += alpha C F,     v += alpha C^T G.

   Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"

/* FourValues - from the k-th on, in single or in double precision. */
static inline Lanes FourValues(const PetscBool single, const void *value, size_t k) {
  const float *x = (const float *)value + k;
  return single ? (Lanes){x[0], x[1], x[2], x[3]} : LanesAt((const PetscReal *)value + k);
}

/* Rows of a block, each of `stride` numbers, from the `at`-th of its values on. */
typedef struct {
  PetscBool single;
  const void *value;
  size_t at;
  PetscInt stride;
} BlockRows;

/* ApplyRows - the products of so many pairs of rows, one or two, with force[stride] times alpha, added to
   row_velocity[2 rows]; and, unless velocity[stride] is NULL, what row_force[2 rows] does back, added to it. */
static inline void ApplyRows(const int rows, const BlockRows r, PetscReal alpha, const PetscScalar row_force[],
                             const PetscScalar force[], PetscScalar row_velocity[], PetscScalar velocity[]) {
  Lanes u[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt k = 0; k < r.stride; k += LANES) {
    const Lanes F = LanesAt(force + k);
    Lanes back = {0};
    for (int q = 0; q < 2 * rows; q++) {
      const Lanes c = FourValues(r.single, r.value, r.at + q * r.stride + k);
      u[q] += c * F;
      back += (alpha * row_force[q]) * c;
    }
    if (velocity) *(Lanes *)(velocity + k) += back;
  }
  for (int q = 0; q < 2 * rows; q++) row_velocity[q] += alpha * LanesSum(u[q]);
}
