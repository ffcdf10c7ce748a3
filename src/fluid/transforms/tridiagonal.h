/* Tridiagonal solves across the rows of the grid, one for each mode of a transform along them (RowTransform).

   In mode k the second difference along x is multiplication by -lambda_k/h^2. What is left is a tridiagonal system with
   constant coefficients in y,
       (a0 + nu lambda_k/h^2 - nu d_yy) x = b.
   It is a product of two first-order recurrences: with r + 1/r = 2 + lambda_k + a0 h^2/nu, 0 < r <= 1, and S the shift
   by one row,
       (nu/(r h^2)) (1 - r S)(1 - r S^-1) x = b,
       y_j = b_j + r y_{j-1}   upwards,      z_j = y_j + r z_{j+1}   downwards,      x = (r h^2/nu) z.
   So one number r a mode is all that is read, where the factors of a general tridiagonal matrix are an array as large
   as the grid.

   Every rank holds a slab of rows. From outside it needs y in the row below its first and z in the row above its last,
   two numbers a mode. They follow from what every slab makes by itself, with nothing coming in: its last y and its
   first z, which one Allgather tells all ranks. Walls and the periodic seam are neighbours of the same kind (Close in
   tridiagonal.c). The zero mode of a singular problem has r = 1, so that nothing decays: its column travels in the same
   message, and every rank solves it whole.

   A solve: Reserve, Up for rows 0, 1, .., Begin, End, Down for the last row, the one below it, .. */
#pragma once
#include "fluid/grid/grid.h"

#define TRIDIAGONAL_BLOCK 8 /* modes that are worked on together: a line of the cache */

/* What the recurrences of each mode multiply by, [width] each. Of the two entries of power and gain the first is for
   a slab of full height, the second for the last rank's, which may have fewer rows. */
typedef struct {
  PetscReal *r;        /* decay from one row to the next */
  PetscReal *factor;   /* x = factor z; the transform's normalisation is in it */
  PetscReal *power[2]; /* r^m: what is left of a value after a slab of m rows */
  PetscReal *gain[2];  /* first z of a slab without right-hand side, for y = 1 below it and z = 0 above it */
  PetscReal *bottom;   /* y below the first row of all, over first_z (walls) or last_y (seam) with nothing coming in */
  PetscReal *top;      /* walls: z above the last row of all, over last_y */
} ModeFactors;

/* What the slabs tell one another: each its first z and its last y without neighbours, [width] each, and of the zero
   mode's right-hand side its rows. */
typedef struct {
  PetscInt size;
  PetscReal *own, *all; /* [size], [ranks][size] */
  MPI_Request request;
} SlabMessage;

/* What comes into each slab, [ranks][width] each, and what leaves all of them, [width]. */
typedef struct {
  PetscReal *below; /* y in the row below a slab */
  PetscReal *above; /* z in the row above a slab; Down uses this rank's up */
  PetscReal *last_y, *first_z;
} SlabEnds;

typedef struct _p_Tridiagonal *Tridiagonal;
struct _p_Tridiagonal {
  Grid grid;
  Field field;
  PetscReal nu;
  PetscBool singular;
  PetscInt modes, width;     /* modes, and the same rounded up to whole blocks */
  PetscReal *lambda, *scale; /* [modes] borrowed */
  ModeFactors factors;
  PetscInt *reach; /* [blocks] rows in which a block's modes feel what comes in from outside */
  PetscReal *y;    /* [rows][width], of the caller between End and the next Up; NULL before Reserve */
  SlabMessage message;
  SlabEnds ends;
  PetscReal *column; /* [rows of all] solution of the zero mode */
};

/* TridiagonalCreate - for a field of the grid and modes with eigenvalues lambda[modes]/h^2, whose solutions are
   multiplied by scale[modes]; both arrays are borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode TridiagonalCreate(Grid grid, Field field, PetscInt modes, PetscReal lambda[],
                                              PetscReal scale[], Tridiagonal *d);
PETSC_EXTERN PetscErrorCode TridiagonalDestroy(Tridiagonal *d);

/* TridiagonalSetCoefficients - a0 (1/time) and nu (length^2/time) of one sign; singular: mode 0 has no inverse, the
   mean of its solution is set to zero. Not collective. Errors: signs that differ. */
PETSC_EXTERN PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular);

/* TridiagonalReach - reach[width/TRIDIAGONAL_BLOCK]: rows, at least one, at most `most`, in which r^j is greater than
   e^-negligible for one of a block's modes with decays r[width]. Not collective. */
PETSC_EXTERN void TridiagonalReach(PetscInt width, const PetscReal r[], PetscReal negligible, PetscInt most,
                                   PetscInt reach[]);

/* TridiagonalReserve - make the rows of y, once, before the first Up: a solver that is never used has none. */
PETSC_EXTERN PetscErrorCode TridiagonalReserve(Tridiagonal d);

/* TridiagonalUp - row j's right-hand side b[modes], rows in order. TridiagonalDown - row j's solution x[modes], rows in
   reverse; x may be the row of y. Not collective. */
PETSC_EXTERN void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]);
PETSC_EXTERN void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]);

/* TridiagonalBegin, TridiagonalEnd - between them one message travels. Collective, in the same order on every rank. */
PETSC_EXTERN PetscErrorCode TridiagonalBegin(Tridiagonal d);
PETSC_EXTERN PetscErrorCode TridiagonalEnd(Tridiagonal d);
