/* Ellipses at random or on a lattice in a box, so that no two ellipses, images or walls touch.

   Ellipses are tested as slightly longer ones, so that a gap is left between them. At random, they start small at
   random places, move by Monte Carlo steps, and each grows where it has room, until all have their size; then they move
   on for some sweeps. Centres are in a list of cells, so that the time is in proportion to the number of ellipses.
   Random numbers are those of splitmix64, and no function of the C library but the square root is called: the same seed
   gives the same packing everywhere. All functions work on one rank. */
#pragma once
#include "base/base.h"

typedef struct {
  PetscReal box[4];      /* x_min, x_max, y_min, y_max (length) */
  PetscBool periodic[2]; /* in x, in y; FALSE: there are walls */
  PetscReal gap;         /* least distance of any two ellipses (length) */
  PetscReal wall_gap;    /* least distance of an ellipse and a wall, at least `gap` (length) */
  PetscInt seed;
} PackingSpec;

/* Where an ellipse lies: its centre, and the unit vector along its first semi-axis. */
typedef struct {
  PetscReal center[2], along[2];
} Pose;

/* PackRandomly - random places and directions of n ellipses with the semi-axes axes[2n]. part: the part of the
   ellipses' area that has reached its size; 1 unless there was no room within a fixed number of sweeps. Not collective.
   Errors: memory. */
PETSC_EXTERN PetscErrorCode PackRandomly(const PackingSpec *spec, PetscInt n, const PetscReal axes[], Pose pose[],
                                         PetscReal *part);

/* PackLattice - n ellipses row by row on the rectangular lattice that gives them most room, all in the direction
   `along`. part: the square of the largest scale, at most 1, at which all have room. Not collective. Errors: memory. */
PETSC_EXTERN PetscErrorCode PackLattice(const PackingSpec *spec, PetscInt n, const PetscReal axes[],
                                        const PetscReal along[2], Pose pose[], PetscReal *part);
