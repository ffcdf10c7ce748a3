/* The staggered (marker-and-cell) grid, divided among the ranks in slabs of rows, and its stencils.

   Fields: p at cell centres; u on vertical faces, entry (i,j) the RIGHT face of cell (i,j); v on horizontal faces,
   entry (i,j) the TOP face of cell (i,j). With walls in x the last column of u is the wall, which is no unknown: u has
   n_x - 1 columns; likewise v has n_y - 1 rows with walls in y. Every rank holds whole rows, the same rows of all three
   fields.

   Vectors: p is a vector of da[FIELD_P]; a velocity w is a vector of the composite `velocity`, whose local part is the
   rank's rows of u followed by its rows of v, x fastest. */
#pragma once
#include "base/base.h"
#include "scene/fluidspec.h"

typedef enum { FIELD_U = 0, FIELD_V = 1, FIELD_P = 2 } Field;

typedef struct _p_Grid *Grid;
struct _p_Grid {
  MPI_Comm comm;
  PetscMPIInt rank, size;
  PetscReal lo[2], hi[2], h; /* box (length) and cell size */
  PetscInt n[2];             /* cells */
  PetscBool wall[2];         /* wall (or periodic) in x, y; in unbounded fluid the window ends there */
  PetscBool free;            /* unbounded fluid: the grid is only a window in which fields are written */
  PetscInt columns[3];       /* columns of each field */
  PetscInt all_rows[3];      /* rows of each field, all ranks */
  PetscInt rows[3];          /* rows of each field on this rank */
  PetscInt first;            /* first row of this rank */
  PetscInt block;            /* rows of every rank but the last: ceil(n_y/ranks), FFTW's layout */
  DM da[3];
  DM velocity;
  PetscMPIInt below, above; /* neighbours, MPI_PROC_NULL at a wall */
  PetscScalar *ghost[3][2]; /* row below and row above, per field */
};

/* GridCreate - the fluid's grid over the ranks of its communicator. Collective. Errors: a number of ranks that leaves
   one without rows. */
PETSC_EXTERN PetscErrorCode GridCreate(const FluidSpec *spec, Grid *grid);
PETSC_EXTERN PetscErrorCode GridDestroy(Grid *grid);

/* GridFits - whether n rows of cells can be divided among this number of ranks. Not collective. */
PETSC_EXTERN PetscBool GridFits(PetscInt n, PetscInt ranks);

/* GridPosition - position X[2] (length) of entry (i, j) of a field, j counting the rows of all ranks.
   Not collective. */
PETSC_EXTERN void GridPosition(Grid grid, Field field, PetscInt i, PetscInt j, PetscReal X[2]);

/* Number of this rank's entries of u, which come first in a velocity's local array. */
static inline PetscInt GridLocalU(Grid grid) {
  return grid->columns[FIELD_U] * grid->rows[FIELD_U];
}

/* Where local row j of u or v starts in a velocity's local array. */
static inline PetscInt GridRowStart(Grid grid, Field field, PetscInt j) {
  return (field == FIELD_V ? GridLocalU(grid) : 0) + j * grid->columns[field];
}

/* A field's local rows with the row below and the row above them. */
typedef struct {
  const PetscScalar *a, *below, *above;
  PetscInt columns, rows;
} Rows;
static inline const PetscScalar *RowAt(const Rows *r, PetscInt j) {
  if (j < 0) return r->below;
  return j < r->rows ? r->a + j * r->columns : r->above;
}

/* GridRows - exchange the ghost rows of a field whose local array is a. At a wall the ghost row is what makes the
   field's homogeneous condition: minus the first row for u (Dirichlet, half a cell off), zero for v (on the wall), the
   same row for p (Neumann). Collective. */
PETSC_EXTERN PetscErrorCode GridRows(Grid grid, Field field, const PetscScalar a[], Rows *rows);

/* GridGradient - w = alpha G p (add false) or w += alpha G p (add true). Collective. */
PETSC_EXTERN PetscErrorCode GridGradient(Grid grid, PetscReal alpha, Vec p, PetscBool add, Vec w);

/* GridGradientTranspose - q = alpha G^T w, so that the divergence is D w = -G^T w (walls at rest). Collective. */
PETSC_EXTERN PetscErrorCode GridGradientTranspose(Grid grid, PetscReal alpha, Vec w, Vec q);

/* A part of this rank's faces or cells: rows[0] .. rows[1] - 1 and in them columns[0] .. columns[1] - 1, as far as a
   field has them. */
typedef struct {
  PetscInt rows[2], columns[2];
} GridWindow;

/* GridClear - zero in a window of a velocity or a pressure. Not collective. */
PETSC_EXTERN PetscErrorCode GridClear(Grid grid, const GridWindow *window, Vec x);

/* GridLargestDivergence - max |G^T w + bc2| (1/time) over all cells, bc2 NULL for walls at rest; NaN when an entry is
   not finite. The same on every rank. Collective. */
PETSC_EXTERN PetscErrorCode GridLargestDivergence(Grid grid, Vec w, Vec bc2, PetscReal *largest);

/* GridHelmholtzField - y = a0 w - nu (second differences of w) for one field's local arrays, homogeneous walls; y must
   not be w. With FIELD_P, a0 = 0 and nu = -1 this is L. Collective. */
PETSC_EXTERN PetscErrorCode GridHelmholtzField(Grid grid, Field field, PetscReal a0, PetscReal nu,
                                               const PetscScalar w[], PetscScalar y[]);

/* GridHelmholtz - y = a0 w - nu L_u w for a velocity, homogeneous walls. Collective. */
PETSC_EXTERN PetscErrorCode GridHelmholtz(Grid grid, PetscReal a0, PetscReal nu, Vec w, Vec y);

/* GridCreateG, GridCreateD - MatShells: G (pressure to velocity), D = -G^T. Collective. */
PETSC_EXTERN PetscErrorCode GridCreateG(Grid grid, Mat *G);
PETSC_EXTERN PetscErrorCode GridCreateD(Grid grid, Mat *D);

/* GridAssemble - assembled a0 I - nu (second differences) of one field; for FIELD_P with a0 = 0, nu = -1 this is L.
   Collective. */
PETSC_EXTERN PetscErrorCode GridAssemble(Grid grid, Field field, PetscReal a0, PetscReal nu, Mat *A);

/* GridWallFactor - what the field's second difference in direction dir (0 x, 1 y) does at a wall: the factor c of
   the missing neighbour's value as c times the entry itself (-1 Dirichlet half a cell off, 0 Dirichlet on the wall, 1
   Neumann). */
static inline PetscReal GridWallFactor(Field field, int dir) {
  if (field == FIELD_P) return 1;
  return (int)field == dir ? 0 : -1;
}
