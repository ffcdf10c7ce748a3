/* The box part of the double layer, as boxpart.h of the single one: what walls and periodic images add to the dipoles'
   velocity has an error of second order, which D takes off. A marker has its values of the table's functions of x and
   of y; a product sums tensors into the functions, goes through the eigenvectors once, or through the matrix D between
   the functions of a square about the markers, and takes velocities out of the functions. So markers cost what
   functions there are, not what eigenvectors, and placing them next to nothing. */
#pragma once
#include "coupling/boxregion.h"
#include "markers/markers.h"

typedef struct _p_DoubleBox *DoubleBox;
struct _p_DoubleBox {
  Markers markers; /* borrowed */
  BoxTable table;  /* of all the box */
  BoxRegion region;
  const BoxTable *at;   /* of these tables, the one that the next are of */
  PetscInt width;       /* functions of y, filled up with zeros to whole vectors */
  PetscReal *value;     /* [n][functions of x + width] of the own markers */
  PetscReal *function;  /* [BOX_COMPONENTS][functions of x][width] work */
  PetscReal *amplitude; /* [rank] work */
};

/* DoubleBoxCreate - for markers on the grid that `spec` makes; the lattice's tables of dipoles (LatticeDipoles) are
   used here only. Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice,
                                            DoubleBox *box);
PETSC_EXTERN PetscErrorCode DoubleBoxDestroy(DoubleBox *box);

/* DoubleBoxTakeImages - from here on squares have the images of these walls. DoubleBoxHasImages - whether the one where
   the markers are placed has them. Not collective. */
static inline void DoubleBoxTakeImages(DoubleBox box, const void *image, BoxImages images) {
  box->region.image = image;
  box->region.images = images;
}
static inline PetscBool DoubleBoxHasImages(DoubleBox box) {
  return box->at->images;
}

/* DoubleBoxPlace - where the markers have been placed. Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxPlace(DoubleBox box);

/* DoubleBoxApply - y += alpha D T, own part y[2n] of a marker vector, tensors T[DIPOLE_COUNT n] of the own markers.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxApply(DoubleBox box, PetscReal alpha, const PetscReal T[], PetscScalar y[]);

/* DoubleBoxMatrix - out[2M][DIPOLE_COUNT M] += scale D, columns one after another of all markers' tensors, rows of the
   own markers. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxMatrix(DoubleBox box, PetscReal scale, PetscReal out[]);
