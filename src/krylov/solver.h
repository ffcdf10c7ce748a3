/* The solve of one step's coupled problem (problem/residual.h) by FGMRES, prefix coupled_, with the preconditioner of
   precondition.h (docs/solver.md, Reduced unknowns). A solve is made of rounds: a residual by a Stokes solve, a
   KSPSolve for the change, and the residual again, until it is within the tolerance. */
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

typedef enum { TRIAL_NONE, TRIAL_WANTED, TRIAL_MADE } TrialState;

/* The trial of a solve. Its first product is made at x + scale z, z the preconditioned residual, and is a whole
   residual: where that is small enough the solve ends with it. The forces of x + scale z are then in the problem's f.
 */
typedef struct {
  TrialState state;
  PetscReal scale, residual; /* norms of the residual at x and at the trial */
  Vec x, b;                  /* unknowns and residual of the trial */
} Trial;

typedef struct _p_CoupledSolver *CoupledSolver;
struct _p_CoupledSolver {
  Coupling coupling; /* borrowed */
  Unknowns unknowns;
  Reduced reduced;
  Preconditioner preconditioner;
  Mat A; /* the operator of the reduced problem, with the trial */
  KSP ksp;
  Trial trial;
  PetscBool guess;     /* -coupled_ksp_initial_guess_nonzero: start from the guess */
  Vec x, b;            /* unknowns, residual */
  Vec change;          /* solution of one KSPSolve */
  Vec pending;         /* part of x whose forces are not in the problem's f */
  PetscReal reference; /* norm of the step's right-hand side; the tolerance is relative to it */
  PetscReal start;     /* residual norm that a KSPSolve starts from */
};

/* CoupledSolverCreate - for the scene's preconditioner and tolerance. Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverCreate(Scene scene, Coupling coupling, CoupledSolver *solver);
PETSC_EXTERN PetscErrorCode CoupledSolverDestroy(CoupledSolver *solver);

/* CoupledSolverSolve - solve where the coupling has been placed (CouplingPlace). Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverSolve(CoupledSolver solver, const CoupledProblem *problem,
                                               SolveReport *report);
