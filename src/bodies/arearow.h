/* The area target of a step (docs/membrane.md, The area target): of a vesicle's equation of motion r = 0 the part along
   the gradient z of its area, |z| = 1 over all its markers, gives way to z.V = s, the area that the step aims at,
       r := r - z (z.r) + ratio z (z.V - s),      ratio that of the viscosities, 1 without contrast.
   Next to nothing is lost: a pressure, a force along z, moves nothing in a fluid that keeps its volume. */
#pragma once
#include "bodies/membrane.h"

typedef struct _p_AreaRow *AreaRow;
struct _p_AreaRow {
  Membrane membrane; /* borrowed */
  PetscReal *ratio;  /* [vesicles] */
  PetscReal *z;      /* [2n] of the own vesicles, */
  PetscReal *speed;  /* [vesicles] and s (length/time) */
};

/* AreaRowCreate - ratio[vesicles], NULL: all 1. Not collective. */
PETSC_EXTERN PetscErrorCode AreaRowCreate(Membrane membrane, const PetscReal ratio[], AreaRow *row);
PETSC_EXTERN PetscErrorCode AreaRowDestroy(AreaRow *row);

/* AreaRowPlace - aims at the first area A0 of each own vesicle, linearised at the markers Xstar:
   grad A.(Xhat + (background + V)/a0 - Xstar) = A0 - A(Xstar), for marker vectors. Not collective. */
PETSC_EXTERN PetscErrorCode AreaRowPlace(AreaRow row, PetscReal a0, Vec Xstar, Vec Xhat, Vec background);

/* AreaRowReplace - in y[2n], what the own vesicles' motion V[2n] leaves of its equation; aimed false: with s = 0, for
   a product with the operator. Not collective. */
PETSC_EXTERN void AreaRowReplace(AreaRow row, PetscBool aimed, const PetscScalar V[], PetscScalar y[]);
