/* The box part of the near field: D takes the error of second order off what walls and periodic images add to the
   markers' mobility (boxtable.h),

       U += D F = A diag(l) A^T F,

   A the table's eigenvectors at the markers. D is steady in every flow. Over a period the near field's C is of nearest
   images only and fades where D takes over (BoxPartImage). A rank has the rows of A of its own markers; a product sums
   one amplitude an eigenvalue over all ranks.

   Create, Place wherever the markers have been placed, then Apply or Add. */
#pragma once
#include "mobility/boxtable.h"
#include "markers/markers.h"

typedef struct _p_BoxPart *BoxPart;
struct _p_BoxPart {
  const FluidSpec *spec; /* borrowed */
  BoxLattice lattice;
  Markers markers;      /* borrowed */
  BoxAxis axis[2];      /* the directions of the box, for BoxImage */
  PetscBool ramp;       /* unsteady flow: D fades next to walls */
  BoxTable table[2];    /* table of all the box, and of its middle half; each is made when it is first needed */
  const BoxTable *at;   /* the table that A is of */
  PetscReal *A;         /* [2n][rank] of the own markers, D = A diag(l) A^T */
  PetscReal *X;         /* [2n] places of the own markers for which A is */
  PetscReal *amplitude; /* [rank] work */
  PetscInt room;        /* eigenvalues for which A and amplitude have room */
  PetscLogEvent make;
};

/* BoxPartCreate - for markers on the grid that `spec` makes, which is borrowed as the lattice's tables of forces are. A
   lattice that is whole makes it the smooth part W_H of the coarser grid, less the exact images in walls. Collective.
 */
PETSC_EXTERN PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice,
                                          BoxPart *box);

PETSC_EXTERN PetscErrorCode BoxPartDestroy(BoxPart *box);

/* BoxPartPlace - where the markers have been placed. Collective. */
PETSC_EXTERN PetscErrorCode BoxPartPlace(BoxPart box);

/* BoxPartImage - BoxImage of the box. Not collective. */
static inline PetscReal BoxPartImage(BoxPart box, PetscReal d[2]) {
  return BoxImage(box->axis, d);
}

/* BoxPartApply - U += alpha D F, own parts F[2n] and U[2n] of marker vectors, F as NearFieldApply's. Collective. */
PETSC_EXTERN PetscErrorCode BoxPartApply(BoxPart box, PetscReal alpha, const PetscScalar F[], PetscScalar U[]);

/* BoxPartAdd - out += scale D, from forces on the markers in columns to the own ones in rows, out[2 n of columns][2 n
   of rows]. Not collective. */
PETSC_EXTERN PetscErrorCode BoxPartAdd(BoxPart box, PetscReal scale, const MarkerRange *rows,
                                       const MarkerRange *columns, PetscReal out[]);
