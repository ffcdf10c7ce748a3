#include "fluid/transforms/fastsolver.h"

static PetscFunctionList back_ends;

static PetscErrorCode ForgetBackEnds(void) {
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListDestroy(&back_ends));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverRegister(const char type[], PetscErrorCode (*create)(FastSolver)) {
  PetscFunctionBeginUser;
  if (!back_ends) PetscCall(PetscRegisterFinalize(ForgetBackEnds));
  PetscCall(PetscFunctionListAdd(&back_ends, type, create));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The solver as a PETSc preconditioner. */
static PetscErrorCode ApplyShell(PC pc, Vec b, Vec x) {
  FastSolver s;
  const PetscScalar *ba;
  PetscScalar *xa;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(VecGetArrayRead(b, &ba));
  PetscCall(VecGetArray(x, &xa));
  PetscCall(FastSolverSolve(s, ba, xa));
  PetscCall(VecRestoreArray(x, &xa));
  PetscCall(VecRestoreArrayRead(b, &ba));
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
  PetscErrorCode (*create)(FastSolver);
  PetscFunctionBeginUser;
  PetscCall(PetscFunctionListFind(back_ends, type, &create));
  PetscCheck(create, grid->comm, PETSC_ERR_USER_INPUT, "fast solver %s: not registered", type);
  PetscCall(PetscNew(&s));
  *out = s;
  s->grid = grid;
  s->field = field;
  s->a0 = s->nu = PETSC_MAX_REAL;
  PetscCall(create(s));
  const PetscInt n = grid->columns[field] * grid->rows[field];
  PetscCall(MatCreateShell(grid->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))MultOperator));
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
  s->singular = a0 == 0 && (s->field == FIELD_P || (!s->grid->wall[0] && !s->grid->wall[1])) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(s->setcoefficients(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverBegin(FastSolver s, const PetscScalar b[]) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  s->b = b;
  if (s->begin) PetscCall(s->begin(s, b));
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverEnd(FastSolver s, PetscScalar x[]) {
  PetscFunctionBeginUser;
  PetscCall(PhaseBegin(PHASE_FAST_SOLVE));
  PetscCall(s->end ? s->end(s, x) : s->apply(s, s->b, x));
  s->solves++;
  PetscCall(PhaseEnd());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverSolve(FastSolver s, const PetscScalar b[], PetscScalar x[]) {
  PetscFunctionBeginUser;
  PetscCall(FastSolverBegin(s, b));
  PetscCall(FastSolverEnd(s, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FastSolverGetPC(FastSolver s, PC *pc) {
  PetscFunctionBeginUser;
  *pc = s->pc;
  PetscFunctionReturn(PETSC_SUCCESS);
}
