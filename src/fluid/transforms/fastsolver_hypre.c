/* Back end "hypre": conjugate gradients with hypre's algebraic multigrid (BoomerAMG) on the assembled operator, to
   check the other back ends. Any -helmholtz_ksp_*, -helmholtz_pc_*, -poisson_ksp_*, -poisson_pc_* option works
   on it. */
#include "fluid/transforms/fastsolver.h"

typedef struct {
  KSP ksp;
  Mat A;
  Vec x; /* of the array that is solved in */
  MatNullSpace constants;
} Assembled;

static PetscErrorCode SetCoefficients_Hypre(FastSolver s) {
  Assembled *d = (Assembled *)s->data;
  const PetscReal sign = s->nu < 0 ? -1 : 1; /* L is negative definite, conjugate gradients want -L x = -b */
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&d->A));
  PetscCall(GridAssemble(s->grid, s->field, sign * s->a0, sign * s->nu, &d->A));
  if (s->singular) {
    PetscCall(MatSetNullSpace(d->A, d->constants));
    PetscCall(MatSetTransposeNullSpace(d->A, d->constants));
  }
  PetscCall(KSPSetOperators(d->ksp, d->A, d->A));
  PetscCall(KSPSetUp(d->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Note a solve that has not converged, unless another one has been noted before. A right-hand side that is not finite
   is no failure of this solve: whatever made it has failed. */
static PetscErrorCode NoteFailure(FastSolver s, KSP ksp, KSPConvergedReason why) {
  SolveFailure *failure = &s->failure;
  PetscFunctionBeginUser;
  if (failure->why < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetIterationNumber(ksp, &failure->its));
  if (why == KSP_DIVERGED_NANORINF && failure->its == 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPGetOptionsPrefix(ksp, &failure->prefix));
  PetscCall(KSPGetResidualNorm(ksp, &failure->residual));
  failure->why = why;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Solve_Hypre(FastSolver s, const PetscScalar b[], PetscScalar x[]) {
  Assembled *d = (Assembled *)s->data;
  const PetscInt n = s->grid->columns[s->field] * s->grid->rows[s->field];
  KSPConvergedReason why;
  PetscFunctionBeginUser;
  PetscCall(PetscArraymove(x, b, n));
  PetscCall(VecPlaceArray(d->x, x));
  if (s->nu < 0) PetscCall(VecScale(d->x, -1));
  if (s->singular) PetscCall(MatNullSpaceRemove(d->constants, d->x));
  PetscCall(KSPSolve(d->ksp, d->x, d->x));
  PetscCall(KSPGetConvergedReason(d->ksp, &why)); /* from norms that the ranks share: the same everywhere */
  if (why < 0) {
    PetscCall(NoteFailure(s, d->ksp, why));
    PetscCall(VecSet(d->x, INFINITY));
  } else if (s->singular)
    PetscCall(MatNullSpaceRemove(d->constants, d->x));
  PetscCall(VecResetArray(d->x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Hypre(FastSolver s) {
  Assembled *d = (Assembled *)s->data;
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&d->ksp));
  PetscCall(MatDestroy(&d->A));
  PetscCall(VecDestroy(&d->x));
  PetscCall(MatNullSpaceDestroy(&d->constants));
  PetscCall(PetscFree(d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverCreate_Hypre(FastSolver s) {
  Assembled *d;
  PC pc;
  Grid g = s->grid;
  const PetscInt n = g->columns[s->field] * g->rows[s->field];
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  s->data = d;
  s->setcoefficients = SetCoefficients_Hypre;
  s->solve = Solve_Hypre;
  s->destroy = Destroy_Hypre;
  PetscCall(VecCreateMPIWithArray(g->comm, 1, n, PETSC_DETERMINE, NULL, &d->x));
  PetscCall(MatNullSpaceCreate(g->comm, PETSC_TRUE, 0, NULL, &d->constants));
  PetscCall(KSPCreate(g->comm, &d->ksp));
  PetscCall(KSPSetOptionsPrefix(d->ksp, s->field == FIELD_P ? "poisson_" : "helmholtz_"));
  PetscCall(KSPSetType(d->ksp, KSPCG));
  PetscCall(KSPSetNormType(d->ksp, KSP_NORM_UNPRECONDITIONED));
  PetscCall(KSPSetTolerances(d->ksp, 1e-12, 1e-50, PETSC_DEFAULT, 200));
  PetscCall(KSPGetPC(d->ksp, &pc));
  PetscCall(PCSetType(pc, PCHYPRE));
  PetscCall(PCHYPRESetType(pc, "boomeramg"));
  PetscCall(KSPSetFromOptions(d->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}
