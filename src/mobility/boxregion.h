/* A smaller table for the box part where the markers are. They often fill a small part of the box, in which D is so
   smooth that 8 x 8 of Chebyshev's places hold it: some 40 eigenvalues in place of several hundred, or, of dipoles, a
   matrix between the places' functions. In a square far from walls images are as smooth: its table has them, and pairs
   of markers need not. Every rank makes the same tables; eigenvectors are the first rank's. */
#pragma once
#include "mobility/boxtable.h"

#define BOX_REGION_PLACES 8  /* in a direction */
#define BOX_REGION_OFF 0.01  /* of D's largest value; tables of cells h and h/2 differ by .02 to .07 */
#define BOX_REGION_SQUARES 6 /* kept: a vesicle that tumbles comes back to all of its */

/* A square about the markers, its centre and side from coarse sets of numbers: most steps find theirs made. */
typedef struct {
  PetscReal centre[2], side; /* (length); side 0: none */
  PetscBool right;           /* the table is D there, to a part of what the whole one's own error is */
  BoxTable table;
} BoxSquare;

/* What the near field's C has of all walls' images, in closed form, at n points X[2n] from unit parts of a source at Y,
   none of them near a wall: V[2 components][parts][n], n a number of whole vectors, BOX_IMAGE_ROW at most. */
typedef void (*BoxImages)(const void *image, PetscInt n, const PetscReal X[], const PetscReal Y[2], PetscReal V[]);
#define BOX_IMAGE_ROW (BOX_REGION_PLACES * BOX_REGION_PLACES)

typedef struct {
  MPI_Comm comm;
  Grid grid;                            /* borrowed, */
  const BoxTable *whole;                /* of forces or of dipoles, */
  const void *image;                    /* for: */
  BoxImages images;                     /* NULL: they are not in squares' tables */
  PetscReal off;                        /* that squares may be, of the largest value */
  PetscBool all;                        /* squares have all that the box adds to the unbounded double layer, which does
                                           not fade over a period with them, and are always used where they are right */
  BoxSquare square[BOX_REGION_SQUARES]; /* the last used first */
} BoxRegion;

/* BoxRegionMayBeAll - whether the square about M markers at X[2M] is in the middle half of the box wherever that has
   walls and no wider than BOX_ALL_OFFSET of a period, before the region's whole table is made. Not collective. */
PETSC_EXTERN PetscBool BoxRegionMayBeAll(const BoxRegion *region, PetscInt M, const PetscReal X[]);

/* BoxRegionAt - the table for M markers at X[2M], all ranks' own the same: of the square about them, or the whole one
   where that is not right or none is made, as it would reach too near to walls or over half of the box. Another table,
   or the same one moved along a period, is said by `moved`. Its bits depend on X alone. Collective. BoxRegionDestroy -
   free. */
PETSC_EXTERN PetscErrorCode BoxRegionAt(BoxRegion *region, PetscInt M, const PetscReal X[], const BoxTable **table,
                                        PetscBool *moved);
PETSC_EXTERN PetscErrorCode BoxRegionDestroy(BoxRegion *region);
