/* The Stokeslet of the half-space lattice, h = nu = 1: what the grid's Stokes solve gives at a face per unit force on a
   face above one wall, without inertia (docs/nearfield.md, Walls). */
#pragma once
#include "coupling/offsets.h"

#define IMAGE_CELLS 20 /* from a marker to another one's image, up to which stencils are summed */
#define IMAGE_ROWS 25  /* rows from the wall: t at row + 1/2, n at row (0 on the wall, zero) */
#define IMAGE_SHIFT 28 /* largest offset along the wall */
#define IMAGE_WIDTH (2 * IMAGE_SHIFT + 1)

/* Velocity per unit force by rows of response and source and the offset along the wall, response minus source, as in
   OffsetTable with the wall along x: t to t (OFFSET_UU), n to n (OFFSET_VV), n to t (OFFSET_VU; at the offset minus
   1/2). */
typedef struct {
  PetscReal value[OFFSET_COUNT][IMAGE_ROWS][IMAGE_ROWS][IMAGE_WIDTH];
} ImageTable;

/* ImageTableFill - from the free lattice's table (lattice.h), of a reach of IMAGE_SHIFT at least. Not collective. */
PETSC_EXTERN PetscErrorCode ImageTableFill(const OffsetTable *lattice, ImageTable *table);
