/* The same mobility as mobility.h in quasi-steady flow of any box with a box part, walls and images included:

       (E A^-1 E^T + D)/h^2 ~ W + B + L - C_image,      B, L, C_image of the nearest image, fading over a period

   (docs/nearfield.md, Box part), B the exact images of the Stokeslet in the walls and W the smooth rest on the coarser
   one of the box part's grids. With the near field's C it is the exact single layer, its images and W. Near a wall W
   goes on along a straight line, which it can as B has what is singular there. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_MobilityBox *MobilityBox;

/* MobilityBoxCreate - for the coupling's bodies on the grid that spec makes, whose near field has a box part.
   Collective. */
PETSC_EXTERN PetscErrorCode MobilityBoxCreate(const FluidSpec *spec, Coupling coupling, MobilityBox *box);
PETSC_EXTERN PetscErrorCode MobilityBoxDestroy(MobilityBox *box);

/* MobilityBoxAdd - out += that of the velocity of the own markers in rows by forces on those in columns, where
   the near field has been placed; out[2 n of columns][2 n of rows], ranges of whole bodies. Collective. */
PETSC_EXTERN PetscErrorCode MobilityBoxAdd(MobilityBox box, const MarkerRange *rows, const MarkerRange *columns,
                                           PetscReal out[]);

/* MobilityAddPair - Mob[][2 rows] += scale times the block xx, yy, xy, yx of markers i and j: velocity of row marker i
   by a force on column marker j. Not collective. */
static inline void MobilityAddPair(PetscReal scale, PetscInt rows, PetscInt i, PetscInt j, const PetscReal block[4],
                                   PetscReal Mob[]) {
  PetscReal *x = Mob + 4 * j * rows + 2 * i, *y = x + 2 * rows;
  x[0] += scale * block[0];
  y[1] += scale * block[1];
  y[0] += scale * block[2];
  x[1] += scale * block[3];
}
