/* The block of the vesicles' motion in the equations of a step, for preconditioners (docs/contrast.md): the rows of
   their velocities have B G, the motion of the labels in it,

       B G = (1 + ratio)/2 G - C_D (1 - ratio) G,      G = V + (treading/a0) dV/dt,

   B = I without viscosity contrast. */
#pragma once
#include "problem/coupling.h"

/* ContrastMatrix - out[2n][2n], zero before, of the markers first .. first + n - 1, which are whole vesicles: its
   column r is row r of B, of own markers; lattice false: with D in the place of C_D. Not collective. */
PETSC_EXTERN PetscErrorCode ContrastMatrix(Coupling coupling, PetscBool lattice, PetscInt first, PetscInt n,
                                           PetscReal out[]);

/* ContrastTread - rows of B become rows of B (1 + (treading/a0) d/dt): each column x of out[columns][2n] becomes
   (1 - (treading/a0) d/dt) x, for the markers of vesicles vesicle .. end - 1 and their treading[]. Not collective. */
PETSC_EXTERN PetscErrorCode ContrastTread(Membrane membrane, PetscInt vesicle, PetscInt end, const PetscReal treading[],
                                          PetscReal a0, PetscInt columns, PetscReal out[]);
