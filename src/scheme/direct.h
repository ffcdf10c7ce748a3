/* Sparse direct solution of the coupled problem: the ground truth for small grids. */
#pragma once
#include "coupling/solver.h"

typedef struct _p_DirectSolver *DirectSolver;
struct _p_DirectSolver {
  Coupling coupling; /* borrowed, and its fluid: */
  Fluid fluid;
  PetscInt M;
  PetscInt *start; /* [ranks+1] first global index of each rank; sigma, U and F come last, on the last rank */
  KSP ksp;
  Vec x, b;
  PetscScalar *all;       /* [2M] of all markers, work */
  KSPConvergedReason why; /* how the last solve ended; < 0: failed */
};

/* DirectSolverCreate - MUMPS through PETSc; the factor is made anew for every solve. Prefix direct_. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverCreate(Coupling coupling, DirectSolver *solver);
PETSC_EXTERN PetscErrorCode DirectSolverDestroy(DirectSolver *solver);

/* DirectSolverSolve - [H + B E/a0, G, S; G^T; S^T] with the near field, at the coupling's markers, p of zero mean (and
   w in a periodic box with alpha = 0). The markers' velocity V and the force F = Dm^T sigma/h^2 + (c_b ds/(h^2 a0)) D4
   V on them are unknowns of their own, so that the matrix stays sparse. Takes f, g and k of the problem, gives w, p,
   sigma and V. Afterwards solver->why says how it went. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverSolve(DirectSolver solver, const CoupledProblem *problem);
