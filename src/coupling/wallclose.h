/* Membranes nearer to a wall than to their next marker: Blake's image between them on finer points. */
#pragma once
#include "coupling/nearfield.h"

/* How many times the markers the finer points are, and how far from an image they count (length). */
typedef struct {
  PetscInt factor;
  PetscReal window;
} WallCloseness;

/* WallIsClose - whether two vesicles' images in a wall are nearer than two marker spacings. Not collective. */
PETSC_EXTERN PetscBool WallIsClose(NearField near, PetscInt row, PetscInt column, int direction, int side,
                                   WallCloseness *close);

/* NearBlockRefineAtWalls - to the block between two curves, or of one with itself, whose images in a wall are nearer
   than two marker spacings, the difference between Blake's image on finer points of both and on the markers; nothing
   elsewhere, nor for curves that are not closed: the first marker of an open one is half a spacing off its wall. Not
   collective. */
PETSC_EXTERN PetscErrorCode NearBlockRefineAtWalls(NearField near, const NearBlock *block);
