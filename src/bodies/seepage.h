/* Water through the membranes of vesicles, at a speed proportional to what drives it (Kedem and Katchalsky): with the
   permeability P, the normal n outward, the jump of the fluid's normal stress, which is the normal part of the
   membrane's force, and the osmotic pressures inside, that of a fixed amount of solute, and
   outside, markers move relative to the fluid by

       -(P/l) n n^T F + P (osmotic_in A0/A - osmotic_out) n,

   F minus the force times the marker's share l of the length, A the area and A0 its first value. The matrix of F is
   symmetric and semidefinite, as that of the mobility is. No area is aimed at then. Nothing crosses ranks. */
#pragma once
#include "bodies/law.h"

/* SeepageAdd - U += alpha times this velocity of the own vesicles at their markers X[2n], F[2n] and U[2n] own parts;
   F NULL: without the first term; osmotic false: without the second one. SeepageBlock - M += h^2 B (P/l) n n^T of the
   vesicles of a law with markers X[2n], M[2n][2n] column behind column, B[2n][2n] row behind row. Not collective. */
PETSC_EXTERN void SeepageAdd(Membrane membrane, PetscReal alpha, PetscBool osmotic, const PetscReal X[],
                             const PetscScalar F[], PetscScalar U[]);
PETSC_EXTERN void SeepageBlock(MembraneLaw law, const PetscReal X[], const PetscReal B[], PetscReal M[]);
