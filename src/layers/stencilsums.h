/* Sums over the faces of two stencils, of a function of the offset of two faces that is tabulated,

       SUM_i SUM_j phi(i) G(i - j) psi(j),

   phi the response's weights and psi the source's, each a product of weights along x and along y. Along one direction
   the sum depends on the lag i - j alone, so the weights of the lags come first, then one product with the table.
   Nothing crosses ranks. */
#pragma once
#include "markers/markers.h"

#define OFFSET_LAGS (2 * KERNEL_MAX_POINTS) /* offsets of two kernels, one spare: whole vectors */

/* Velocity per unit force between faces by their offset in cells, response minus source, in a window [-size[1] ..
   size[1]] x [-size[0] .. size[0]], x fastest: response u to a source u, v to v, v to u. */
typedef enum { OFFSET_UU, OFFSET_VV, OFFSET_VU, OFFSET_COUNT } OffsetBlock;
typedef struct {
  PetscInt size[2];
  PetscReal *value[OFFSET_COUNT]; /* NULL: empty */
} OffsetTable;

/* OffsetTableCreate - zero tables of these half widths. */
PETSC_EXTERN PetscErrorCode OffsetTableCreate(const PetscInt size[2], OffsetTable *table);
PETSC_EXTERN PetscErrorCode OffsetTableDestroy(OffsetTable *table);

/* OffsetTableTurn - in a square box the block v to v is the block u to u turned by 90 degrees. Not collective. */
PETSC_EXTERN void OffsetTableTurn(OffsetTable *table);

/* OffsetAt - the entry at an offset within the table. */
static inline PetscReal OffsetAt(const OffsetTable *t, int block, PetscInt i, PetscInt j) {
  return t->value[block][(j + t->size[1]) * (2 * t->size[0] + 1) + i + t->size[0]];
}

/* A stencil's weights in one direction between zeros, so that sums run over whole vectors. */
typedef struct {
  PetscReal weight[2][3 * KERNEL_MAX_POINTS];
  PetscReal fourth[2]; /* moment about its place: SUM w_i (i - SUM w_j j)^4 */
  PetscInt first[2], n[2];
} PaddedStencil;

/* StencilPad - of a stencil. StencilLagWeights - along one direction a double sum depends on the lag of two entries
   only: weight[q] = SUM_j a_{q+j} b_j of the lag first + q; returns first. Not collective. */
PETSC_EXTERN void StencilPad(const Stencil *stencil, PaddedStencil *padded);
PETSC_EXTERN PetscInt StencilLagWeights(int dir, const PaddedStencil *response, const PaddedStencil *source,
                                        PetscReal weight[OFFSET_LAGS]);

/* StencilUnwrap - the two components' stencils of a marker at X count from its own place, however many periods that is
   from the grid. StencilFourSums - the sums of markers a and b, so unwrapped, `cells` being added to the offset: xx,
   yy, xy (x of a to a force along y of b), yx. Far within the table. Not collective.
   StencilDipoleSums - the sums of a marker's u and v (points 5 x 4 and 4 x 5, those of cbs54) and of a dipole's parts
   xx, yy, xy (6 x 4, 4 x 6, 5 x 5) at another, tables of the same size. Not collective. */
PETSC_EXTERN void StencilUnwrap(Grid grid, const PetscReal X[2], PaddedStencil stencil[2]);
PETSC_EXTERN void StencilFourSums(const OffsetTable *table, const PaddedStencil a[2], const PaddedStencil b[2],
                                  const PetscInt cells[2], PetscReal sum[4]);
PETSC_EXTERN void StencilDipoleSums(const OffsetTable table[2], const PaddedStencil response[2],
                                    const PaddedStencil dipole[3], const PetscInt cells[2], PetscReal sum[2][3]);

/* Where a sum starts in a table: a block, and what is added to the offset. */
typedef struct {
  const OffsetTable *table;
  OffsetBlock block;
  PetscInt cells[2];
} OffsetEntry;

/* StencilRowAdd - sum[i] += factor times the entry's double sum of the response moved by i cells along x, i = 0 .. n -
   1, n at most STENCIL_ROW. Far within the table. Not collective. */
#define STENCIL_ROW 48
PETSC_EXTERN void StencilRowAdd(const OffsetEntry *entry, const PaddedStencil *response, const PaddedStencil *source,
                                PetscReal factor, PetscInt n, PetscReal sum[]);
