/* The smooth part W = E A^-1 E^T/h^2 - L of a grid's mobility between places: what walls and periodic images add to the
   infinite lattice, L of the nearest image times a window over a period (docs/method.md, Near field). In quasi-steady
   flow, whatever the run's. */
#pragma once
#include "coupling/lattice.h"
#include "fluid/fluid.h"

#define BOX_PLACES (64 * FLUID_LONGEST_PERIOD) /* largest number of places in a direction */

/* Places in one direction. Between walls a force may be at any of them; where the box is periodic it is at the first
   one, and W depends on the offset alone. */
typedef struct {
  PetscBool wall;
  PetscReal low, high; /* of the places (length): within the walls, or the period */
  PetscInt modes;      /* of a period: that are kept of W; 0 between walls */
  PetscInt places;     /* an even number: mirror images in pairs */
  PetscReal place[BOX_PLACES];
  PetscInt pairs; /* of a response's place a and a force's b: a * places + b, or the offset a */
} BoxAxis;

/* BoxImage - d[2] (length) between two points becomes that of the nearest image; returns the part of the infinite
   lattice's mobility that W leaves out: from 1 it falls to 0 at half a period, where images change, so that W is smooth
   and periodic. 1 between walls. Not collective. */
PETSC_EXTERN PetscReal BoxImage(const BoxAxis axis[2], PetscReal d[2]);

/* BoxGridAdd - W += scale times the smooth part of the grid `spec`, with the named kernel, lattice Stokeslet as far as
   it is tabulated and the closed form beyond. W[2][2][x pairs][y pairs], of a velocity component to a force component
   (velocity per force). Every rank adds the forces that are its own: the sum over ranks is the whole. Not collective.
 */
PETSC_EXTERN PetscErrorCode BoxGridAdd(const FluidSpec *spec, MPI_Comm comm, const char kernel[],
                                       const OffsetTable *lattice, const BoxAxis axis[2], PetscReal scale,
                                       PetscReal W[]);
