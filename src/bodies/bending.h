/* Bending (docs/membrane.md, Membrane). D4 = (D+D-)(D+D-) is of the fixed spacing ds, or the spectral derivative. A
   membrane with a shape memory prefers the curvature kappa0 of its rest shape: with J a quarter turn to the left, D1
   and D2 the spectral derivatives by the arc length, and

       B = D2 - kappa0 J D1,

   B^T B stands for D4: constant, symmetric and without effect on a rigid motion. */
#pragma once
#include "bodies/force.h"

/* MembraneVesicleBending - minus the bending force of one vesicle, with D4 = (D+D-)(D+D-) of the fixed spacing ds:

     F += alpha part ds D4 X      (with a shape memory B^T B for D4).

   alpha has the largest c_b as a factor. The matrix is symmetric. MembraneBending - F of all own vesicles. */
PETSC_EXTERN void MembraneVesicleBending(Membrane membrane, PetscInt vesicle, PetscReal alpha, const PetscScalar X[],
                                         PetscScalar F[]);
PETSC_EXTERN void MembraneBending(Membrane membrane, PetscReal alpha, const PetscScalar X[], PetscScalar F[]);

/* MembraneBendingEnergy - of one vesicle:

     E_B = c_b/2 SUM |D+D- X|^2 ds      (37; with a shape memory |B X|^2) */
PETSC_EXTERN PetscReal MembraneBendingEnergy(Membrane membrane, PetscInt vesicle, const PetscScalar X[]);
