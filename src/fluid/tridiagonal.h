/* Tridiagonal solves across the rows of a slab, one for each mode of a transform along them (RowTransform): lambda/h^2
   the mode's eigenvalue, (a0 + nu lambda/h^2 - nu d_yy) x = b is, with r + 1/r = 2 + lambda + a0 h^2/nu, r <= 1,
       (nu/(r h^2)) (1 - r S)(1 - r S^-1) x = b,    S the shift by one row,
   that is two recurrences with one constant each, y_j = b_j + r y_{j-1} upwards and z_j = y_j + r z_{j+1} downwards, x
   = (r h^2/nu) z. Precomputed factors of a general tridiagonal matrix would be read from memory twice. What a slab
   needs from outside is y below its first row and z above its last, two numbers a mode: linear in what every slab's
   last y and first z would be without neighbours, which one Allgather tells all. Walls and the periodic seam are such
   neighbours too: x_{-1} = c x_0 is y_{-1} = (c - r) z_0, x_n = c x_{n-1} is z_n = y_{n-1} c/(1 - r c).

   The zero mode of a singular problem has r = 1 and no decay; its column is gathered and solved whole.

   A solve: Reserve, Up for rows 0, 1, .., Begin, End, Down for the last row, the one below it, .. */
#pragma once
#include "fluid/grid.h"

typedef struct _p_Tridiagonal *Tridiagonal;
struct _p_Tridiagonal {
  Grid grid;
  Field field;
  PetscReal nu;
  PetscBool singular;
  PetscInt modes, width;     /* used, and rounded up to blocks */
  PetscReal *lambda, *scale; /* [modes] borrowed */
  PetscReal *y;              /* [rows][width], of the caller between End and the next Up; NULL before Reserve */
  PetscReal *r;              /* [width] */
  PetscReal *factor;         /* [width] of z, with the transform's normalisation */
  PetscReal *gain;   /* [2][width] first z of an empty slab per y below it: of a full block, of the last rank's rows */
  PetscReal *power;  /* [2][width] r^rows, likewise */
  PetscReal *top;    /* [width] z_n over y_{n-1} at a wall */
  PetscReal *bottom; /* [width] y_{-1} over z_0's value without it; periodic: 1/(1 - r^n) */
  PetscInt *reach;   /* [blocks] rows in which a block's boundary data are felt */
  PetscReal *own, *all; /* [message], [ranks][message]: first z, last y, and the zero mode's column */
  PetscInt message;
  PetscReal *below, *above;    /* [ranks][width] y below, z above each slab; above is used up by Down */
  PetscReal *last_y, *first_z; /* [width] of all rows */
  PetscReal *column;           /* [n_y] zero mode */
  MPI_Request request;
};

/* TridiagonalCreate - for a field of the grid and modes with eigenvalues lambda[modes]/h^2 whose solutions are
   multiplied by scale[modes]. Not collective. */
PETSC_EXTERN PetscErrorCode TridiagonalCreate(Grid grid, Field field, PetscInt modes, PetscReal lambda[],
                                              PetscReal scale[], Tridiagonal *d);
PETSC_EXTERN PetscErrorCode TridiagonalDestroy(Tridiagonal *d);

/* TridiagonalSetCoefficients - a0 and nu of one sign; singular: mode 0 has no inverse, the mean of its solution is set
   to zero. */
PETSC_EXTERN PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular);

/* TridiagonalReserve - make the rows of y, once, before the first Up: a solver that is never used has none. */
PETSC_EXTERN PetscErrorCode TridiagonalReserve(Tridiagonal d);

/* TridiagonalUp - row j's right-hand side b[modes], rows in order. TridiagonalDown - row j's solution x[modes], rows in
   reverse; x may be the row of y. Not collective. */
PETSC_EXTERN void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]);
PETSC_EXTERN void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]);

/* TridiagonalBegin, TridiagonalEnd - between them one message travels. Collective, in the same order on every rank. */
PETSC_EXTERN PetscErrorCode TridiagonalBegin(Tridiagonal d);
PETSC_EXTERN PetscErrorCode TridiagonalEnd(Tridiagonal d);

/* TridiagonalAbove - the solution in the row above the slab, between End and the first Down. TridiagonalBelow - in the
   row below, row_0[modes] being the solution in row 0. Through a wall they have no meaning. Not collective. */
PETSC_EXTERN void TridiagonalAbove(Tridiagonal d, PetscReal x[]);
PETSC_EXTERN void TridiagonalBelow(Tridiagonal d, const PetscReal row_0[], PetscReal x[]);

/* TridiagonalEnds - the solution in the first and the last row of all, after End, between walls. Not collective. */
PETSC_EXTERN void TridiagonalEnds(Tridiagonal d, PetscReal first[], PetscReal last[]);
