/* The box part of the double layer: D takes the error of second order off what walls and periodic images add to the
   dipoles' velocity,

       U += D T = phi Q diag(l) Q^T psi^T T,

   phi and psi the values of the table's functions at the markers. A product sums tensors into the functions, goes
   through the eigenvectors once, or through the matrix between the functions of a square about the markers
   (boxregion.h), and takes velocities out of the functions, so that a marker costs what functions there are. A rank has
   the values of its own markers; a product sums the amplitudes over all ranks.

   Create, Place wherever the markers have been placed, then Apply or Matrix. */
#pragma once
#include "mobility/boxregion.h"
#include "markers/markers.h"

typedef struct _p_DoubleBox *DoubleBox;
struct _p_DoubleBox {
  const FluidSpec *spec; /* borrowed */
  Markers markers;       /* borrowed */
  BoxLattice lattice;
  PetscBool error;      /* the error of second order is taken off where the next is not used, */
  PetscBool asked;      /* and all that the box adds may be used, */
  PetscBool may_be_all; /* if the solver can do with it */
  BoxTable table[2];    /* of all the box the error; of its middle all that the box adds. Made when needed */
  BoxRegion region[2];  /* of each */
  const BoxTable *at;   /* of all these tables, the one that the next are of */
  PetscInt room;        /* markers' values, */
  PetscInt rooms;       /* and functions */
  PetscInt width;       /* functions of y, filled up with zeros to whole vectors */
  PetscReal *value;     /* [n][functions of x + width] of the own markers */
  PetscReal *function;  /* [BOX_COMPONENTS][functions of x][width] work */
  PetscReal *amplitude; /* [rank] work */
  PetscLogEvent make;
};

/* DoubleBoxCreate - for markers on the grid that `spec` makes, which is borrowed as the lattice's tables of dipoles
   (LatticeDipoles) are; error: with what takes the error of second order off, all: with all that the box adds, where
   DoubleBoxMayBeAll has been called. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxCreate(const FluidSpec *spec, Markers markers, const BoxLattice *lattice,
                                            PetscBool error, PetscBool all, DoubleBox *box);
PETSC_EXTERN PetscErrorCode DoubleBoxDestroy(DoubleBox *box);

/* DoubleBoxTakeImages - from here on squares have the images of these walls. DoubleBoxHasImages - whether the one where
   the markers are placed has them. Not collective. */
static inline void DoubleBoxTakeImages(DoubleBox box, const void *image, BoxImages images) {
  box->region[0].image = image;
  box->region[0].images = images;
}
static inline PetscBool DoubleBoxHasImages(DoubleBox box) {
  return box->at ? box->at->images : PETSC_FALSE;
}

/* DoubleBoxMayBeAll - from here on the table of a square in the middle of the box may be all that walls and images add
   to the double layer of free space, so that no dipoles are needed on the grid. DoubleBoxIsAll - whether it is where
   the markers are placed. Not collective. */
static inline void DoubleBoxMayBeAll(DoubleBox box) {
  box->may_be_all = box->asked ? BoxTableFits(box->spec) : PETSC_FALSE;
}
static inline PetscBool DoubleBoxIsAll(DoubleBox box) {
  return box && box->at && box->at == &box->region[1].square[0].table ? PETSC_TRUE : PETSC_FALSE;
}

/* DoubleBoxPlace - where the markers have been placed. Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxPlace(DoubleBox box);

/* DoubleBoxServes - whether there is anything to add where the markers are placed. Not collective. */
static inline PetscBool DoubleBoxServes(DoubleBox box) {
  return box && box->at ? PETSC_TRUE : PETSC_FALSE;
}

/* DoubleBoxApply - y += alpha D T, own part y[2n] of a marker vector, tensors T[DIPOLE_COUNT n] of the own markers.
   Collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxApply(DoubleBox box, PetscReal alpha, const PetscReal T[], PetscScalar y[]);

/* DoubleBoxMatrix - out[2M][DIPOLE_COUNT M] += scale D, columns one after another of all markers' tensors, rows of the
   own markers. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBoxMatrix(DoubleBox box, PetscReal scale, PetscReal out[]);
