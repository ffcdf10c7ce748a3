/* The two Lagrangian solves of the split scheme, on marker and edge vectors. Any KSP or PC option works under the
   prefixes tension_ and bending_. */
#pragma once
#include "problem/coupling.h"

typedef struct _p_LagrangianSolver *LagrangianSolver;
struct _p_LagrangianSolver {
  Coupling coupling; /* borrowed */
  const char *prefix;
  KSP ksp;
  Mat A;                  /* the operator, a shell */
  PC chat;                /* factors of the assembled Chat; NULL without a preconditioner, as for bending */
  Vec all[2];             /* all edges, before and after chat */
  Forcing r;              /* work: S sigma or B X; for the tension with its divergence */
  Vec w2, q2;             /* work: a velocity and a pressure */
  Vec U;                  /* work: a marker vector */
  PetscBool failed;       /* the preconditioner could not be factored */
  PetscInt its;           /* iterations of the last solve */
  KSPConvergedReason why; /* how the last solve ended */
  PetscReal residual;     /* the last residual norm, as KSP measures it */
};

/* TensionSolverCreate - C = S^T S + S^T G L^-1 G^T S (M x M), prefix tension_, GMRES with PCILU on the assembled
   Chat = S^T S + S^T G diag(L)^-1 G^T S, relative tolerance (h over half the box's shorter side)^2. One scalar solve an
   iteration. Collective. */
PETSC_EXTERN PetscErrorCode TensionSolverCreate(Coupling coupling, LagrangianSolver *solver);

/* BendingSolverCreate - I + E H^-1 B/a0 (2M x 2M), prefix bending_, GMRES, the same relative tolerance. Two scalar
   solves an iteration. Collective. */
PETSC_EXTERN PetscErrorCode BendingSolverCreate(Coupling coupling, LagrangianSolver *solver);
PETSC_EXTERN PetscErrorCode LagrangianSolverDestroy(LagrangianSolver *solver);

/* LagrangianSolverSolve - A x = b from a zero guess, where the coupling has been placed; its, why and residual say how
   it went (why < 0: failed). A tension solve assembles Chat first, where the preconditioner wants it. Collective. */
PETSC_EXTERN PetscErrorCode LagrangianSolverSolve(LagrangianSolver solver, Vec b, Vec x);
