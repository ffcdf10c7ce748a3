#include "baselines/lagrangian.h"
#include "baselines/tensionmatrix.h"
#include "base/agree.h"

/* Levels of PCILU at which its fill is complete, with nested dissection, up to a few hundred markers: markers numbered
   along a curve make Chat a cyclic band, whose fill runs along the whole curve. Only a complete one has the paper's
   iterations (docs/reproduction/tension.md). */
#define COMPLETE_FILL 200

/* y = (S^T S + S^T G L^-1 G^T S) x */
static PetscErrorCode MultTension(Mat A, Vec x, Vec y) {
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  const Coupling c = s->coupling;
  const Grid g = c->fluid->grid;
  PetscCall(ForcingClear(&s->r));
  ForcingNote(&s->r, NULL);
  PetscCall(CouplingSpreadTension(c, 1, x, s->r.values));
  PetscCall(GridGradientTranspose(g, 1, s->r.values, s->r.source));
  PetscCall(FluidSolvePoisson(c->fluid, s->r.source, s->q2));
  PetscCall(GridGradient(g, 1, s->q2, PETSC_TRUE, s->r.values));
  PetscCall(MarkersInterpolate(c->markers, s->r.values, s->U));
  PetscCall(CouplingStretching(c, s->U, y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = x + E H^-1 B x / a0 */
static PetscErrorCode MultBending(Mat A, Vec x, Vec y) {
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(ForcingClear(&s->r));
  ForcingNote(&s->r, &s->coupling->markers->window);
  PetscCall(CouplingSpreadBending(s->coupling, 1, x, s->r.values));
  PetscCall(FluidSolveHelmholtz(s->coupling->fluid, s->r.values, s->w2));
  PetscCall(MarkersInterpolate(s->coupling->markers, s->w2, y));
  PetscCall(VecAYPX(y, 1 / s->coupling->fluid->a0, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = P^-1 x: every rank has all of x, and takes its own part of the result. */
static PetscErrorCode ApplyChat(PC pc, Vec x, Vec y) {
  PetscScalar *result, *all, *own;
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  const Layout l = s->coupling->membrane->layout;
  PetscCall(VecGetArray(s->all[0], &all));
  PetscCall(LayoutGatherVec(l, x, all));
  PetscCall(VecRestoreArray(s->all[0], &all));
  PetscCall(PCApply(s->chat, s->all[0], s->all[1]));
  PetscCall(VecGetArrayPair(s->all[1], y, &result, &own));
  PetscCall(PetscArraycpy(own, result + l->first, l->n));
  PetscCall(VecRestoreArrayPair(s->all[1], y, &result, &own));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(Coupling coupling, const char prefix[], int each, PetscErrorCode (*mult)(Mat, Vec, Vec),
                             LagrangianSolver *out) {
  const Grid g = coupling->fluid->grid;
  const Layout l = coupling->membrane->layout;
  LagrangianSolver s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->coupling = coupling;
  s->prefix = prefix;
  PetscCall(ForcingCreate(g, each == 1, &s->r));
  PetscCall(LayoutCreateVec(l, 2, &s->U));
  PetscCall(MatCreateShell(g->comm, each * l->n, each * l->n, each * l->M, each * l->M, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))mult));
  PetscCall(KSPCreate(g->comm, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, prefix));
  PetscCall(KSPSetType(s->ksp, KSPGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 200));
  /* h over half the box's shorter side, squared: the h^2 of the paper, whose box has 2 length units */
  PetscCall(KSPSetTolerances(s->ksp, PetscSqr(2.0 / PetscMin(g->n[0], g->n[1])), PETSC_DEFAULT, PETSC_DEFAULT, 1000));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* GMRES preconditions from the right unless the user names a side: its test then sees the residual itself, dt times
   which is the surface divergence. The left-preconditioned residual underestimates it, the more the finer the grid. */
PetscErrorCode TensionSolverCreate(Coupling coupling, LagrangianSolver *out) {
  LagrangianSolver s;
  PetscBool gmres, given, none;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(Create(coupling, "tension_", 1, MultTension, out));
  s = *out;
  PetscCall(VecDuplicate(s->r.source, &s->q2));
  PetscCall(PCCreate(PETSC_COMM_SELF, &s->chat)); /* PCILU in nested dissection, unless options say otherwise */
  PetscCall(PCSetOptionsPrefix(s->chat, s->prefix));
  PetscCall(PCSetType(s->chat, PCILU));
  PetscCall(PCFactorSetLevels(s->chat, COMPLETE_FILL));
  PetscCall(PCFactorSetZeroPivot(s->chat, 0)); /* the default is a number, entries have a unit */
  PetscCall(PCFactorSetMatOrderingType(s->chat, MATORDERINGND));
  PetscCall(PCSetFromOptions(s->chat));
  PetscCall(PetscObjectTypeCompare((PetscObject)s->chat, PCNONE, &none));
  if (none) PetscCall(PCDestroy(&s->chat));
  for (int k = 0; k < 2; k++) PetscCall(VecCreateSeq(PETSC_COMM_SELF, coupling->membrane->layout->M, &s->all[k]));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetOptionsPrefix(pc, "tension_shell_")); /* -tension_pc_ options are those of the PC inside */
  PetscCall(PCSetType(pc, s->chat ? PCSHELL : PCNONE));
  if (s->chat) {
    PetscCall(PCShellSetContext(pc, s));
    PetscCall(PCShellSetApply(pc, ApplyChat));
    PetscCall(PCShellSetName(pc, "of the assembled Chat, on every rank"));
  }
  PetscCall(KSPSetFromOptions(s->ksp));
  PetscCall(PetscOptionsHasName(NULL, "tension_", "-ksp_pc_side", &given));
  PetscCall(PetscObjectTypeCompare((PetscObject)s->ksp, KSPGMRES, &gmres));
  if (gmres && !given) PetscCall(KSPSetPCSide(s->ksp, PC_RIGHT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BendingSolverCreate(Coupling coupling, LagrangianSolver *s) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(Create(coupling, "bending_", 2, MultBending, s));
  PetscCall(VecDuplicate((*s)->r.values, &(*s)->w2));
  PetscCall(KSPGetPC((*s)->ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE));
  PetscCall(KSPSetFromOptions((*s)->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LagrangianSolverDestroy(LagrangianSolver *solver) {
  LagrangianSolver s = *solver;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(PCDestroy(&s->chat));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&s->all[k]));
  PetscCall(MatDestroy(&s->A));
  PetscCall(ForcingDestroy(&s->r));
  PetscCall(VecDestroy(&s->w2));
  PetscCall(VecDestroy(&s->q2));
  PetscCall(VecDestroy(&s->U));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The tension problem's preconditioner follows the markers. */
static PetscErrorCode SetUpChat(LagrangianSolver s) {
  PCFailedReason why;
  Mat Chat;
  PetscFunctionBeginUser;
  s->failed = PETSC_FALSE;
  if (!s->chat) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TensionAssemble(s->coupling, &Chat));
  PetscCall(PCSetOperators(s->chat, Chat, Chat));
  PetscCall(PCSetUp(s->chat));
  PetscCall(PCGetFailedReason(s->chat, &why));
  PetscCall(AgreeFlag(s->coupling->membrane->layout->comm, why != PC_NOERROR, &s->failed));
  PetscCall(MatDestroy(&Chat));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode LagrangianSolverSolve(LagrangianSolver s, Vec b, Vec x) {
  PetscFunctionBeginUser;
  PetscCall(SetUpChat(s));
  if (s->failed) {
    s->its = 0;
    s->why = KSP_DIVERGED_PC_FAILED;
    s->residual = NAN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(KSPSolve(s->ksp, b, x));
  PetscCall(KSPGetIterationNumber(s->ksp, &s->its));
  PetscCall(KSPGetConvergedReason(s->ksp, &s->why));
  PetscCall(KSPGetResidualNorm(s->ksp, &s->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}
