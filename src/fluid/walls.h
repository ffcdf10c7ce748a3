/* Wall forces: tangential forces on the faces next to the walls that make the projection exact, where StokesSolve is
   not (channel.c tells why, docs/fluid.md, "Wall forces", how they are found). One unknown a face, in one array that
   all ranks hold: the rows of u along the bottom and the top wall, then the columns of v along the left and the right
   wall. Unit: a force per volume, length/time^2. */
#pragma once
#include "fluid/stokes.h"
#include <fftw3.h>

/* Two walls that face one another: a line is one number for each face next to one of them. */
typedef struct {
  PetscInt length;             /* of a line; 0: no such walls */
  PetscInt start;              /* of the first wall's line among the unknowns; the other one's follows */
  PetscReal *own, *other;      /* [length] a mode's force per residual on the same wall, and on the facing one */
  double *line[2];             /* [side][length] residuals, then the modes of the forces that cancel them */
  fftw_plan forward, backward; /* of either line; the same one where they do the same */
} WallPair;

typedef struct _p_Walls *Walls;
struct _p_Walls {
  Fluid fluid;        /* borrowed */
  PetscInt n;         /* unknowns */
  PetscReal alpha;    /* coefficient that the inverse is for; -1 none yet */
  WallPair pair[2];   /* walls in x (left and right), walls in y (bottom and top) */
  PetscReal *work[3]; /* [n_x or n_y, the larger one] */
};

/* WallsCreate - the unknowns of a fluid: none where the Stokes solve is exact (StokesIsExact). Not collective. */
PETSC_EXTERN PetscErrorCode WallsCreate(Fluid fluid, Walls *walls);
PETSC_EXTERN PetscErrorCode WallsDestroy(Walls *walls);

/* WallsAdd - r += the force d[n] on the faces next to the walls. Not collective. */
PETSC_EXTERN PetscErrorCode WallsAdd(Walls walls, const PetscScalar d[], Vec r);

/* WallsSlip - y[n] = -2 nu/h^2 times the slope of the potential psi along the walls: the momentum that the projection
   leaves there. The same bits on every rank. Collective. */
PETSC_EXTERN PetscErrorCode WallsSlip(Walls walls, Vec psi, PetscScalar y[]);

/* WallsInvert - d := inverse of d -> d + slip of the projected force d, for one pair of walls; of two, the slip that
   the forces of each leave along the other is left out. Every rank computes the whole. Not collective. */
PETSC_EXTERN PetscErrorCode WallsInvert(Walls walls, PetscScalar d[]);
