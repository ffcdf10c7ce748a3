/* The near field: what the grid's kernel and lattice take from the markers' velocity is given back (docs/method.md,
   Near field), U = u_inf + E u + C (f ds),      C = S - L, S the exact free-space single layer, L = E G E^T/h^2 the
   mobility of the same kernel on the infinite lattice. The grid's own mobility is L and a smooth part of walls and
   images, so kernel, angle to the grid, place in the cells and spacing of the markers cancel. Pairs of markers of one
   vesicle, and of vesicles near one another, images included; each pair with its images in the grid's walls
   (nearimage.h). In unbounded fluid there is no grid to take from: C = S, of all pairs. */
#pragma once
#include "coupling/boxpart.h"
#include "coupling/lattice.h"
#include "coupling/nearimage.h"
#include "membrane/membrane.h"

/* The rows of an own vesicle's markers, the columns of a vesicle's that is near, moved by `shift` (length). */
typedef struct {
  PetscInt row, column; /* vesicles */
  PetscReal shift[2];
  PetscReal *C; /* [2 n_column][2 n_row], columns one after another, entries interlaced x, y */
} NearBlock;

typedef struct _p_NearField *NearField;
struct _p_NearField {
  Markers markers;   /* borrowed */
  Membrane membrane; /* borrowed */
  PetscReal nu;
  PetscBool free; /* unbounded fluid: C = S */
  OffsetTable lattice;
  NearImage image;        /* what the walls add to each pair */
  PetscReal far[5];       /* coefficients a2, a4, a6, b2, b6 of distant pairs */
  PetscReal **kress;      /* [vesicles][n] weights of the logarithm by index difference; NULL for others' vesicles */
  PaddedStencil *stencil; /* [2M] */
  NearBlock *block;
  PetscInt count, room; /* blocks in use, and made */
  PetscBool crossed;    /* whether any rank has a block between two vesicles, or of an image */
  PetscScalar *force;   /* [2M] work */
  BoxPart box;          /* NULL without */
  PetscLogEvent event;
};

/* NearFieldCreate - for membranes whose markers are on a grid, in a fluid of viscosity nu. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldCreate(Markers markers, Membrane membrane, PetscReal nu, NearField *near);
PETSC_EXTERN PetscErrorCode NearFieldDestroy(NearField *near);

/* NearFieldPlace - the blocks of the own vesicles where the markers have been placed (MarkersPlace). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldPlace(NearField near);

/* NearFieldAddBoxPart - from here on with the box part, for the fluid that spec makes. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldAddBoxPart(NearField near, const FluidSpec *spec);

/* NearFieldApply - U += alpha (C + D) F, D the box part if there is one, own parts F[2n] and U[2n] of marker vectors; F
   is a force times ds (length^3/time^2 with density 1). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldApply(NearField near, PetscReal alpha, const PetscScalar F[], PetscScalar U[]);
