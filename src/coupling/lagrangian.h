/* The two Lagrangian solves of the split scheme, on marker vectors that every rank holds: each rank runs the same
   iteration, the operators inside are collective. So PETSc's sequential PCILU works on any number of ranks, and
   iteration counts do not depend on it. Any KSP or PC option works under the prefixes tension_ and bending_. */
#pragma once
#include "coupling/selfmobility.h"

/* Levels of PCILU at which its fill is complete, with nested dissection, up to a few hundred markers: markers numbered
   along a curve make Chat a cyclic band, whose fill runs along the whole curve. Only a complete one has the paper's
   iterations (docs/tension_iterations.md). */
#define COMPLETE_FILL 200

typedef struct _p_LagrangianSolver *LagrangianSolver;
struct _p_LagrangianSolver {
  Fluid fluid;       /* borrowed */
  Coupling coupling; /* borrowed */
  SelfMobility self; /* borrowed; NULL without: U = R (E u - Theta Dm^T dsigma) in place of E u */
  const char *prefix;
  KSP ksp;
  Mat A;            /* the operator, a shell */
  Mat Chat;         /* assembled approximation for the preconditioner; NULL when there is none */
  Vec w, w2, q, q2; /* work: two velocities, two pressures; w and q are zero but for their dirty rows */
  PetscInt dirty_w[2], dirty_q[2];
  Vec U;                  /* work: a marker vector */
  PetscInt its;           /* iterations of the last solve */
  KSPConvergedReason why; /* how it ended */
  PetscReal residual;     /* its last residual norm, as KSP measures it */
};

/* TensionSolverCreate - C = S^T S + S^T G L^-1 G^T S (M x M), prefix tension_, GMRES with PCILU on the assembled
   Chat = S^T S + S^T G diag(L)^-1 G^T S, relative tolerance h^2. One scalar solve an iteration. */
PETSC_EXTERN PetscErrorCode TensionSolverCreate(Fluid fluid, Coupling coupling, SelfMobility self,
                                                LagrangianSolver *solver);

/* BendingSolverCreate - I + E H^-1 B/a0 (2M x 2M), prefix bending_, GMRES, relative tolerance h^2. Two scalar solves an
   iteration. */
PETSC_EXTERN PetscErrorCode BendingSolverCreate(Fluid fluid, Coupling coupling, SelfMobility self,
                                                LagrangianSolver *solver);
PETSC_EXTERN PetscErrorCode LagrangianSolverDestroy(LagrangianSolver *solver);

/* LagrangianSolverSetUp - follow the coupling's new markers: assemble Chat where the preconditioner wants it. */
PETSC_EXTERN PetscErrorCode LagrangianSolverSetUp(LagrangianSolver solver);

/* LagrangianSolverSolve - A x = b from a zero guess; its, why and residual say how it went (why < 0: failed).
 * Collective. */
PETSC_EXTERN PetscErrorCode LagrangianSolverSolve(LagrangianSolver solver, Vec b, Vec x);

/* TensionAssemble - Chat for the coupling's markers, assembled by every rank alike. */
PETSC_EXTERN PetscErrorCode TensionAssemble(Coupling coupling, Mat *Chat);

/* KSPReplicatedSetFromOptions - options of a solver that every rank runs alike: only rank 0 prints. Collective over the
   ranks that run it. */
PETSC_EXTERN PetscErrorCode KSPReplicatedSetFromOptions(KSP ksp, PetscMPIInt rank);

/* KSPWriteOptions - a KSP's settings in force as options with this prefix, one a line. */
PETSC_EXTERN PetscErrorCode KSPWriteOptions(KSP ksp, const char prefix[], FILE *file);
