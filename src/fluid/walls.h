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
  PetscReal *cross[2];    /* modes of the walls in x (in y) to slip along the walls in y (in x), a row a face */
  PetscInt *row[2];       /* where a row starts: modes that do not reach its face are left out */
  PetscReal *profile[2];  /* [modes][2][n] flow of a mode by the distance from its wall: along it, away from it */
  PetscInt modes[2];      /* of it that are kept: what reaches far */
  double *low[2][2];      /* [modes] sine amplitudes of the forces last found */
  PetscInt markers;
  PetscReal *flow;    /* [modes of all walls][2 markers] velocity of each mode */
  PetscReal *slip;    /* [n] work */
  double *line[2][2]; /* [wall in x or y][side]: work */
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

/* WallsSetMarkers - the flow of the wall forces' long waves at markers X[2M], for WallsMarkerVelocity. Where only one
   direction has walls there is none. Not collective. */
PETSC_EXTERN PetscErrorCode WallsSetMarkers(Walls walls, PetscInt M, const PetscScalar X[]);

/* WallsMarkerVelocity - U[2M] += alpha times the velocity at the markers of the forces that WallsPrecondition found
   last. Not collective. */
PETSC_EXTERN PetscErrorCode WallsMarkerVelocity(Walls walls, PetscReal alpha, PetscScalar U[]);
