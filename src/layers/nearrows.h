/* Products with rows of blocks (nearblock.h), each read once for the velocity of the row's markers and for what their
   forces do back,

       u += alpha C F,     v += alpha C^T G.

   Nothing crosses ranks. */
#pragma once
#include "base/lanes.h"
#include "layers/nearblock.h"

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
   row_velocity[2 rows]; and what row_force[2 rows] does back, added to velocity[stride]. Either is left out where its
   velocity is NULL. */
static inline void ApplyRows(const int rows, const BlockRows r, PetscReal alpha, const PetscScalar row_force[],
                             const PetscScalar force[], PetscScalar row_velocity[], PetscScalar velocity[]) {
  Lanes u[4] = {{0}, {0}, {0}, {0}};
  for (PetscInt k = 0; k < r.stride; k += LANES) {
    Lanes back = {0};
    for (int q = 0; q < 2 * rows; q++) {
      const Lanes c = FourValues(r.single, r.value, r.at + q * r.stride + k);
      if (row_velocity) u[q] += c * LanesAt(force + k);
      back += (alpha * row_force[q]) * c;
    }
    if (velocity) *(Lanes *)(velocity + k) += back;
  }
  for (int q = 0; q < 2 * rows && row_velocity; q++) row_velocity[q] += alpha * LanesSum(u[q]);
}

/* NearBlockMeets - whether a block has sources in columns and responses in rows, or the other way round; each a range
   of whole bodies. Not collective. */
static inline PetscBool MarkerRangeHolds(Layout l, PetscInt body, const MarkerRange *range) {
  return l->start[body] >= range->first && l->start[body] < range->first + range->n;
}
static inline PetscBool NearBlockMeets(Layout l, const NearBlock *b, const MarkerRange *rows,
                                       const MarkerRange *columns) {
  return (MarkerRangeHolds(l, b->row, rows) && MarkerRangeHolds(l, b->column, columns)) ||
         (MarkerRangeHolds(l, b->row, columns) && MarkerRangeHolds(l, b->column, rows));
}

/* NearBlockApply - velocity[2n] of own markers += alpha C source[2M] of one block, both ways where its kernel is
   symmetric and both bodies are own ones; with room for whole vectors behind both. NearBlockAdd - out += scale times a
   block, in the rows of own markers: from sources at the markers in columns to those in rows, each a range of whole
   bodies, out[2 n of columns][2 n of rows] with entries interlaced. Not collective. */
PETSC_EXTERN void NearBlockApply(Layout layout, const NearBlock *block, const NearStore *store, PetscReal alpha,
                                 const PetscScalar source[], PetscScalar velocity[]);
PETSC_EXTERN void NearBlockAdd(Layout layout, const NearBlock *block, const NearStore *store, PetscReal scale,
                               const MarkerRange *rows, const MarkerRange *columns, PetscReal out[]);
