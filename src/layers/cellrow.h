/* Fields at the centres of cells next to a membrane, where the grid's velocity and pressure are smoothed by the
   regularised delta function: the exact layer there, less what the lattice has of it,

       u += u_exact - SUM_k u_lattice,k,

   at cells within some h of a marker, in unbounded fluid u_exact at all cells. The lattice's part of a marker is a sum
   over its stencil at cells near it, which is taken for all cells of a row at once, and a closed form at others.
   Indices of cells go beyond the grid where it is periodic. Every rank corrects its own rows; nothing crosses ranks.

   For each vesicle: CellRowBegin, then CellRowCorrect. */
#pragma once
#include "base/lanes.h"
#include "layers/stencilsums.h"

typedef struct {
  Grid grid;               /* borrowed */
  PetscInt n;              /* markers of the vesicle */
  const PetscReal *X;      /* [2n] and whole vectors, borrowed */
  PetscReal reach;         /* of the correction (length) */
  PetscInt box[2][2];      /* cells from box[dir][0] to box[dir][1] hold the vesicle and all within reach of it */
  PetscInt from, to;       /* of the row's cells along x that are corrected the first and the last one */
  PetscReal *first, *last; /* [n] cells that are near each marker; whole vectors */
  PetscReal *sum[3];       /* [cells] of u, v and p, from the cell `from` on */
} CellRow;

/* CellRowBegin - of n markers X[2n]; false if no cell near them is of this rank. Not collective. */
PETSC_EXTERN PetscBool CellRowBegin(Grid grid, PetscInt n, const PetscReal X[], PetscReal reach, CellRow *row);

/* A layer's part of a correction. `lattice` takes what the lattice has of marker k off `count` cells from cell[2] on:
   of u, v and p at sum[3]. `exact` adds the layer at x, the centre of cell i of the row and number `at` of this rank's
   cells, less that of markers which are not near the cell (CellRowDistant); it is asked of cells that are not
   corrected, too. */
typedef struct {
  void *context;
  PetscInt summed; /* cells from a marker up to which they are near it; less than STENCIL_ROW/2 */
  void (*lattice)(void *context, PetscInt k, const PetscInt cell[2], PetscInt count, PetscReal *const sum[3]);
  void (*exact)(void *context, const CellRow *row, PetscInt i, const PetscReal x[2], PetscBool corrected, PetscInt at,
                PetscReal found[3]);
} CellLayer;

/* CellRowCorrect - all rows of a vesicle: u, v and p at this rank's cell centres, [rows][nx] each, NULL for those not
   wanted. Not collective. */
PETSC_EXTERN PetscErrorCode CellRowCorrect(CellRow *row, const CellLayer *layer, PetscReal *const field[3]);

/* CellStencil - the weights by which a field's entries make its value at the centre of a cell: the two faces' mean,
   or the entry. Not collective. */
PETSC_EXTERN void CellStencil(Field field, const PetscInt cell[2], PaddedStencil *padded);

/* CellRowDistant - all ones for those of four markers from k on that exist and are not near cell i. Not collective. */
static inline LanesBits CellRowDistant(const CellRow *row, PetscInt k, PetscInt i) {
  const Lanes order = {0, 1, 2, 3}, cell = (Lanes){0} + (PetscReal)i;
  const LanesBits is = (LanesBits)(order < (Lanes){0} + (PetscReal)(row->n - k));
  return is & (LanesBits)((cell < LanesAt(row->first + k)) | (cell > LanesAt(row->last + k)));
}
