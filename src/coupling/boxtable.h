/* The error of second order of a grid's smooth part W, made once for a run by Richardson's extrapolation from a coarse
   pair of grids of the box's shape (docs/method.md, Near field): D = (h/H)^2 4/3 (W_{H/2} - W_H) = phi Q diag(l) Q^T
   phi^T, phi the values of interpolating functions at a marker. */
#pragma once
#include "coupling/boxgrid.h"

#define BOX_FUNCTIONS BOX_PLACES /* more than the functions of a direction */

/* Functions of x and y that D couples with one another only, and what is kept of its eigenvectors in them. */
typedef struct {
  PetscInt first[2][2];  /* [component]: its functions of x, of y, from here on */
  PetscInt n[2];         /* so many */
  PetscInt start, modes; /* its eigenvalues among all */
  PetscReal *Q;          /* [2 components][n[0]][n[1]][modes] */
} BoxBlock;

typedef struct {
  BoxAxis axis[2];       /* of the places: Chebyshev's between walls, even offsets over a period */
  PetscInt functions[2]; /* in x and y: Lagrange's polynomials, or 1, cos, sin, .. over the period */
  PetscInt blocks;
  BoxBlock *block;
  PetscInt rank; /* eigenvalues kept */
  PetscReal *l;  /* [rank] velocity per force */
  PetscReal H;   /* cell size of the coarser grid */
} BoxTable;

/* BoxTableCreate - for the run's grid and boundaries. Collective on spec->comm: ranks share the solves. BoxTableDestroy
   - and free. */
PETSC_EXTERN PetscErrorCode BoxTableCreate(const FluidSpec *spec, const char kernel[], BoxTable *table);
PETSC_EXTERN PetscErrorCode BoxTableDestroy(BoxTable *table);

/* BoxTableFunctions - values[functions[dir]] of a direction's functions at the coordinate x (length). Not collective.
 */
PETSC_EXTERN void BoxTableFunctions(const BoxTable *table, int dir, PetscReal x, PetscReal values[]);
