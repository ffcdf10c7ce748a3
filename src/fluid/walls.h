/* Wall forces: tangential forces on the faces next to the walls that make the projection exact, where StokesSolve is
   not (channel.c tells why, docs/fluid.md, "Wall forces", how they are found). One unknown a face, in one array that
   all ranks hold: the rows of u along the bottom and the top wall, then the columns of v along the left and the right
   wall. Unit: a force per volume, length/time^2. */
#pragma once
#include "fluid/sinematrix.h"
#include "fluid/stokes.h"
#include <fftw3.h>

/* Slip that the forces of one pair of walls leave along the walls of the other pair: a matrix from modes to faces,
   which keeps of each face the modes that reach it. Empty where only one pair exists. */
typedef struct {
  PetscReal *value; /* row by row */
  PetscInt *row;    /* [faces + 1] where a face's row starts; rows are whole vectors (LANES) */
} CrossSlip;

/* Flow that the longest waves of a pair's forces drive inside the box. None where only one pair exists. */
typedef struct {
  PetscInt modes, room; /* that are kept; in whole vectors (LANES), of which the rest is zero */
  PetscReal *profile;   /* [n][2][room] velocity by the distance from the wall: along it, away from it */
  double *amplitude[2]; /* [side][room] sine amplitudes of the forces last found */
} LongWaves;

/* Two walls that face one another: a line is one number for each face next to one of them. */
typedef struct {
  PetscInt length;             /* of a line; 0: no such walls */
  PetscInt start;              /* of the first wall's line among the unknowns; the other one's follows */
  PetscReal *own, *other;      /* [length] a mode's force per residual on the same wall, and on the facing one */
  double *spare;               /* [length] takes a line's place at its transform by a matrix */
  double *line[2];             /* [side][length and zeros] residuals, then the modes of the forces that cancel them */
  SineMatrix sines;            /* of short lines, in the place of the plans; twice the sums, as FFTW's */
  fftw_plan forward, backward; /* of either line; the same one where they do the same */
  CrossSlip cross;
  LongWaves waves;
} WallPair;

typedef struct _p_Walls *Walls;
struct _p_Walls {
  Fluid fluid;        /* borrowed */
  PetscInt n;         /* unknowns */
  PetscReal alpha;    /* coefficient that the inverse is for; -1 none yet */
  WallPair pair[2];   /* walls in x (left and right), walls in y (bottom and top) */
  PetscReal *slip;    /* [n] work */
  PetscReal *work[3]; /* [n_x or n_y, the larger one] */
  PetscInt markers;
  PetscReal *flow; /* [markers][walls][2][room] velocity of each long wave at the markers */
};

/* WallsCreate - the unknowns of a fluid: none where the Stokes solve is exact (StokesIsExact). Not collective. */
PETSC_EXTERN PetscErrorCode WallsCreate(Fluid fluid, Walls *walls);
PETSC_EXTERN PetscErrorCode WallsDestroy(Walls *walls);

/* WallsAdd - r += the force d[n] on the faces next to the walls. WallsClear - r = 0 there. Not collective. */
PETSC_EXTERN PetscErrorCode WallsAdd(Walls walls, const PetscScalar d[], Vec r);
PETSC_EXTERN PetscErrorCode WallsClear(Walls walls, Vec r);

/* WallsSlip - y[n] = -2 nu/h^2 times the slope of the potential psi along the walls: the momentum that the projection
   leaves there. The same bits on every rank. Collective. */
PETSC_EXTERN PetscErrorCode WallsSlip(Walls walls, Vec psi, PetscScalar y[]);

#define WALLS_SWEEPS 5 /* leave 1e-3 in a box of equal sides: a preconditioner's */

/* WallsInvert - d := inverse of d -> d + slip of the projected force d: exact for one pair of walls, for two pairs by
   sweeps of block Gauss-Seidel, of which one leaves about a third. Every rank computes the whole. Not collective. */
PETSC_EXTERN PetscErrorCode WallsInvert(Walls walls, int sweeps, PetscScalar d[]);

/* WallsSetMarkers - the flow of the wall forces' long waves at markers X[2M], for WallsMarkerVelocity. Where only one
   direction has walls there is none. Not collective. */
PETSC_EXTERN PetscErrorCode WallsSetMarkers(Walls walls, PetscInt M, const PetscScalar X[]);

/* WallsMarkerVelocity - U[2M] += alpha times the velocity at the markers of the forces that WallsInvert found
   last. Not collective. */
PETSC_EXTERN PetscErrorCode WallsMarkerVelocity(Walls walls, PetscReal alpha, PetscScalar U[]);
