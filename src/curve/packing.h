/* Ellipses at random or on a lattice in a box, none touching another, an image of one or a wall. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscReal box[4];      /* x_min, x_max, y_min, y_max (length) */
  PetscBool periodic[2]; /* in x, in y; else there are walls */
  PetscReal gap;         /* least distance of any two ellipses (length) */
  PetscReal wall_gap;    /* of an ellipse and a wall, at least `gap` */
  PetscInt seed;         /* the same one gives the same packing */
} PackingSpec;

/* Where an ellipse lies: its centre, and the unit vector along its first semi-axis. */
typedef struct {
  PetscReal center[2], along[2];
} Pose;

/* PackRandomly - random places and directions of n ellipses with the semi-axes axes[2n]: they start small at random
   places, move by Monte Carlo steps, and each grows where it has room, until all have their size; then they move on for
   a while. part: of the ellipses' area, what has reached its size (1: all; else there was no room within a fixed number
   of sweeps). The time is in proportion to n. PackLattice - n ellipses row by row on the rectangular lattice that gives
   them most room, all turned like `along`; part: the square of the scale, at most 1, at which they have room. The
   numbers are those of splitmix64, and no function of the library of C but square roots is called. Not collective.
   Errors: memory. */
PETSC_EXTERN PetscErrorCode PackRandomly(const PackingSpec *spec, PetscInt n, const PetscReal axes[], Pose pose[],
                                         PetscReal *part);
PETSC_EXTERN PetscErrorCode PackLattice(const PackingSpec *spec, PetscInt n, const PetscReal axes[],
                                        const PetscReal along[2], Pose pose[], PetscReal *part);
