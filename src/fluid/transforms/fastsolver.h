/* Fast scalar solves: (a0 I - nu second differences) x = b for one field of the grid. Back ends stand behind
   one interface, which is a PETSc PCSHELL too.

   A back end that iterates may fail. Then the solution is set to infinity on every rank, and `failure` says why. What
   iterates on this solve, an outer Krylov method or a step, stops at once at a number that is not finite, on all ranks
   alike; whoever reports the failed step asks for the reason. */
#pragma once
#include "fluid/grid/grid.h"

/* A solve that did not converge; the same on every rank. */
typedef struct {
  const char *prefix;     /* prefix of the solver's options */
  KSPConvergedReason why; /* negative; 0: all solves have converged */
  PetscInt its;
  PetscReal residual; /* 2-norm */
} SolveFailure;

typedef struct _p_FastSolver *FastSolver;
struct _p_FastSolver {
  Grid grid;
  Field field;
  PetscReal a0, nu;     /* operator in force */
  PetscBool singular;   /* constants are in the null space: the mean of the solution is set to zero */
  Mat A;                /* the operator, a MatShell on vectors of the field's DMDA */
  PC pc;                /* the inverse of A, a PCSHELL */
  PetscInt solves;      /* solves so far */
  SolveFailure failure; /* the first one since it was last cleared */
  void *data;           /* the back end's own */
  PetscErrorCode (*setcoefficients)(FastSolver);                               /* NULL: nothing to set up */
  PetscErrorCode (*solve)(FastSolver, const PetscScalar b[], PetscScalar x[]); /* local arrays; x may be b */
  PetscErrorCode (*destroy)(FastSolver);
};

/* FastSolverCreate - solver of one field by the back end `type` ("fftw_tridiagonal", "fftw", "hypre").
   Collective. Errors: an unknown type. */
PETSC_EXTERN PetscErrorCode FastSolverCreate(Grid grid, Field field, const char type[], FastSolver *s);
PETSC_EXTERN PetscErrorCode FastSolverDestroy(FastSolver *s);

/* FastSolverSetCoefficients - choose a0 (1/time) and nu (length^2/time), the same bits on every rank; for L (FIELD_P)
   a0 = 0, nu = -1. Cheap when they do not change. Collective. */
PETSC_EXTERN PetscErrorCode FastSolverSetCoefficients(FastSolver s, PetscReal a0, PetscReal nu);

/* FastSolverSolve - one scalar solve on local arrays of the field (columns x rows); x may be b. Counted.
   Collective. Errors: see `failure` above. */
PETSC_EXTERN PetscErrorCode FastSolverSolve(FastSolver s, const PetscScalar b[], PetscScalar x[]);

/* FastSolverApply - FastSolverSolve from the entry `first` of both vectors' local arrays on; x may be b. Collective. */
PETSC_EXTERN PetscErrorCode FastSolverApply(FastSolver s, PetscInt first, Vec b, Vec x);

/* FastSolverClearFailure - forget the failure of earlier solves. FastSolverCount - count a solve of the same work that
   was made elsewhere. Not collective. */
static inline void FastSolverClearFailure(FastSolver s) {
  s->failure.why = KSP_CONVERGED_ITERATING;
}
static inline void FastSolverCount(FastSolver s) {
  s->solves++;
}

/* The back ends: FFTW's transforms both ways; transforms along the rows with tridiagonal solves across them; conjugate
   gradients with algebraic multigrid. Collective. */
PETSC_EXTERN PetscErrorCode FastSolverCreate_FFTW(FastSolver);
PETSC_EXTERN PetscErrorCode FastSolverCreate_Tridiagonal(FastSolver);
PETSC_EXTERN PetscErrorCode FastSolverCreate_Hypre(FastSolver);
