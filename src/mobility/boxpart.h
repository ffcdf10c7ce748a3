/* The box part of a layer: D takes the error of second order off what walls and periodic images add to the velocities
   that the markers' forces or dipoles F give (boxtable.h),

       U += D F = phi Q diag(l) Q^T psi^T F,

   phi and psi the values of the table's functions at the markers for velocities and for sources. A product sums sources
   into the functions, goes through the eigenvectors once, and takes velocities out of the functions. D is steady in
   every flow. Over a period the near field's C is of nearest images only and fades where D takes over (BoxImage).
   A rank has the values of its own markers; a product sums the amplitudes over all ranks.

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
  PetscBool ramp;       /* unsteady flow: D of forces fades next to walls */
  BoxTable table[2];    /* table of all the box, and of its middle half; each is made when it is first needed */
  const BoxTable *at;   /* the table in use, of which the rest is */
  PetscReal *value[2];  /* [functions of x or y][n] at the own markers */
  PetscReal *product;   /* [parts][functions of x][n] work: these times a source or a velocity's functions of y */
  PetscReal *function;  /* [components][functions of x][functions of y] work */
  PetscReal *amplitude; /* [rank] work */
  PetscLogEvent make;
};

/* BoxPartCreate - for markers on the grid that `spec` makes, which is borrowed as the lattice's tables of forces or
   dipoles are. A lattice that is whole makes it the smooth part W_H of the coarser grid, less the exact images in
   walls. Collective. */
PETSC_EXTERN PetscErrorCode BoxPartCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice,
                                          BoxPart *box);

PETSC_EXTERN PetscErrorCode BoxPartDestroy(BoxPart *box);

/* BoxPartPlace - where the markers have been placed. Collective. */
PETSC_EXTERN PetscErrorCode BoxPartPlace(BoxPart box);

/* BoxPartApply - U += alpha D F, own parts of a marker vector U[2n] and of forces F[2n], as NearFieldApply's, or
   tensors F[DIPOLE_COUNT n]. Collective. */
PETSC_EXTERN PetscErrorCode BoxPartApply(BoxPart box, PetscReal alpha, const PetscScalar F[], PetscScalar U[]);

/* BoxPartAdd - out += scale D, from forces on the markers in columns to the own ones in rows, out[2 n of columns][2 n
   of rows]. Not collective. */
PETSC_EXTERN PetscErrorCode BoxPartAdd(BoxPart box, PetscReal scale, const MarkerRange *rows,
                                       const MarkerRange *columns, PetscReal out[]);
