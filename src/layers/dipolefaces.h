/* The lattice's velocity of one dipole on all faces that some markers' stencils read, from which the markers then take
   theirs. Where markers are about a cell apart or less this takes less than a double sum for each pair
   (StencilDipoleSums), with the same result. Nothing crosses ranks.

   Create for the markers of a body, then Answer for one dipole after another. */
#pragma once
#include "layers/latticegreen.h"

#define DIPOLE_FACE_CELLS 30 /* up to which markers share a dipole's faces: what the lattice's tables reach */

typedef struct {
  PetscInt n;                   /* markers */
  const PaddedStencil *stencil; /* [2n] borrowed */
  PetscInt first[2][2];         /* of each component: the first face along x and along y, */
  PetscInt rows[2], columns[2]; /* how many, along x in whole vectors, */
  PetscInt stride[2];           /* and from a row to the next */
  PetscReal *field[2];          /* [rows][stride] answers to J_x and J_y */
} DipoleFaces;

/* DipoleFacesCreate - those of n markers whose unfolded stencils are stencil[2n], of cbs54, with at most STENCIL_ROW
   faces along x. DipoleFacesAnswer - free[4][n], xx, yy, xy (x from J_y), yx, of the dipole's stencils and N, times
   scale; `cells` are added to offsets, which lie within the tables but for OFFSET_LAGS. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleFacesCreate(PetscInt n, const PaddedStencil stencil[], DipoleFaces *faces);
PETSC_EXTERN PetscErrorCode DipoleFacesDestroy(DipoleFaces *faces);
PETSC_EXTERN void DipoleFacesAnswer(const DipoleFaces *faces, const OffsetTable lattice[2],
                                    const PaddedStencil dipole[DIPOLE_COUNT], const PetscInt cells[2],
                                    const PetscReal N[2], PetscReal scale, PetscReal *const free[4]);
