/* Walls in x of a solve by stream function (stream.c), which makes chi of sines: chi = 0 on walls in x is the flow
   between walls without friction, where v has no slope. Walls that hold the fluid have -v beyond them. So they are a
   force on the faces of v next to them,

       d = -c v,   c = 2 nu/h^2,   v = v_F + B d,

   v_F without them, B the velocity at these faces that unit forces there drive between walls without friction:
   (1 + c B) d = -c v_F. By the mirror symmetries in x and y this is four systems of half a wall's faces
   (docs/fluid.md, Side walls). */
#pragma once
#include "fluid/transforms/modefactors.h"
#include "fluid/transforms/rowtransform.h"

#define SIDE_SYMMETRIES 4

typedef struct _p_SideWalls *SideWalls;
struct _p_SideWalls {
  Grid grid;              /* borrowed */
  ModeFactors factors;    /* borrowed */
  PetscReal alpha;        /* coefficient that the inverses are for; -1 none yet */
  PetscInt faces, half;   /* faces of v along a wall, and those up to the middle */
  PetscInt *even;         /* [modes] whether a mode's chi is the same next to both walls */
  PetscReal *curl[2];     /* [width] modes of h times the curl of a unit force on a face next to the left, right wall */
  PetscReal *velocity[2]; /* [width] v next to a wall of a mode of chi/h */
  PetscReal *inverse[SIDE_SYMMETRIES]; /* [half][half] of 1 + c B, NULL at first: v the same on both walls or opposite,
                                          from row to row downwards the same or opposite */
  PetscReal *v[2];                     /* [faces] v at the left and at the right wall (length/time), one array */
  PetscReal *d[2];                     /* [faces] forces at the left and at the right wall (length/time^2), one array */
  PetscReal *work;                     /* [2][half] */
};

/* SideWallsCreate - for rows of a grid with walls both ways, t their transform, as long as the walls are in x. Not
   collective. */
PETSC_EXTERN PetscErrorCode SideWallsCreate(Grid grid, RowTransform t, ModeFactors factors, SideWalls *walls);
PETSC_EXTERN PetscErrorCode SideWallsDestroy(SideWalls *walls);

/* SideWallsSet - for alpha (1/time) and nu (length^2/time), for which the factors are. Errors: no room. Not
   collective. */
PETSC_EXTERN PetscErrorCode SideWallsSet(SideWalls walls, PetscReal alpha, PetscReal nu);

/* SideWallsForces - d of the own rows' v_F, which is in v, for all rows. Collective. */
PETSC_EXTERN PetscErrorCode SideWallsForces(SideWalls walls, PetscReal nu);
