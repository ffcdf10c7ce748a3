/* Tridiagonal solves across the rows of the grid, one for each mode of a transform along them (RowTransform).

   In mode k the second difference along x is multiplication by -lambda_k/h^2. What is left is a tridiagonal system with
   constant coefficients in y,
       (a0 + nu lambda_k/h^2 - nu d_yy) x = b.
   It is a product of two first-order recurrences: with r + 1/r = 2 + lambda_k + a0 h^2/nu, 0 < r <= 1, and S the shift
   by one row,
       (nu/(r h^2)) (1 - r S)(1 - r S^-1) x = b,
       y_j = b_j + r y_{j-1}   upwards,      z_j = y_j + r z_{j+1}   downwards,      x = (r h^2/nu) z.
   So one number r a mode is all that is read, where the factors of a general tridiagonal matrix are an array as large
   as the grid. Slabs (slabs.h) tell each rank what comes into its rows from outside.

   The zero mode of a singular problem has r = 1, so that nothing decays: every rank has its whole column of right-hand
   sides and solves it.

   A solve: SlabsReserve, Up for rows 0, 1, .., End, Down for the last row, the one below it, .. */
#pragma once
#include "fluid/transforms/slabs.h"

typedef struct _p_Tridiagonal *Tridiagonal;
struct _p_Tridiagonal {
  ModeFactors factors; /* r2 = 0 */
  Slabs slabs;         /* y of the rows */
  PetscReal nu;
  PetscBool singular;
  PetscReal *column; /* [ranks][block] right-hand side, then solution of the zero mode in the rows of all ranks */
};

/* TridiagonalCreate - for a field of the grid and modes with eigenvalues lambda[modes]/h^2, whose solutions are
   multiplied by scale[modes]; both arrays are borrowed. Not collective. */
PETSC_EXTERN PetscErrorCode TridiagonalCreate(Grid grid, Field field, PetscInt modes, const PetscReal lambda[],
                                              const PetscReal scale[], Tridiagonal *d);
PETSC_EXTERN PetscErrorCode TridiagonalDestroy(Tridiagonal *d);

/* TridiagonalSetCoefficients - a0 (1/time) and nu (length^2/time) of one sign; singular: mode 0 has no inverse, the
   mean of its solution is set to zero. Not collective. Errors: signs that differ. */
PETSC_EXTERN PetscErrorCode TridiagonalSetCoefficients(Tridiagonal d, PetscReal a0, PetscReal nu, PetscBool singular);

/* TridiagonalUp - row j's right-hand side b[modes], rows in order. TridiagonalDown - row j's solution x[modes], rows in
   reverse. Not collective. TridiagonalEnd - what comes into every slab, between them. Collective. */
PETSC_EXTERN void TridiagonalUp(Tridiagonal d, PetscInt j, const PetscReal b[]);
PETSC_EXTERN PetscErrorCode TridiagonalEnd(Tridiagonal d);
PETSC_EXTERN void TridiagonalDown(Tridiagonal d, PetscInt j, PetscReal x[]);
