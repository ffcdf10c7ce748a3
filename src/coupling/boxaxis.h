/* Directions of a box, and the nearest of its images. */
#pragma once
#include "scene/fluidspec.h"

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
