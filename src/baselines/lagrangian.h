/* The two Lagrangian solves of the split scheme, on marker and edge vectors. Any KSP or PC option works under the
   prefixes tension_ and bending_. */
#pragma once
#include "coupling/coupling.h"
#include "coupling/rootpc.h"

/* Levels of PCILU at which its fill is complete, with nested dissection, up to a few hundred markers: markers numbered
   along a curve make Chat a cyclic band, whose fill runs along the whole curve. Only a complete one has the paper's
   iterations (docs/reproduction/tension.md). */
#define COMPLETE_FILL 200

typedef struct _p_LagrangianSolver *LagrangianSolver;
struct _p_LagrangianSolver {
  Coupling coupling; /* borrowed */
  const char *prefix;
  KSP ksp;
  Mat A;                  /* the operator, a shell */
  RootPC chat;            /* tension: preconditioner of the assembled approximation; NULL for bending */
  Forcing r;              /* work: S sigma or B X; for the tension with its divergence */
  Vec w2, q2;             /* work: a velocity and a pressure */
  Vec U;                  /* work: a marker vector */
  PetscBool failed;       /* the preconditioner could not be factored */
  PetscInt its;           /* iterations of the last solve */
  KSPConvergedReason why; /* how it ended */
  PetscReal residual;     /* its last residual norm, as KSP measures it */
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
