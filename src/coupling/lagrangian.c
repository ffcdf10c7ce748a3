#include "coupling/lagrangian.h"

/* U := R (U - Theta Dm^T sigma), sigma or NULL */
static PetscErrorCode ApplySelfMobility(LagrangianSolver s, const PetscScalar sigma[], Vec U) {
  PetscScalar *u;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(U, &u));
  PetscCall(SelfMobilityApply(s->self, sigma, NULL, u));
  PetscCall(VecRestoreArray(U, &u));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = Dm R (E w - alpha Theta Dm^T x)/h^2, what self-mobility makes of S^T w. */
static PetscErrorCode CorrectedStretching(LagrangianSolver s, Vec w, Vec x, PetscReal alpha, Vec y) {
  const Coupling c = s->coupling;
  const PetscScalar *u;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(CouplingInterpolate(c, c->E, w, s->U));
  PetscCall(VecCopy(x, y));
  PetscCall(VecScale(y, alpha));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(ApplySelfMobility(s, ya, s->U));
  PetscCall(VecGetArrayRead(s->U, &u));
  MembraneStretching(c->membrane, c->tau, u, ya);
  PetscCall(VecRestoreArrayRead(s->U, &u));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecScale(y, 1 / PetscSqr(c->grid->h)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = (S^T S + S^T G L^-1 G^T S) x */
static PetscErrorCode MultTension(Mat A, Vec x, Vec y) {
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(CouplingClear(s->coupling, s->w, s->dirty_w));
  PetscCall(CouplingClear(s->coupling, s->q, s->dirty_q));
  PetscCall(CouplingSpreadAdd(s->coupling, 1, s->coupling->S, x, s->w));
  PetscCall(GridGradientTransposeRows(s->fluid->grid, 1, s->w, s->coupling->window, s->q));
  PetscCall(FluidSolvePoisson(s->fluid, s->q, s->q2));
  PetscCall(GridGradientRows(s->fluid->grid, 1, s->q2, PETSC_TRUE, s->coupling->window, s->w));
  if (s->self)
    PetscCall(CorrectedStretching(s, s->w, x, -s->fluid->a0, y));
  else
    PetscCall(CouplingInterpolate(s->coupling, s->coupling->S, s->w, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = x + E H^-1 B x / a0 */
static PetscErrorCode MultBending(Mat A, Vec x, Vec y) {
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(CouplingClear(s->coupling, s->w, s->dirty_w));
  PetscCall(CouplingSpreadAdd(s->coupling, 1, s->coupling->B, x, s->w));
  PetscCall(FluidSolveHelmholtz(s->fluid, s->w, s->w2));
  PetscCall(CouplingInterpolate(s->coupling, s->coupling->E, s->w2, y));
  if (s->self) PetscCall(ApplySelfMobility(s, NULL, y));
  PetscCall(VecAYPX(y, 1 / s->fluid->a0, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(Fluid fluid, Coupling coupling, SelfMobility self, const char prefix[], PetscInt n,
                             PetscErrorCode (*mult)(Mat, Vec, Vec), LagrangianSolver *out) {
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  s->coupling = coupling;
  s->self = self;
  s->prefix = prefix;
  PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &s->w));
  PetscCall(MembraneCreateMarkerVec(coupling->membrane, &s->U));
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))mult));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, prefix));
  PetscCall(KSPSetType(s->ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 200));
  PetscCall(KSPSetTolerances(s->ksp, PetscSqr(fluid->grid->h), PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every rank runs the same iteration, one prints; but a monitor that applies the operator, which is collective, must
   stay on all of them. */
PetscErrorCode KSPReplicatedSetFromOptions(KSP ksp, PetscMPIInt rank) {
  const char *prefix;
  PetscBool true_residual;
  PetscFunctionBeginUser;
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPGetOptionsPrefix(ksp, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-ksp_monitor_true_residual", &true_residual));
  if (rank && !true_residual) {
    PetscCall(KSPMonitorCancel(ksp));
    PetscCall(KSPResetViewers(ksp));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* GMRES preconditions from the right unless the user names a side: its test then sees the residual itself, dt times
   which is the surface divergence. The left-preconditioned residual underestimates it, the more the finer the grid. */
static PetscErrorCode PreferRight(KSP ksp) {
  const char *prefix;
  PetscBool gmres, given;
  PetscFunctionBeginUser;
  PetscCall(KSPGetOptionsPrefix(ksp, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-ksp_pc_side", &given));
  PetscCall(PetscObjectTypeCompare((PetscObject)ksp, KSPGMRES, &gmres));
  if (gmres && !given) PetscCall(KSPSetPCSide(ksp, PC_RIGHT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TensionSolverCreate(Fluid fluid, Coupling coupling, SelfMobility self, LagrangianSolver *s) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(Create(fluid, coupling, self, "tension_", coupling->membrane->M, MultTension, s));
  PetscCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &(*s)->q));
  PetscCall(VecDuplicate((*s)->q, &(*s)->q2));
  PetscCall(KSPGetPC((*s)->ksp, &pc));
  PetscCall(PCSetType(pc, PCILU));
  PetscCall(PCFactorSetLevels(pc, COMPLETE_FILL));
  PetscCall(PCFactorSetMatOrderingType(pc, MATORDERINGND));
  PetscCall(KSPReplicatedSetFromOptions((*s)->ksp, fluid->grid->rank));
  PetscCall(PreferRight((*s)->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BendingSolverCreate(Fluid fluid, Coupling coupling, SelfMobility self, LagrangianSolver *s) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(Create(fluid, coupling, self, "bending_", 2 * coupling->membrane->M, MultBending, s));
  PetscCall(VecDuplicate((*s)->w, &(*s)->w2));
  PetscCall(KSPGetPC((*s)->ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPReplicatedSetFromOptions((*s)->ksp, fluid->grid->rank));
  PetscCall(KSPSetOperators((*s)->ksp, (*s)->A, (*s)->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LagrangianSolverDestroy(LagrangianSolver *solver) {
  LagrangianSolver s = *solver;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(MatDestroy(&s->A));
  PetscCall(MatDestroy(&s->Chat));
  PetscCall(VecDestroy(&s->w));
  PetscCall(VecDestroy(&s->w2));
  PetscCall(VecDestroy(&s->q));
  PetscCall(VecDestroy(&s->q2));
  PetscCall(VecDestroy(&s->U));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Chat += (a0/h^2) Dm Theta Dm^T for one-block vesicles: self-mobility is the larger part of the corrected operator. */
static PetscErrorCode AddSelfMobility(LagrangianSolver s) {
  const Membrane m = s->coupling->membrane;
  const PetscReal scale = s->fluid->a0 / PetscSqr(s->coupling->grid->h);
  PetscScalar *unit, *F, *d;
  Mat sum;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(m->M, &unit, 2 * m->M, &F, m->M, &d));
  PetscCall(MatConvert(s->Chat, MATSEQDENSE, MAT_INITIAL_MATRIX, &sum));
  for (PetscInt k = 0; k < m->M; k++) {
    unit[k] = 1;
    PetscCall(PetscArrayzero(F, 2 * m->M));
    MembraneStretchingTranspose(m, s->coupling->tau, 1, unit, F);
    PetscCall(SelfMobilityMultTheta(s->self, F));
    MembraneStretching(m, s->coupling->tau, F, d);
    for (PetscInt l = 0; l < m->M; l++) PetscCall(MatSetValue(sum, l, k, scale * d[l], ADD_VALUES));
    unit[k] = 0;
  }
  PetscCall(MatAssemblyBegin(sum, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(sum, MAT_FINAL_ASSEMBLY));
  PetscCall(MatDestroy(&s->Chat));
  PetscCall(MatConvert(sum, MATSEQAIJ, MAT_INITIAL_MATRIX, &s->Chat));
  PetscCall(MatDestroy(&sum));
  PetscCall(PetscFree3(unit, F, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LagrangianSolverSetUp(LagrangianSolver s) {
  PetscFunctionBeginUser;
  if (s->q) { /* the tension problem: its preconditioner follows the markers */
    PC pc;
    PetscBool none;
    PetscCall(KSPGetPC(s->ksp, &pc));
    PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCNONE, &none));
    PetscCall(MatDestroy(&s->Chat));
    if (!none) PetscCall(TensionAssemble(s->coupling, &s->Chat));
    if (!none && s->self) PetscCall(AddSelfMobility(s));
    PetscCall(KSPSetOperators(s->ksp, s->A, none ? s->A : s->Chat));
  }
  PetscCall(KSPSetUp(s->ksp));
  PetscCall(KSPSetUpOnBlocks(s->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LagrangianSolverSolve(LagrangianSolver s, Vec b, Vec x) {
  PetscFunctionBeginUser;
  PetscCall(KSPSolve(s->ksp, b, x));
  PetscCall(KSPGetIterationNumber(s->ksp, &s->its));
  PetscCall(KSPGetConvergedReason(s->ksp, &s->why));
  PetscCall(KSPGetResidualNorm(s->ksp, &s->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KSPWriteOptions(KSP ksp, const char prefix[], FILE *file) {
  KSPType type;
  PCType pc_type;
  PC pc;
  PetscReal rtol, atol, dtol;
  PetscInt max_it;
  PetscBool ilu, shell;
  PetscFunctionBeginUser;
  PetscCall(KSPGetType(ksp, &type));
  PetscCall(KSPGetTolerances(ksp, &rtol, &atol, &dtol, &max_it));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCGetType(pc, &pc_type));
  fprintf(file, "-%sksp_type %s\n-%sksp_rtol %.17g\n-%sksp_atol %.17g\n-%sksp_max_it %" PetscInt_FMT "\n", prefix, type,
          prefix, (double)rtol, prefix, (double)atol, prefix, max_it);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCSHELL, &shell));
  if (!shell) fprintf(file, "-%spc_type %s\n", prefix, pc_type);
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCILU, &ilu));
  if (ilu) {
    PetscInt levels;
    PetscCall(PCFactorGetLevels(pc, &levels));
    fprintf(file, "-%spc_factor_levels %" PetscInt_FMT "\n", prefix, levels);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
