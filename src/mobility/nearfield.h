/* The near field: what the regularised delta function and the lattice take from the markers' velocity is given back
   (docs/nearfield.md),

       U = u_inf + E u + C (f ds),      C = SL - SL_h,

   f ds the forces, SL the exact single layer of unbounded fluid, SL_h = E A^-1 E^T/h^2 the mobility of the same
   regularised delta function on the infinite lattice. The grid's own mobility is SL_h and a smooth part of walls and
   images, so delta function, angle to the grid, place in the cells and spacing of the markers cancel. C is of pairs of
   markers of one vesicle, and of vesicles near one another, images included, each pair with its images in the grid's
   walls (layerpairs.h); in unbounded fluid, where there is no grid to take from, C = SL of all pairs. With a box part
   (boxpart.h) C_box comes on top, which takes the error of second order off the smooth part.

   A rank has the blocks (nearblock.h) whose first body is its own. A product gathers all forces where a block joins
   bodies of two ranks, and sums what the box part has of all.

   Create, perhaps AddBoxPart, then Place wherever the markers have been placed, then Apply or Add. */
#pragma once
#include "mobility/boxpart.h"
#include "mobility/nearpairs.h"

typedef struct _p_NearField *NearField;
struct _p_NearField {
  LayerSetting set;
  OffsetTable lattice; /* the lattice's Stokeslet; empty in unbounded fluid */
  LayerPairs pairs;
  NearList list;
  NearStore store;
  PetscBool crossed;      /* whether any rank has a pair with another rank's marker */
  PetscScalar *force;     /* [2M] work */
  PetscScalar *velocity;  /* [2n] work */
  BoxPart box;            /* NULL without */
  PetscLogEvent event[2]; /* place, apply */
};

/* NearFieldCreate - for bodies whose markers are on a grid, in a fluid of viscosity nu. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldCreate(Markers markers, Bodies bodies, PetscReal nu, NearField *near);
PETSC_EXTERN PetscErrorCode NearFieldDestroy(NearField *near);

/* NearFieldPlace - C of the own vesicles where the markers have been placed (MarkersPlace). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldPlace(NearField near);

/* NearFieldAddBoxPart - from here on with the box part, for the fluid that spec makes. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldAddBoxPart(NearField near, const FluidSpec *spec);

/* NearFieldCreateBoxPart - BoxPartCreate with the near field's markers and lattice. Collective. */
PETSC_EXTERN PetscErrorCode NearFieldCreateBoxPart(NearField near, const FluidSpec *spec, PetscBool whole,
                                                   BoxPart *box);

/* NearFieldApply - U += alpha (C + D) F, D the box part if there is one, own parts F[2n] and U[2n] of marker vectors; F
   is a force times ds (length^3/time^2 with density 1). Collective. */
PETSC_EXTERN PetscErrorCode NearFieldApply(NearField near, PetscReal alpha, const PetscScalar F[], PetscScalar U[]);

/* NearFieldAdd - out += scale (C + D), or scale C where the box part is not asked for, of the velocity of the markers
   in rows by forces on those in columns, out[2 n of columns][2 n of rows] with entries interlaced, the rows of own
   markers only; each a range of whole bodies. Not collective. */
PETSC_EXTERN PetscErrorCode NearFieldAdd(NearField near, PetscReal scale, PetscBool box, const MarkerRange *rows,
                                         const MarkerRange *columns, PetscReal out[]);
