/* Sparse direct solution of the coupled problem: the ground truth for small grids. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_DirectSolver *DirectSolver;

/* DirectSolverCreate - MUMPS through PETSc; the factor is made anew for every solve. Prefix direct_. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverCreate(Fluid fluid, Coupling coupling, DirectSolver *solver);
PETSC_EXTERN PetscErrorCode DirectSolverDestroy(DirectSolver *solver);

/* DirectSolverSolve - [H + B E/a0, G, S; G^T; S^T] (w, p, sigma) = (f, -bc2, g) at the coupling's markers, p of zero
   mean. The markers' velocity U = E w is an unknown of its own, so that the matrix stays sparse. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverSolve(DirectSolver solver, Vec f, Vec g, Vec w, Vec p, Vec sigma);
