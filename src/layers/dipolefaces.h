/* The lattice's velocity of one dipole on all faces that some markers' stencils read, from which the markers then take
   theirs. Where markers are about a cell apart or less this takes less than a double sum for each pair
   (StencilDipoleSums), with the same result. Nothing crosses ranks.

   Create for the markers of a body, then Answer for one dipole after another. */
#pragma once
#include "layers/latticegreen.h"

/* Faces of one component: from the lattice's entry `first` of a row on, in whole vectors. */
typedef struct {
  PetscInt row, first, vectors;
  PetscInt line, at; /* where its numbers are */
} FaceRun;

#define DIPOLE_FACE_CELLS 30   /* up to which markers share a dipole's faces: what the lattice's tables reach */
#define DIPOLE_FACE_WEIGHTS 13 /* vectors: 4 rows of two of u, 5 rows of one of v */

typedef struct {
  PetscInt n, runs[2], vectors; /* markers; runs of each component; vectors of all runs */
  PetscInt stride[2];           /* from a row to the next */
  FaceRun *run[2];
  PetscInt *at[2]; /* [n] where a marker's first face is */
  Lanes *weight;   /* [DIPOLE_FACE_WEIGHTS n] of its faces */
  PetscReal *line[DIPOLE_COUNT], *field[2];
} DipoleFaces;

/* DipoleFacesCreate - those of n markers whose unfolded stencils (cbs54) are stencil[2n]. DipoleFacesAnswer -
   free[4][n], xx, yy, xy (x from J_y), yx, of the dipole's stencils and N, times scale; `cells` are added to offsets,
   which lie within the tables but for OFFSET_LAGS. Not collective. */
PETSC_EXTERN PetscErrorCode DipoleFacesCreate(PetscInt n, const PaddedStencil stencil[], DipoleFaces *faces);
PETSC_EXTERN PetscErrorCode DipoleFacesDestroy(DipoleFaces *faces);
PETSC_EXTERN void DipoleFacesAnswer(const DipoleFaces *faces, const OffsetTable lattice[2],
                                    const PaddedStencil dipole[DIPOLE_COUNT], const PetscInt cells[2],
                                    const PetscReal N[2], PetscReal scale, PetscReal *const free[4]);
