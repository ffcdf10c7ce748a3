/* Obstacles that stand on a wall of the box: curves whose ends are there. */
#pragma once
#include "scene/spec.h"

/* ArcCut - which part of an open curve carries markers, part[2] of its parameter: from where it is half a marker
   spacing off the wall that its ends are on, wall = 2 direction + side, to where it is so again. b: its number, for
   messages. Collective; stops with the user's message. */
PETSC_EXTERN PetscErrorCode ArcCut(Scene scene, PetscInt b, const Curve *curve, PetscReal part[2], PetscInt *wall);

/* ArcBump - one bump of a constriction, (1 - throat)/2 of the channel high in its middle, a whole wave of a cosine
   long, on the lower (side 0) or the upper wall in y. Not collective. */
PETSC_EXTERN PetscErrorCode ArcBump(Scene scene, int side, Curve *curve);
