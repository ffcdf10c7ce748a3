/* Pairs of markers in the double layer, and blocks of them: the velocity of one body's markers by the jumps of the
   velocity J at another one's, or at its image. A marker of the outward normal n and of the share w of the length is a
   tensor dipole w (J n + n J) with the source w J.n; a block is

       C = D - L Q,

   D the stresslet of unbounded fluid, on a curve itself with its limit by the curvature, L what the same dipole gives
   on the infinite lattice (latticegreen.h), Q what takes the net flux SUM w J.n off a body, as spreading on the grid
   does; walls add doubleimage.h. Near pairs take L from sums over stencils, those about a cell apart together
   (dipolefaces.h), distant ones from a closed form. In unbounded fluid C = D.

   Unlike the single layer's, C has no symmetry, so each pair of bodies has two blocks, each where its row is owned.
   Nothing crosses ranks. */
#pragma once
#include "layers/doubleimage.h"
#include "layers/finecurve.h"
#include "layers/singlepairs.h"

#define DOUBLE_FACE_CELLS                                                                                              \
  30 /* up to which markers share a dipole's faces: what the lattice's tables reach, at least                          \
      */

/* Response of an own body to an image of another one: a matrix of 2n rows, columns one after another, entries
   interlaced. */
typedef struct {
  PetscInt row, column;
  PetscReal shift[2]; /* of the column (length) */
  size_t at;          /* in the list's values */
} DoubleBlock;

/* What pairs have besides the single layer's, where the markers have been placed; all borrowed. */
typedef struct {
  SinglePairs single;              /* stencils of the markers' velocities */
  const OffsetTable *lattice;      /* [2] LatticeDipoles; not read in unbounded fluid, as the next two */
  DoubleImage image;               /* what walls add */
  const PaddedStencil *dipole;     /* [DIPOLE_COUNT M] unfolded */
  const PetscReal *normal, *along; /* [2M] n w, [M] w (length), of bodies that have a jump */
  const PetscReal *length;         /* [bodies] SUM w */
} DoublePairs;

/* DoubleBlockFill - C of a block or, without lattice, D, [2 n_column][2 n_row], with finer points of images in walls
   that are near. DoubleBlockRefine - to the block the difference between finer points of two curves near one another,
   or of one and an image, and their markers. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleBlockFill(const DoublePairs *pairs, const DoubleBlock *block, PetscBool lattice,
                                            PetscReal value[]);
PETSC_EXTERN PetscErrorCode DoubleBlockRefine(const DoublePairs *pairs, const FinePair *fine, PetscReal value[]);

/* DoubleSelf - D of a closed curve with itself from its n markers X and their n w: [2n][2n]. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleSelf(Spectral spectral, PetscInt n, const PetscReal X[], const PetscReal normal[],
                                       PetscReal D[]);

/* DoubleGeometry - n w [2n] and w [n] of a curve's markers: the derivative by the label, turned. Not collective. */
PETSC_EXTERN PetscErrorCode DoubleGeometry(Spectral spectral, PetscInt n, const PetscReal X[], PetscReal normal[],
                                           PetscReal along[]);

/* DoubleLatticeParts - what the lattice's tables (LatticeDipoles) give of unit parts of a dipole at a marker,
   K[component of the velocity][part]: responses' and dipole's stencils, `cells` added to their offset, d from source to
   target; beyond `reach` by the closed form. All lengths in cells. Not collective. */
PETSC_EXTERN void DoubleLatticeParts(const OffsetTable lattice[2], PetscReal reach, const PaddedStencil response[2],
                                     const PaddedStencil dipole[DIPOLE_COUNT], const PetscInt cells[2],
                                     const PetscReal d[2], PetscReal K[2][DIPOLE_COUNT]);
