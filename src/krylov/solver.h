/* The solve of one step's coupled problem (problem/residual.h) by FGMRES, prefix coupled_, with the preconditioner of
   precondition.h (docs/solver.md, Reduced unknowns). A solve adds corrections to the unknowns x, each followed by the
   whole residual (one Stokes solve), until the residual is within the tolerance. On the grid the first correction is
   the preconditioned residual, which is often enough; the others are by KSPSolve. */
#pragma once
#include "precondition/precondition.h"
#include "problem/residual.h"

/* How a solve went. */
typedef struct {
  PetscInt its;
  KSPConvergedReason why;  /* negative: the solve failed */
  PetscReal residual;      /* norm of the last residual */
  StreamMeasures measures; /* measures of the velocity on the grid */
} SolveReport;

typedef struct _p_CoupledSolver *CoupledSolver;
struct _p_CoupledSolver {
  Coupling coupling; /* borrowed */
  Unknowns unknowns;
  Reduced reduced;
  Preconditioner preconditioner;
  KSP ksp;
  PetscBool guess;     /* -coupled_ksp_initial_guess_nonzero: start from the guess */
  Vec x, b;            /* unknowns, residual */
  Vec change;          /* one correction of x */
  PetscReal reference; /* norm of the step's right-hand side; the tolerance is relative to it */
  PetscReal start;     /* residual norm that a KSPSolve starts from */
};

/* CoupledSolverCreate - for the scene's preconditioner and tolerance. Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverCreate(Scene scene, Coupling coupling, CoupledSolver *solver);
PETSC_EXTERN PetscErrorCode CoupledSolverDestroy(CoupledSolver *solver);

/* CoupledSolverSolve - solve where the coupling has been placed (CouplingPlace). Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverSolve(CoupledSolver solver, const CoupledProblem *problem,
                                               SolveReport *report);
