/* Products with rows of the near field's blocks. */
#pragma once
#include "base/lanes.h"

/* FourValues - from the k-th on, in single or in double precision. */
static inline Lanes FourValues(const PetscBool single, const void *value, size_t k) {
  const float *x = (const float *)value + k;
  return single ? (Lanes){x[0], x[1], x[2], x[3]} : LanesAt((const PetscReal *)value + k);
}

/* ApplyRows - of `rows` pairs of rows, one or two, each of `stride` numbers from the `at`-th on: their products with
   force[stride] times alpha, added to row_velocity[2 rows]; and with `both` what row_force[2 rows] does back, added to
   velocity[stride]. */
static inline void ApplyRows(const int rows, const PetscBool single, const void *value, size_t at, PetscInt stride,
                             PetscReal alpha, PetscBool both, const PetscScalar row_force[], const PetscScalar force[],
                             PetscScalar row_velocity[], PetscScalar velocity[]) {
  Lanes u[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt k = 0; k < stride; k += LANES) {
    const Lanes F = LanesAt(force + k);
    Lanes back = {0};
    for (int q = 0; q < 2 * rows; q++) {
      const Lanes c = FourValues(single, value, at + q * stride + k);
      u[q] += c * F;
      back += (alpha * row_force[q]) * c;
    }
    if (both) *(Lanes *)(velocity + k) += back;
  }
  for (int q = 0; q < 2 * rows; q++) row_velocity[q] += alpha * LanesSum(u[q]);
}
