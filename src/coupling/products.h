/* Products of a Krylov solve on the grid, which are kept to be combined into its velocity and pressure instead of a
   further Stokes solve. */
#pragma once
#include "base/base.h"

#define PRODUCTS_KEPT 6

typedef struct {
  Vec w[PRODUCTS_KEPT + 1];                /* velocities and pressures of the products, the last for one not kept */
  Vec p[PRODUCTS_KEPT + 1];                /* made when first needed */
  Vec z[PRODUCTS_KEPT], Az[PRODUCTS_KEPT]; /* their unknowns, and what the operator makes of them */
  PetscInt count;                          /* products of the solve so far */
} Products;

/* ProductsNext - room for the product to come, its place; the last one, PRODUCTS_KEPT, is used again and again. w:
   velocities are like this one, NULL: there are none; da: pressures are of this; x: unknowns are like this one.
   Collective. ProductsDestroy - all. Collective. */
PETSC_EXTERN PetscErrorCode ProductsNext(Products *products, Vec w, DM da, Vec x, PetscInt *place);
PETSC_EXTERN PetscErrorCode ProductsDestroy(Products *products);

/* ProductsCombine - the changes of w, p (NULL: there are none) and of the residual that go with a change of x made of
   the products, of which none was left out; x := what it is made of. rest: unknowns, work. Collective. */
PETSC_EXTERN PetscErrorCode ProductsCombine(Products *products, Vec rest, Vec x, Vec w, Vec p, Vec residual);
