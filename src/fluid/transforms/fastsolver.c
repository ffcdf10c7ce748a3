#include "fluid/transforms/fastsolver.h"

/* Back ends by the names that -helmholtz_type and -poisson_type have for them. */
static const struct {
  const char *type;
  PetscErrorCode (*create)(FastSolver);
} back_ends[] = {{"fftw_tridiagonal", FastSolverCreate_Tridiagonal},
                 {"fftw", FastSolverCreate_FFTW},
                 {"hypre", FastSolverCreate_Hypre}};

PetscErrorCode FastSolverApply(FastSolver s, PetscInt first, Vec b, Vec x) {
  const PetscScalar *ba;
  PetscScalar *xa;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(b, &ba));
  PetscCall(VecGetArray(x, &xa));
  PetscCall(FastSolverSolve(s, ba + first, xa + first));
  PetscCall(VecRestoreArray(x, &xa));
  PetscCall(VecRestoreArrayRead(b, &ba));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solver as a PETSc preconditioner. */
static PetscErrorCode ApplyShell(PC pc, Vec b, Vec x) {
  FastSolver s;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(FastSolverApply(s, 0, b, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The operator that it inverts. */
static PetscErrorCode MultOperator(Mat A, Vec x, Vec y) {
  FastSolver s;
  const PetscScalar *xa;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayRead(x, &xa));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(GridHelmholtzField(s->grid, s->field, s->a0, s->nu, xa, ya));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(x, &xa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverCreate(Grid grid, Field field, const char type[], FastSolver *out) {
  FastSolver s;
  size_t k = 0;
  PetscFunctionBeginUser;
  while (k < PETSC_STATIC_ARRAY_LENGTH(back_ends) && strcmp(back_ends[k].type, type)) k++;
  PetscCheck(k < PETSC_STATIC_ARRAY_LENGTH(back_ends), grid->comm, PETSC_ERR_USER_INPUT, "fast solver %s: unknown",
             type);
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = grid;
  s->field = field;
  s->a0 = s->nu = PETSC_MAX_REAL;
  PetscCall(back_ends[k].create(s));
  const PetscInt n = grid->columns[field] * grid->rows[field];
  PetscCall(MatCreateShell(grid->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))MultOperator));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT_TRANSPOSE, (void (*)(void))MultOperator));
  PetscCall(PCCreate(grid->comm, &s->pc));
  PetscCall(PCSetType(s->pc, PCSHELL));
  PetscCall(PCShellSetContext(s->pc, s));
  PetscCall(PCShellSetApply(s->pc, ApplyShell));
  PetscCall(PCShellSetName(s->pc, type));
  PetscCall(PCSetOperators(s->pc, s->A, s->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverDestroy(FastSolver *s) {
  PetscFunctionBeginUser;
  if (!*s) PetscFunctionReturn(PETSC_SUCCESS);
  if ((*s)->destroy) PetscCall((*s)->destroy(*s));
  PetscCall(PCDestroy(&(*s)->pc));
  PetscCall(MatDestroy(&(*s)->A));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverSetCoefficients(FastSolver s, PetscReal a0, PetscReal nu) {
  PetscFunctionBeginUser;
  if (a0 == s->a0 && nu == s->nu) PetscFunctionReturn(PETSC_SUCCESS);
  s->a0 = a0;
  s->nu = nu;
  s->singular = a0 == 0 && (s->field == FIELD_P || (!s->grid->wall[0] && !s->grid->wall[1]));
  if (s->setcoefficients) PetscCall(s->setcoefficients(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverSolve(FastSolver s, const PetscScalar b[], PetscScalar x[]) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(s->solve(s, b, x));
  s->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}
