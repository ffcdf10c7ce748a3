/* Directions of a box, and the nearest of its images: the distance d between two points becomes that of the nearest
   image, with a weight that falls from 1 to 0 at half a period. Nothing crosses ranks. */
#pragma once
#include "base/base.h"

#define BOX_PLACES 256     /* largest number of places in a direction */
#define BOX_FADED 0.3      /* of a period: the distance where half of the lattice's mobility is left out (BoxImage) */
#define BOX_WALL_PLACES 16 /* largest number of places between walls, which are Chebyshev's */

/* Places in one direction. Between walls a force may be at any of them; where the box is periodic it is at the first
   one, and W depends on the offset alone. */
typedef struct {
  PetscBool wall;
  PetscReal low, high; /* of the places (length): within the walls, or the period */
  PetscInt modes;      /* modes that are kept of W; 0 between walls */
  PetscInt places;     /* an even number: mirror images in pairs */
  PetscReal place[BOX_PLACES];
  PetscReal weight[BOX_WALL_PLACES]; /* of Chebyshev's places in the barycentric formula */
  PetscInt pairs;                    /* of a response's place a and a force's b: a * places + b, or the offset a */
} BoxAxis;

/* BoxAxisPeriodic - the axis of a period from low to high (length) with so many places, equally spaced, and modes that
   are kept. BoxAxisStretch - make an axis `factor` times as long, `from` staying where it is. Not collective. */
PETSC_EXTERN void BoxAxisPeriodic(PetscInt places, PetscInt modes, PetscReal low, PetscReal high, BoxAxis *axis);
PETSC_EXTERN void BoxAxisStretch(PetscReal from, PetscReal factor, BoxAxis *axis);

/* BoxAxisOfGrid - the axis of a direction of the box without places: what BoxImage needs. Not collective. */
static inline BoxAxis BoxAxisOfGrid(PetscBool wall, PetscReal low, PetscReal high) {
  return (BoxAxis){.wall = wall, .low = low, .high = high};
}

/* BoxAxisChebyshev - the axis with so many of Chebyshev's places (even, at most BOX_WALL_PLACES) from low to high
   (length). BoxAxisPolynomials - values[places] at x of the even halves of Lagrange's polynomials on them, then of the
   odd ones, which the mirror images of a box keep apart: an orthogonal change of the polynomials. Not collective. */
PETSC_EXTERN void BoxAxisChebyshev(PetscInt places, PetscReal low, PetscReal high, BoxAxis *axis);
PETSC_EXTERN void BoxAxisPolynomials(const BoxAxis *axis, PetscReal x, PetscReal values[]);

/* BoxImage - d[2] (length) between two points becomes that of the nearest image; returns the part of the infinite
   lattice's mobility that W leaves out: from 1 it falls to 0 at half a period, where images change, so that W is smooth
   and periodic. 1 between walls. BoxImageRow - BoxImage of n pairs, with room for whole vectors in d[2][] and part[].
   Not collective. */
PETSC_EXTERN PetscReal BoxImage(const BoxAxis axis[2], PetscReal d[2]);
PETSC_EXTERN void BoxImageRow(const BoxAxis axis[2], PetscInt n, PetscReal *const d[2], PetscReal part[]);

/* BoxSmoothStep - 0 up to low, 1 from high on. Not collective. */
static inline PetscReal BoxSmoothStep(PetscReal x, PetscReal low, PetscReal high) {
  const PetscReal t = PetscMax(0, PetscMin(1, (x - low) / (high - low)));
  return t * t * (3 - 2 * t);
}
