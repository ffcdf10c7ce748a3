/* The error of second order of a grid's smooth part W, made once for a run by Richardson's extrapolation from a coarse
   pair of grids of the box's shape (docs/nearfield.md, Box part):

       D = (h/H)^2 4/3 (W_{H/2} - W_H) = phi Q diag(l) Q^T phi^T,

   phi the values of interpolating functions at a marker, Q and l eigenvectors and eigenvalues. Sources are forces or
   tensors of dipoles. Of tensors D from them to the velocities stands beside its transpose in a symmetric matrix. Ranks
   share the solves (boxgrid.h), then all have the table. */
#pragma once
#include "mobility/boxgrid.h"

#define BOX_BLOCK_FUNCTIONS 64 /* at most, of a component in a block: 8 x 8 between four walls */

/* Functions of x and y that D couples with one another only, and what is kept of its eigenvectors in them. */
#define BOX_COMPONENTS 5 /* u, v, and of dipoles xx, yy, xy */
typedef struct {
  PetscInt first[BOX_COMPONENTS][2]; /* [component]: its functions of x, of y, from here on */
  PetscInt n[2];                     /* numbers of its functions of x and of y */
  PetscInt start, modes;             /* first and number of its eigenvalues among all */
  PetscReal *Q;                      /* [components][n[0]][n[1]][modes] */
} BoxBlock;

typedef struct {
  int parts;             /* of a source: 2 of a force, DIPOLE_COUNT of a tensor */
  int source;            /* component of its first part: 0 of a force, as that of a velocity; 2 of a tensor */
  int components;        /* source + parts */
  BoxAxis axis[2];       /* places in x and y: Chebyshev's between walls, equal offsets over a period */
  PetscInt functions[2]; /* in x and y, up to the last in a block: Lagrange's polynomials, or 1, cos, sin, .. */
  PetscInt blocks;       /* those of which something is kept */
  BoxBlock *block;
  PetscInt rank; /* eigenvalues kept */
  PetscReal *l;  /* [rank] velocity per force */
  PetscReal H;   /* cell size of the coarser grid */
} BoxTable;

/* BoxTableCreate - for the run's grid and boundaries, of forces or of dipoles, as the lattice is, which is used here
   only; as near to walls as it reaches, or (middle) over the middle half of the box between walls, from a quarter of
   the solves between four of them. Collective on spec->comm: ranks share the solves. BoxTableDestroy - and free, of
   zeros nothing. */
PETSC_EXTERN PetscErrorCode BoxTableCreate(const FluidSpec *spec, const char kernel[], const BoxLattice *lattice,
                                           PetscBool middle, BoxTable *table);
PETSC_EXTERN PetscErrorCode BoxTableDestroy(BoxTable *table);

/* BoxTableFunctions - values[functions[dir]] of a direction's functions at the coordinate x (length); nearer to a wall
   than the table reaches they go straight on. Not collective. */
PETSC_EXTERN void BoxTableFunctions(const BoxTable *table, int dir, PetscReal x, PetscReal values[]);

/* BoxBlockSum - a[modes] of a block: the weights[components][n[0]][n[1]] of the functions of some components, `first`
   and those behind it, times their vectors. Not collective. */
PETSC_EXTERN void BoxBlockSum(const BoxBlock *block, int first, int components, const PetscReal weight[],
                              PetscReal a[]);

/* BoxTableRows - rows[count][rank]: `part` of the components first .. first + count - 1 of the functions at X.
   Not collective. */
PETSC_EXTERN void BoxTableRows(const BoxTable *table, const PetscReal X[2], PetscReal part, int first, int count,
                               PetscReal rows[]);

/* BoxProduct - SUM l x y of n numbers, the same bits with x and y exchanged. Not collective. */
PETSC_EXTERN PetscReal BoxProduct(PetscInt n, const PetscReal l[], const PetscReal x[], const PetscReal y[]);
