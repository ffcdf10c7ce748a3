#include "krylov/solver.h"
#include "bodies/freebodies.h"

#define MOST_ROUNDS 4

/* -coupled_ksp_rtol is relative to the norm of the step's right-hand side (f, g, k of obstacles), not to what the
   initial guess left of it. */
static PetscErrorCode Converged(KSP ksp, PetscInt it, PetscReal norm, KSPConvergedReason *reason, void *ctx) {
  const CoupledSolver s = (CoupledSolver)ctx;
  PetscReal rtol, atol, dtol;
  PetscFunctionBeginUser;
  PetscCall(KSPGetTolerances(ksp, &rtol, &atol, &dtol, NULL));
  *reason = KSP_CONVERGED_ITERATING;
  if (!it) s->start = norm;
  if (PetscIsInfOrNanReal(norm))
    *reason = KSP_DIVERGED_NANORINF;
  else if (norm <= atol)
    *reason = KSP_CONVERGED_ATOL;
  else if (norm <= rtol * s->reference)
    *reason = KSP_CONVERGED_RTOL;
  else if (it > 0 && norm >= dtol * PetscMax(s->reference, s->start))
    *reason = KSP_DIVERGED_DTOL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Apply(PC pc, Vec r, Vec z) {
  Preconditioner p;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &p));
  PetscCall(PreconditionerApply(p, r, z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The KSP, then the preconditioner for it. */
static PetscErrorCode CreateKSP(CoupledSolver s, Scene scene) {
  PetscBool flexible;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPCreate(s->coupling->fluid->grid->comm, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "coupled_"));
  PetscCall(KSPSetType(s->ksp, KSPFGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 60));
  PetscCall(KSPGMRESSetCGSRefinementType(s->ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(s->ksp, scene->coupling.ksp_rtol, 0, PETSC_DEFAULT, 200));
  PetscCall(KSPSetOperators(s->ksp, s->reduced->A, s->reduced->A));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetApply(pc, Apply));
  PetscCall(PCShellSetName(pc, "mobility of the markers"));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
  PetscCall(KSPSetFromOptions(s->ksp));
  PetscCall(KSPGetInitialGuessNonzero(s->ksp, &s->guess)); /* KSP itself solves for the change */
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_FALSE));
  PetscCall(KSPSetConvergenceTest(s->ksp, Converged, s, NULL));
  PetscCall(PetscObjectTypeCompare((PetscObject)s->ksp, KSPFGMRES, &flexible));
  PetscCall(PreconditionerCreate(scene, s->unknowns, flexible, &s->preconditioner));
  PetscCall(PCShellSetContext(pc, s->preconditioner));
  PetscCall(KSPSetUp(s->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledSolverCreate(Scene scene, Coupling coupling, CoupledSolver *out) {
  CoupledSolver s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->coupling = coupling;
  PetscCall(UnknownsCreate(coupling, &s->unknowns));
  PetscCall(ReducedCreate(s->unknowns, &s->reduced));
  PetscCall(UnknownsCreateVec(s->unknowns, &s->x));
  PetscCall(VecDuplicate(s->x, &s->b));
  PetscCall(VecDuplicate(s->x, &s->change));
  PetscCall(CreateKSP(s, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledSolverDestroy(CoupledSolver *solver) {
  CoupledSolver s = *solver;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->b));
  PetscCall(VecDestroy(&s->change));
  PetscCall(PreconditionerDestroy(&s->preconditioner));
  PetscCall(ReducedDestroy(&s->reduced));
  PetscCall(UnknownsDestroy(&s->unknowns));
  PetscCall(PetscFree(*solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* In unbounded fluid, which has no f: the norm of the residual without unknowns, and of the speed c_b/(nu R0^2) that
   bending can give a marker, without which a circle, whose residual is all rounding, would have no scale. */
static PetscErrorCode FreeReference(CoupledSolver s) {
  const Membrane m = s->coupling->membrane;
  const Layout l = m->layout;
  PetscReal residual, bending;
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecSet(s->x, 0));
  PetscCall(ReducedAdd(s->reduced, s->x, s->x, s->b));
  PetscCall(VecNorm(s->b, NORM_2, &residual));
  PetscCall(VecSet(s->change, 0));
  PetscCall(VecGetArray(s->change, &a));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = 2 * LayoutOffset(l, v);
    for (PetscInt k = at; k < at + 2 * LayoutCount(l, v); k++)
      a[k] = m->bending * m->part[v] / (s->coupling->fluid->nu * PetscSqr(m->L0[v] / (2 * PETSC_PI)));
  }
  UnknownsScale(s->unknowns, PETSC_FALSE, a);
  PetscCall(VecRestoreArray(s->change, &a));
  PetscCall(VecNorm(s->change, NORM_2, &bending));
  s->reference = PetscHypotReal(residual, bending);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norm of f, g and the obstacles' k and loads with their factors (UnknownsScale). With a flow f is without the states
   before, whose square the first residual gives (Begin). */
static PetscErrorCode Reference(CoupledSolver s, const CoupledProblem *q) {
  const Unknowns u = s->unknowns;
  PetscScalar *a, *k;
  PetscReal squares, norm;
  PetscFunctionBeginUser;
  PetscCall(VecSet(s->change, 0));
  PetscCall(UnknownsPack(u, NULL, NULL, q->g, s->change));
  PetscCall(VecGetArray(s->change, &a));
  if (s->coupling->bodies->obstacles) {
    PetscCall(VecCopy(q->k, s->reduced->U));
    PetscCall(VecGetArray(s->reduced->U, &k));
    PetscCall(MobilityAddLayers(s->coupling->mobility, q->known.F, NULL, k));
    PetscCall(PetscArraycpy(a + u->velocity, k + u->velocity, BodiesObstacleNumbers(s->coupling->bodies)));
    if (q->load)
      PetscCall(PetscArraycpy(a + u->velocity + BodiesObstacleNumbers(s->coupling->bodies), q->load,
                              3 * s->coupling->bodies->obstacles->free->n));
    PetscCall(VecRestoreArray(s->reduced->U, &k));
  }
  UnknownsScale(u, PETSC_FALSE, a);
  PetscCall(VecRestoreArray(s->change, &a));
  PetscCall(VecNorm(s->change, NORM_2, &norm));
  PetscCall(VecDot(q->known.f->values, q->known.f->values, &squares));
  s->reference = PetscSqrtReal(PetscSqr(norm) + PetscSqr(u->length) * squares);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The first residual, that of the guess. */
static PetscErrorCode Begin(CoupledSolver s, const CoupledProblem *q, SolveReport *report) {
  const Mobility m = s->coupling->mobility;
  PetscFunctionBeginUser;
  PetscCall(ReducedBegin(s->reduced, q));
  PetscCall(m->stokes ? Reference(s, q) : FreeReference(s));
  PetscCall(VecSet(s->x, 0));
  if (s->guess) PetscCall(UnknownsPack(s->unknowns, q->V, q->solid, q->sigma, s->x));
  PetscCall(ReducedAdd(s->reduced, s->x, s->x, s->b));
  PetscCall(VecNorm(s->b, NORM_2, &report->residual));
  s->reference = PetscSqrtReal(PetscSqr(s->reference) + PetscSqr(s->unknowns->length) * m->measures.past);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A correction by a KSPSolve. */
static PetscErrorCode Iterate(CoupledSolver s, SolveReport *report) {
  PetscInt its;
  PetscFunctionBeginUser;
  PetscCall(KSPSolve(s->ksp, s->b, s->change));
  PetscCall(KSPGetIterationNumber(s->ksp, &its));
  PetscCall(KSPGetConvergedReason(s->ksp, &report->why));
  PetscCall(KSPGetResidualNorm(s->ksp, &report->residual));
  report->its = report->why < 0 ? its : report->its + its; /* a failure names the iterations of its KSPSolve */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Adds the correction; b becomes the residual that is left. */
static PetscErrorCode Follow(CoupledSolver s, SolveReport *report) {
  PetscFunctionBeginUser;
  PetscCall(VecAXPY(s->x, 1, s->change));
  PetscCall(ReducedAdd(s->reduced, s->change, s->x, s->b));
  PetscCall(VecNorm(s->b, NORM_2, &report->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoupledSolverSolve(CoupledSolver s, const CoupledProblem *q, SolveReport *report) {
  PetscReal rtol, atol;
  PetscFunctionBeginUser;
  *report = (SolveReport){.why = KSP_CONVERGED_RTOL};
  PetscCall(PreconditionerSetUp(s->preconditioner, q->graded));
  if (s->preconditioner->failed) {
    report->why = KSP_DIVERGED_PC_FAILED;
    report->residual = NAN;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(Begin(s, q, report));
  PetscCall(KSPGetTolerances(s->ksp, &rtol, &atol, NULL, NULL));
  const PetscReal goal = PetscMax(rtol * s->reference, atol);
  if (s->coupling->mobility->stokes && report->residual > goal) { /* the preconditioned residual */
    PetscCall(VecScale(s->b, 1 / report->residual));              /* of norm 1, as from KSP: units change no bit */
    PetscCall(PreconditionerApply(s->preconditioner, s->b, s->change));
    PetscCall(VecScale(s->change, report->residual));
    report->its = 1;
    PetscCall(Follow(s, report));
  }
  for (int round = 0; round < MOST_ROUNDS; round++) { /* rounding may spoil GMRES's own residual in stiff cases */
    if (report->residual <= (round ? 2 : 1) * goal) break;
    PetscCall(Iterate(s, report));
    if (report->why < 0) break;
    PetscCall(Follow(s, report));
  }
  report->measures = s->coupling->mobility->measures;
  PreconditionerSolved(s->preconditioner, report->its);
  if (report->why >= 0) PetscCall(UnknownsUnpack(s->unknowns, s->x, q->V, q->solid, q->sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}
