/* Sparse direct solution of the coupled problem: the ground truth for small grids. */
#pragma once
#include "coupling/coupling.h"

typedef struct _p_DirectSolver *DirectSolver;
struct _p_DirectSolver {
  Fluid fluid;       /* borrowed */
  Coupling coupling; /* borrowed; NULL without vesicles */
  PetscInt M;
  PetscInt *start; /* [ranks+1] first global index of each rank; sigma and U come last, on the last rank */
  KSP ksp;
  Vec x, b;
  KSPConvergedReason why; /* how the last solve ended; < 0: failed */
};

/* DirectSolverCreate - MUMPS through PETSc; the factor is made anew for every solve. Prefix direct_. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverCreate(Fluid fluid, Coupling coupling, DirectSolver *solver);
PETSC_EXTERN PetscErrorCode DirectSolverDestroy(DirectSolver *solver);

/* DirectSolverSolve - [H + B E/a0, G, S; G^T; S^T] (w, p, sigma) = (f, -bc2, g) at the coupling's markers, p of zero
   mean. The markers' velocity U = E w is an unknown of its own, so that the matrix stays sparse. Afterwards solver->why
   says how it went. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverSolve(DirectSolver solver, Vec f, Vec g, Vec w, Vec p, Vec sigma);
