/* Fast scalar solves: (a0 I - nu second differences) x = b for one field of the grid. Back ends are registered by name
   and stand behind one interface; each is a PETSc PCSHELL. */
#pragma once
#include "fluid/grid.h"

typedef struct _p_FastSolver *FastSolver;
struct _p_FastSolver {
  Grid grid;
  Field field;
  PetscReal a0, nu;   /* operator in force */
  PetscBool singular; /* constants are in the null space: the mean of the solution is set to zero */
  Mat A;              /* the operator, a MatShell on vectors of the field's DMDA */
  PC pc;              /* its inverse, a PCSHELL */
  PetscInt solves;    /* solves so far */
  void *data;         /* the back end's own */
  PetscErrorCode (*setcoefficients)(FastSolver);
  PetscErrorCode (*apply)(FastSolver, const PetscScalar b[], PetscScalar x[]); /* local arrays; x may be b */
  PetscErrorCode (*begin)(FastSolver, const PetscScalar b[]);                  /* or in two halves */
  PetscErrorCode (*end)(FastSolver, PetscScalar x[]);
  const PetscScalar *b; /* under way, for a back end of one half */
  PetscErrorCode (*destroy)(FastSolver);
};

/* FastSolverCreate - solver of one field by the back end `type` ("fftw_tridiagonal", "fftw", "hypre"); plan: FFTW's
   effort (0 estimate, 1 measure, 2 patient). Collective. */
PETSC_EXTERN PetscErrorCode FastSolverCreate(Grid grid, Field field, const char type[], PetscInt plan, FastSolver *s);
PETSC_EXTERN PetscErrorCode FastSolverDestroy(FastSolver *s);

/* FastSolverSetCoefficients - choose a0 and nu; for L (FIELD_P) a0 = 0, nu = -1. Cheap when they do not change. */
PETSC_EXTERN PetscErrorCode FastSolverSetCoefficients(FastSolver s, PetscReal a0, PetscReal nu);

/* FastSolverSolve - one scalar solve on local arrays of the field (columns x rows); x may be b. Collective; counted. */
PETSC_EXTERN PetscErrorCode FastSolverSolve(FastSolver s, const PetscScalar b[], PetscScalar x[]);

/* FastSolverBegin, FastSolverEnd - the same in two halves, so that messages of one field travel while the next is at
   work: b must stay as it is until the solve ends. Every Begin wants its End, in the same order on every rank. */
PETSC_EXTERN PetscErrorCode FastSolverBegin(FastSolver s, const PetscScalar b[]);
PETSC_EXTERN PetscErrorCode FastSolverEnd(FastSolver s, PetscScalar x[]);

/* FastSolverGetPC - the PCSHELL that applies this solver to vectors of the field's DMDA. Borrowed. */
PETSC_EXTERN PetscErrorCode FastSolverGetPC(FastSolver s, PC *pc);

/* FastSolverRegister - add a back end. */
PETSC_EXTERN PetscErrorCode FastSolverRegister(const char type[], PetscErrorCode (*create)(FastSolver, PetscInt plan));

/* Back ends */
PETSC_EXTERN PetscErrorCode FastSolverCreate_FFTW(FastSolver, PetscInt);
PETSC_EXTERN PetscErrorCode FastSolverCreate_Tridiagonal(FastSolver, PetscInt);
PETSC_EXTERN PetscErrorCode FastSolverCreate_Hypre(FastSolver, PetscInt);
