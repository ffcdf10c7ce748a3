/* The dense problem of one or several vesicles inside the coupled preconditioner (docs/solver.md, Preconditioner).

   M is the vesicles' mobility times h^2, with what seeps (bodies/seepage.h), v the speed of their labels, B what stands
   with their motion (contrast.h), D the rows of the membranes' law (LawBlock) and K the part of the forces' rate that a
   force has for one vesicle alone (ForcesDense). With

       N = B (I + (v/a0) d/dt) + M K/(h^2 a0),      C = D N^-1 M D^T,

   velocity and the law's unknowns sigma follow from right-hand sides U and r_s by the Schur complement C:

       U1 = N^-1 U,      sigma = C^-1 (D U1 - r_s),      U3 = U1 - N^-1 M D^T sigma.

   N and C are factored once for many solves. All is local to one rank. */
#pragma once
#include "bodies/force.h"
#include "bodies/law.h"
#include <petscblaslapack.h>

typedef struct {
  MembraneLaw law;  /* of its vesicles and their n markers */
  Forces forces;    /* borrowed */
  PetscReal *N, *C; /* LU factors of N (2n x 2n) and C (n x n) */
  PetscReal *K;     /* N^-1 M D^T, (2n x n), columns contiguous */
  PetscReal *d;     /* [n] work */
  PetscBLASInt *pivot_N, *pivot_C;
} DenseBlock;

/* DenseBlockCreate - for vesicles vesicle .. end - 1 on a grid of cells h, its law not placed. Not collective. */
PETSC_EXTERN PetscErrorCode DenseBlockCreate(Membrane membrane, Forces forces, PetscReal h, PetscInt vesicle,
                                             PetscInt end, DenseBlock *block);
PETSC_EXTERN PetscErrorCode DenseBlockDestroy(DenseBlock *block);

/* DenseBlockFactor - N and C for M = Mob[2n][2n], column behind column, a0, motion[2n][2n], the transpose of B (I +
   (v/a0) d/dt), and its law where it is placed. factored is false when a matrix is singular. Not collective. */
PETSC_EXTERN PetscErrorCode DenseBlockFactor(DenseBlock *block, PetscReal a0, const PetscReal Mob[],
                                             const PetscReal motion[], PetscBool *factored);

/* DenseBlockSolve - from nrhs columns of U[2n] and sigma[n] = r_s: sigma, and U overwritten by U3. Not collective. */
PETSC_EXTERN PetscErrorCode DenseBlockSolve(const DenseBlock *block, PetscInt nrhs, PetscScalar U[],
                                            PetscScalar sigma[]);
