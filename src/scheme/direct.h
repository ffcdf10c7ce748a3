/* Sparse direct solution of the coupled problem: the ground truth for small grids. */
#pragma once
#include "coupling/solver.h"

typedef struct _p_DirectSolver *DirectSolver;
struct _p_DirectSolver {
  Coupling coupling; /* borrowed, and its fluid: */
  Fluid fluid;
  PetscInt M, W;   /* markers of vesicles, of obstacles */
  PetscInt *start; /* [ranks+1] first global index of each rank; what is not the fluid's comes last, on the last rank */
  KSP ksp;
  Vec x, b;
  Vec source;             /* with viscosity contrast: G^T of the velocity; else NULL */
  PetscScalar *all;       /* [2M + 2W] of all markers, work */
  KSPConvergedReason why; /* how the last solve ended; < 0: failed */
};

/* DirectSolverCreate - MUMPS through PETSc; the factor is made anew for every solve. Prefix direct_. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverCreate(Coupling coupling, DirectSolver *solver);
PETSC_EXTERN PetscErrorCode DirectSolverDestroy(DirectSolver *solver);

/* DirectSolverSolve - [H + B E/a0, G, S; G^T; S^T] with the near field, at the coupling's markers, p of zero mean (and
   w in a periodic box with alpha = 0). The markers' velocity V and the force F = Dm^T sigma/h^2 + (c_b ds/(h^2 a0)) D4
   V on them are unknowns of their own, as are the obstacles' F, so that the matrix stays sparse. Takes f, g and k of
   the problem (and moved, whose dipoles are added to f), gives w, p, sigma, V and solid. Afterwards solver->why says
   how it went. Collective. */
PETSC_EXTERN PetscErrorCode DirectSolverSolve(DirectSolver solver, const CoupledProblem *problem);

/* DirectIndex - global index of entry (i, j) of a field. DirectRows - rows of a field on a rank. Not collective. */
PETSC_EXTERN PetscInt DirectIndex(DirectSolver solver, int field, PetscInt i, PetscInt j);
PETSC_EXTERN PetscInt DirectRows(Grid grid, PetscInt rank, int field);

/* DirectFactors - factors of the rows (side 0) and of the unknowns (side 1), which make all entries numbers without a
   unit, velocities staying as they are: pivots do not depend on what lengths and times are measured in. Not collective.
 */
PETSC_EXTERN PetscErrorCode DirectFactors(DirectSolver solver, int side, Vec factors);

/* DirectAddContrast - viscosity contrast in the matrix, U and J the first rows of these unknowns: B U in the rows of U,
   the double layer in those of obstacles, J - Q (1 - ratio) (U + (treading/a0) dU/dt) = 0, the dipoles of J in the
   momentum and the divergence. DirectRoom - entries that they need in the rank's own rows, added to room.
   DirectContrastMean - in the rows of the mean velocity what dipoles have of it; on the last rank. Collective. */
PETSC_EXTERN PetscErrorCode DirectAddContrast(DirectSolver solver, Mat A, PetscInt U, PetscInt J);
PETSC_EXTERN PetscErrorCode DirectRoom(DirectSolver solver, PetscInt room[]);
PETSC_EXTERN PetscErrorCode DirectContrastMean(DirectSolver solver, Mat A, PetscInt J);

/* DirectAddArea - the rows of the areas, and their unknowns in the rows of U. DirectAreaTarget - their right-hand
   sides. Nothing without area target. Collective. */
PETSC_EXTERN PetscErrorCode DirectAddArea(DirectSolver solver, Mat A, PetscInt U);
PETSC_EXTERN PetscErrorCode DirectAreaTarget(DirectSolver solver);
