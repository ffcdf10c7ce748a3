/* The coupled solve of one step: FGMRES, prefix coupled_, on the reduced problem (docs/solver.md, Reduced unknowns). */
#pragma once
#include "coupling/precondition.h"
#include "coupling/reduced.h"

/* How a solve went. */
typedef struct {
  PetscInt its;
  KSPConvergedReason why; /* < 0: failed */
  PetscReal residual;
  StreamMeasures measures; /* of the velocity, where w is NULL */
} SolveReport;

typedef enum { TRIAL_NONE, TRIAL_WANTED, TRIAL_MADE } TrialState;

/* What the first product of a solve leaves behind where fluid/stream.h makes products: the whole residual at x + scale
   z, the forces of which are in f then. */
typedef struct {
  TrialState state;
  PetscReal scale, residual; /* norms of the residual before and at it */
  Vec x, b;                  /* the unknowns and the residual there */
} Trial;

typedef struct _p_CoupledSolver *CoupledSolver;
struct _p_CoupledSolver {
  Coupling coupling; /* borrowed */
  Unknowns unknowns;
  Reduced reduced;
  Preconditioner preconditioner;
  Mat A; /* the reduced problem's */
  KSP ksp;
  Trial trial;
  PetscBool guess;     /* -coupled_ksp_initial_guess_nonzero: start from the guess */
  Vec x, b;            /* unknowns, residual */
  Vec change;          /* of one KSPSolve */
  Vec pending;         /* part of x whose forces are not in the right-hand side f yet */
  PetscReal reference; /* norm of the step's right-hand side, which the tolerance is relative to */
  PetscReal start;     /* residual norm that a KSPSolve starts from */
};

/* CoupledSolverCreate - for the scene's preconditioner and tolerance. Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverCreate(Scene scene, Coupling coupling, CoupledSolver *solver);
PETSC_EXTERN PetscErrorCode CoupledSolverDestroy(CoupledSolver *solver);

/* CoupledSolverSolve - solve where the coupling has been placed (CouplingPlace). Collective. */
PETSC_EXTERN PetscErrorCode CoupledSolverSolve(CoupledSolver solver, const CoupledProblem *problem,
                                               SolveReport *report);
