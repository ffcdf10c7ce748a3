/* Water through the membranes of vesicles, at a speed proportional to what drives it (Kedem and Katchalsky): with the
   permeability P, the normal n outward, the jump of the fluid's pressure as the normal part of the membrane's force,
   which viscous stresses are small beside, and the osmotic pressures inside, that of a fixed amount of solute, and
   outside, markers move relative to the fluid by

       -(P/l) n n^T F + P (osmotic_in A0/A - osmotic_out) n,

   F minus the force times the marker's share l of the length, A the area and A0 its first value. The matrix is
   symmetric and semidefinite, as that of the mobility is, and joins it. No area is aimed at then. Nothing crosses
   ranks. */
#pragma once
#include "bodies/membrane.h"

/* SeepageApply - U += alpha (P/l) n n^T F of the own vesicles, at the markers X[2M] of all; F[2n] and U[2n] are own
   parts. SeepageAdd - the same matrix of one vesicle with markers X[2n], times alpha, added to K, whose columns have
   `rows` numbers. SeepageOsmotic - U += the osmotic velocity of the own vesicles, at
   their markers X[2n]. Not collective. */
PETSC_EXTERN void SeepageApply(Membrane membrane, const PetscReal X[], PetscReal alpha, const PetscScalar F[],
                               PetscScalar U[]);
PETSC_EXTERN void SeepageAdd(Membrane membrane, PetscInt vesicle, const PetscReal X[], PetscReal alpha, PetscInt rows,
                             PetscReal K[]);
PETSC_EXTERN void SeepageOsmotic(Membrane membrane, const PetscReal X[], PetscScalar U[]);
