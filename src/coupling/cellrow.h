/* A row of cells of one vesicle, for fields at cell centres next to its membrane (nearcells.h, doublecells.h): which
   cells are corrected, and to which of them each marker is so near that the lattice's sums stand for it. These are
   taken for all the row at once. Indices of cells go beyond the grid where it is periodic. */
#pragma once
#include "base/lanes.h"
#include "coupling/offsets.h"

/* CellStencil - the weights by which a field's entries make its value at the centre of a cell: the two faces' mean,
   or the entry. Not collective. */
PETSC_EXTERN void CellStencil(Field field, const PetscInt cell[2], PaddedStencil *padded);

/* CellBox - cells from box[dir][0] to box[dir][1] hold n markers X[2n] and all within reach (length) of them;
   indices go beyond the grid where it is periodic. CellIsNear - whether x is within reach of a marker. Not collective.
 */
PETSC_EXTERN void CellBox(Grid grid, PetscInt n, const PetscReal X[], PetscReal reach, PetscInt box[2][2]);
PETSC_EXTERN PetscBool CellIsNear(PetscInt n, const PetscReal X[], PetscReal reach, const PetscReal x[2]);

typedef struct {
  PetscInt from, to;       /* of the cells along x that are corrected the first and the last one */
  PetscReal *first, *last; /* [markers] cells that are near each marker; whole vectors */
  PetscReal *sum[3];       /* [cells] of u, v and p, from the cell `from` on */
} CellRow;

/* CellRowCreate - for a vesicle of so many markers and rows of so many cells. Not collective. */
PETSC_EXTERN PetscErrorCode CellRowCreate(PetscInt markers, PetscInt cells, CellRow *row);
PETSC_EXTERN PetscErrorCode CellRowDestroy(CellRow *row);

/* CellRowPlace - row j of the cells from box[0] to box[1] along x, with sums of zero: those within reach (length) of
   the markers X[2n] are corrected; false if none is. Not collective. */
PETSC_EXTERN PetscBool CellRowPlace(CellRow *row, Grid grid, PetscInt n, const PetscReal X[], PetscReal reach,
                                    const PetscInt box[2], PetscInt j);

/* CellRowNear - cells that are within so many h of marker k at X[2] are near it: of the row those from cell[0] = (x, y)
   on, as many as are returned. Not collective. */
PETSC_EXTERN PetscInt CellRowNear(CellRow *row, Grid grid, PetscInt k, const PetscReal X[2], PetscReal cells,
                                  PetscInt j, PetscInt cell[2]);

/* CellRowDistant - all ones for those of four markers from k on that exist, of n, and are not near cell i. Not
   collective. */
static inline LanesBits CellRowDistant(const CellRow *row, PetscInt n, PetscInt k, PetscInt i) {
  const Lanes order = {0, 1, 2, 3}, cell = (Lanes){0} + (PetscReal)i;
  const LanesBits is = (LanesBits)(order < (Lanes){0} + (PetscReal)(n - k));
  return is & (LanesBits)((cell < LanesAt(row->first + k)) | (cell > LanesAt(row->last + k)));
}
