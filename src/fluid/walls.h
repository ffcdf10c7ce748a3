/* Wall forces: tangential forces on the faces next to the walls that make the projection exact (channel.c tells why).
   One unknown a face, in one array that all ranks hold: the rows of u along the bottom and the top wall, then the
   columns of v along the left and the right wall. */
#pragma once
#include "fluid/stokes.h"
#include <fftw3.h>

typedef struct _p_Walls *Walls;
struct _p_Walls {
  Fluid fluid;            /* borrowed */
  PetscInt n;             /* unknowns */
  PetscInt length[2];     /* of one wall's line, for the walls in x and in y; 0 without such walls */
  PetscInt start[2];      /* of the first wall's line, the other one follows */
  PetscReal alpha;        /* coefficient that the inverse is for; -1 none yet */
  PetscReal *own, *other; /* [n/2] inverse of a pair of walls, mode by mode */
  double *line[2][2];     /* [wall in x or y][side]: work */
  fftw_plan forward[2][2], backward[2][2];
};

/* WallsCreate - the unknowns of a fluid: none where the Stokes solve is exact (StokesIsExact). Collective. */
PETSC_EXTERN PetscErrorCode WallsCreate(Fluid fluid, Walls *walls);
PETSC_EXTERN PetscErrorCode WallsDestroy(Walls *walls);

/* WallsAdd - r += the force d[n] on the faces next to the walls. Not collective. */
PETSC_EXTERN PetscErrorCode WallsAdd(Walls walls, const PetscScalar d[], Vec r);

/* WallsSlip - y[n] = -2 nu/h^2 times the slope of the potential psi along the walls: the momentum that the projection
   leaves there. Collective. */
PETSC_EXTERN PetscErrorCode WallsSlip(Walls walls, Vec psi, PetscScalar y[]);

/* WallsPrecondition - d := approximate inverse of d -> d + slip of the projected force d: exact for one pair of
   opposite walls, for two pairs by sweeps of block Gauss-Seidel. Not collective. */
PETSC_EXTERN PetscErrorCode WallsPrecondition(Walls walls, PetscScalar d[]);
