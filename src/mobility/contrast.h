/* Viscosity contrast in the equations of a step (docs/contrast.md). Where the inner viscosity differs from the outer
   one the row of the vesicles' velocity U is

       B U - E v' + C F = ...,      B U = (1 + ratio)/2 U - C_D (1 - ratio) U,      U = V + (treading/a0) dV/dt + known.
 */
#pragma once
#include "mobility/coupling.h"

/* ContrastKnown - the part of the motion that is known before the step: moved = background + treading dY/dt, and
   k += background. Collective. */
PETSC_EXTERN PetscErrorCode ContrastKnown(Coupling coupling, Vec background, Vec Y, Vec moved, Vec k);

/* ContrastMotion - the motion G = V + (treading/a0) dV/dt + known of own V[2n]; known may be NULL. Not collective. */
PETSC_EXTERN void ContrastMotion(Coupling coupling, const PetscScalar V[], const PetscScalar known[], PetscScalar G[]);

/* ContrastAdd - y += alpha B G for a motion G, the vesicles' part of a marker vector; y is of all bodies.
   ContrastSpread - add the dipoles of the motion G to the forcing f (DoubleLayerSpread). Collective. */
PETSC_EXTERN PetscErrorCode ContrastAdd(Coupling coupling, PetscReal alpha, Vec motion, PetscScalar y[]);
PETSC_EXTERN PetscErrorCode ContrastSpread(Coupling coupling, Vec motion, Forcing *f);

/* ContrastMatrix - out[2n][2n], zero before, of the markers first .. first + n - 1, which are whole vesicles: its
   column r is row r of B (1 + (treading/a0) d/dt), of own markers; lattice false: with D in the place of C_D. Not
   collective. */
PETSC_EXTERN PetscErrorCode ContrastMatrix(Coupling coupling, PetscBool lattice, PetscReal a0, PetscInt first,
                                           PetscInt n, PetscReal out[]);

/* ContrastTread - the labels' part of such a matrix: each column x of out[columns][2n] becomes (1 - (treading/a0) d/dt)
   x, for the markers of vesicles vesicle .. end - 1 and their treading[]. Not collective. */
PETSC_EXTERN PetscErrorCode ContrastTread(Membrane membrane, PetscInt vesicle, PetscInt end, const PetscReal treading[],
                                          PetscReal a0, PetscInt columns, PetscReal out[]);
