/* The fluid: grid, operators as PETSc objects, fast solves, and the data of moving walls. docs/fluid.md has the
   symbols. */
#pragma once
#include "fluid/transforms/fastsolver.h"

typedef struct _p_Fluid *Fluid;
struct _p_Fluid {
  Grid grid;
  PetscReal nu;          /* viscosity */
  PetscReal a0;          /* coefficient of the markers' time difference: X_new = Xhat + U/a0 */
  PetscReal alpha;       /* leading coefficient in H = alpha I - nu L_u: a0 (0 in quasi-steady flow) */
  PetscBool steady;      /* quasi-steady flow, -fluid_inertia none */
  Mat G, D;              /* gradient, divergence (MatShells) */
  Mat H, L;              /* velocity Helmholtz operator, pressure Laplacian (MatShells); NULL in unbounded fluid */
  PC Hinv, Linv;         /* fast solves of H (two scalar solves) and of L (one), PCSHELLs; NULL in unbounded fluid */
  FastSolver solver[3];  /* behind them, one a field; NULL in unbounded fluid */
  PetscBool tridiagonal; /* all of them by fftw_tridiagonal */
  PetscBool zero_flux;   /* a uniform pressure gradient along x holds the mean of u at zero */
  PetscBool held;        /* in a box periodic both ways one holds the means of u and v */
  PetscBool total;       /* total form: walls move with the background flow */
  Vec background;        /* u_inf on the faces; NULL unless total */
  Vec bc1;               /* what moving walls add to the momentum's right-hand side, and the driving -grad p_inf */
  Vec bc2;               /* D u = bc2: minus the wall faces' part of the divergence */
};

/* FluidCreate - a fluid at rest or, in the total form, with walls moving with u_inf. Collective. */
PETSC_EXTERN PetscErrorCode FluidCreate(const FluidSpec *spec, Fluid *fluid);
PETSC_EXTERN PetscErrorCode FluidDestroy(Fluid *fluid);

/* FluidSetSteady - quasi-steady flow or not, from the next FluidSetTimeCoefficient on. Not collective. */
static inline void FluidSetSteady(Fluid fluid, PetscBool steady) {
  fluid->steady = steady;
}

/* FluidSetTimeCoefficient - a0 (1/time), 1/dt for backward Euler, and with it alpha of H = alpha I - nu L_u. All ranks
   give the same bits. Collective. */
PETSC_EXTERN PetscErrorCode FluidSetTimeCoefficient(Fluid fluid, PetscReal a0);

/* FluidSolveHelmholtz - w = H^-1 b, two scalar solves; w may be b. Collective. Errors: see FluidFailure. */
PETSC_EXTERN PetscErrorCode FluidSolveHelmholtz(Fluid fluid, Vec b, Vec w);

/* FluidSolvePoisson - p = L^-1 q with zero mean, one scalar solve; p may be q. Collective. Errors: see FluidFailure. */
static inline PetscErrorCode FluidSolvePoisson(Fluid fluid, Vec q, Vec p) {
  return FastSolverApply(fluid->solver[FIELD_P], 0, q, p);
}

/* FluidRemoveMean - take the mean of each component off a velocity; the box must be periodic in x and y. Collective. */
PETSC_EXTERN PetscErrorCode FluidRemoveMean(Fluid fluid, Vec w);

/* FluidCountSolves - scalar fast solves so far. Not collective. */
PETSC_EXTERN PetscInt FluidCountSolves(Fluid fluid);

/* FluidFailure - the first scalar solve since FluidClearFailure that did not converge, borrowed; NULL when all did. Its
   solution was set to infinity (fastsolver.h). The same on every rank. Not collective. */
PETSC_EXTERN const SolveFailure *FluidFailure(Fluid fluid);
PETSC_EXTERN void FluidClearFailure(Fluid fluid);
