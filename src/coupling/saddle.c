#include "coupling/saddle.h"

#define MOST_ROUNDS 4
#define OWN_MEMORY (SADDLE_MEMORY - MOBILITY_CACHE)
#define LONG_LIFE 1000

PetscReal SaddleScale(Saddle s, PetscInt k) {
  const PetscReal h = s->fluid->grid->h;
  return PetscSqr(h) / s->coupling->membrane->spacing[k] * (1 + h * s->fluid->alpha);
}

PetscReal SaddleVelocityScale(Saddle s, PetscInt k) {
  const Membrane m = s->coupling->membrane;
  const PetscReal stiffness = m->bending / (s->fluid->a0 * s->fluid->nu * PetscPowRealInt(m->spacing[k], 3));
  return SaddleScale(s, k) / PetscSqr(s->fluid->grid->h) * PetscSqrtReal(1 + stiffness);
}

static PetscErrorCode CreateMembranePart(Scene scene, Saddle s) {
  const Membrane m = s->coupling->membrane;
  PetscFunctionBeginUser;
  s->n_tension = m->M;
  s->n_velocity = 2 * m->M;
  PetscCall(MembraneCreateMarkerVec(m, &s->U));
  PetscCall(VecDuplicate(s->U, &s->F));
  PetscCall(PetscMalloc1(m->M, &s->tension));
  if (s->type == MOBILITY_TABLE) {
    PetscCall(MobilityCreate(&scene->fluid, s->coupling, &s->mobility));
    PetscCall(DenseBlocksCreate(s->coupling, &s->blocks));
  } else if (s->type == MOBILITY_ILU) {
    PetscCall(PCCreate(PETSC_COMM_SELF, &s->ilu));
    PetscCall(PCSetOptionsPrefix(s->ilu, "coupled_mobility_"));
    PetscCall(PCSetType(s->ilu, PCILU));
    PetscCall(PCFactorSetLevels(s->ilu, COMPLETE_FILL));
    PetscCall(PCFactorSetMatOrderingType(s->ilu, MATORDERINGND));
    PetscCall(PCSetFromOptions(s->ilu));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* -coupled_ksp_rtol is relative to the norm of the step's right-hand side (f, bc2, g), not to what the initial guess
   left of it. */
static PetscErrorCode Converged(KSP ksp, PetscInt it, PetscReal norm, KSPConvergedReason *reason, void *ctx) {
  const Saddle s = (Saddle)ctx;
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

static PetscErrorCode CreateKSP(Saddle s, PetscReal rtol, PetscInt n) {
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))SaddleMult));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "coupled_"));
  PetscCall(KSPSetType(s->ksp, KSPFGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 60));
  PetscCall(KSPGMRESSetCGSRefinementType(s->ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(s->ksp, rtol, 0, PETSC_DEFAULT, 200));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, s));
  PetscCall(PCShellSetApply(pc, SaddlePrecondition));
  PetscCall(PCShellSetName(pc, "mobility of the markers, slip of the walls"));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
  PetscCall(KSPReplicatedSetFromOptions(s->ksp, s->fluid->grid->rank));
  PetscCall(KSPGetInitialGuessNonzero(s->ksp, &s->guess)); /* KSP itself solves for the change */
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_FALSE));
  PetscCall(KSPSetConvergenceTest(s->ksp, Converged, s, NULL));
  PetscCall(PetscObjectTypeCompare((PetscObject)s->ksp, KSPFGMRES, &s->flexible));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleCreate(Scene scene, Fluid fluid, Coupling coupling, SelfMobility self, Saddle *out) {
  Saddle s;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  s->coupling = coupling;
  s->self = self;
  s->type = (MobilityType)scene->coupling.mobility;
  PetscCall(StokesCreate(fluid, &s->stokes));
  PetscCall(WallsCreate(fluid, &s->walls));
  PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &s->r));
  if (coupling) PetscCall(CreateMembranePart(scene, s));
  const PetscInt n = s->n_velocity + s->n_tension + s->walls->n;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &s->x));
  PetscCall(VecDuplicate(s->x, &s->b));
  PetscCall(VecDuplicate(s->x, &s->change));
  PetscCall(VecDuplicate(s->x, &s->rest));
  PetscCall(VecDuplicate(s->x, &s->pending));
  PetscCall(CreateKSP(s, scene->coupling.ksp_rtol, n));
  PetscCall(SaddleForget(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleDestroy(Saddle *saddle) {
  Saddle s = *saddle;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k <= SADDLE_KEPT; k++) {
    PetscCall(VecDestroy(&s->w[k]));
    PetscCall(VecDestroy(&s->p[k]));
    if (k == SADDLE_KEPT) break;
    PetscCall(VecDestroy(&s->z[k]));
    PetscCall(VecDestroy(&s->Az[k]));
  }
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->b));
  PetscCall(VecDestroy(&s->change));
  PetscCall(VecDestroy(&s->rest));
  PetscCall(VecDestroy(&s->pending));
  PetscCall(VecDestroy(&s->r));
  PetscCall(VecDestroy(&s->U));
  PetscCall(VecDestroy(&s->F));
  PetscCall(PetscFree(s->tension));
  PetscCall(WallsDestroy(&s->walls));
  PetscCall(StokesDestroy(&s->stokes));
  PetscCall(DenseBlocksDestroy(&s->blocks));
  PetscCall(MobilityDestroy(&s->mobility));
  PetscCall(PCDestroy(&s->ilu));
  PetscCall(MatDestroy(&s->Chat));
  PetscCall(MatDestroy(&s->A));
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(PetscFree(*saddle));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleCreateWallVec(Saddle s, Vec *d) {
  PetscFunctionBeginUser;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, s->walls->n, d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleForget(Saddle s) {
  PetscFunctionBeginUser;
  s->factored_a0 = 0;
  s->fresh_its = -1;
  s->age = s->refreshed = 0;
  s->life = LONG_LIFE;
  s->waste = 0;
  if (s->mobility) PetscCall(MobilityForget(s->mobility));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeBlocks(Saddle s) {
  const GreenTable *table;
  PetscFunctionBeginUser;
  PetscCall(MobilityGetTable(s->mobility, s->fluid->alpha, &table));
  PetscCall(DenseBlocksFactor(s->blocks, s->mobility, table, s->self, s->fluid->a0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleGetMemory(Saddle s, PetscReal memory[SADDLE_MEMORY]) {
  const PetscReal own[] = {s->factored_a0, s->fresh_its, s->age, s->waste, s->life, s->refreshed};
  PetscFunctionBeginUser;
  for (int k = 0; k < OWN_MEMORY; k++) memory[k] = own[k];
  for (int k = 0; k < MOBILITY_CACHE; k++)
    memory[OWN_MEMORY + k] = s->mobility ? MobilityCoefficient(s->mobility, k) : -1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleSetMemory(Saddle s, const PetscReal memory[SADDLE_MEMORY]) {
  PetscFunctionBeginUser;
  if (!s->mobility || memory[0] == 0) PetscFunctionReturn(PETSC_SUCCESS);
  s->factored_a0 = memory[0];
  s->fresh_its = (PetscInt)memory[1];
  s->age = (PetscInt)memory[2];
  s->waste = memory[3];
  s->life = (PetscInt)memory[4];
  s->refreshed = (PetscInt)memory[5];
  PetscCall(MobilitySetTables(s->mobility, memory + OWN_MEMORY));
  PetscCall(MakeBlocks(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleRefresh(Saddle s) {
  PetscFunctionBeginUser;
  PetscCall(MakeBlocks(s));
  s->factored_a0 = s->fluid->a0;
  s->fresh_its = -1;
  s->age = 0;
  s->waste = 0;
  if (++s->refreshed % 16 == 0) s->life++; /* try a longer life now and then */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cost of new dense blocks in iterations, from the operation counts and the speeds of one core; a number of the problem
   alone, so that iterations do not depend on the machine or its load. */
static PetscReal RefreshCost(Saddle s) {
  const Membrane m = s->coupling->membrane;
  const PetscReal n = m->M <= DENSE_TOGETHER ? m->M : (PetscReal)m->M / m->vesicles, blocks = m->M / n;
  const PetscReal cells = (PetscReal)s->fluid->grid->n[0] * s->fluid->grid->n[1];
  return blocks * (4e-9 * n * n * n + 6e-7 * n * n) / (1.5e-8 * cells + blocks * 1e-8 * n * n + 5e-5);
}

PetscErrorCode SaddleSetUp(Saddle s) {
  PetscFunctionBeginUser;
  if (!s->coupling) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WallsSetMarkers(s->walls, s->coupling->membrane->M, s->coupling->X));
  if (s->type == MOBILITY_ILU) {
    PetscCall(MatDestroy(&s->Chat));
    PetscCall(TensionAssemble(s->coupling, &s->Chat));
    PetscCall(PCSetOperators(s->ilu, s->Chat, s->Chat));
    PetscCall(PCSetUp(s->ilu));
  }
  if (s->type != MOBILITY_TABLE) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->waste > RefreshCost(s) || s->age >= s->life || !(PetscAbsReal(s->factored_a0 / s->fluid->a0 - 1) < 0.1))
    PetscCall(SaddleRefresh(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x = (V, sigma, d) of the guess, V = R (U - Theta Dm^T sigma), U = E w. */
static PetscErrorCode Guess(Saddle s, Vec Ew, Vec sigma, Vec d) {
  const PetscScalar *a, *U;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(s->x, &x));
  if (s->coupling) {
    PetscCall(VecGetArrayRead(sigma, &a));
    PetscCall(PetscArraycpy(x + s->n_velocity, a, s->n_tension));
    PetscCall(VecRestoreArrayRead(sigma, &a));
    PetscCall(VecGetArrayRead(Ew, &U));
    PetscCall(PetscArraycpy(x, U, s->n_velocity));
    PetscCall(VecRestoreArrayRead(Ew, &U));
    if (s->self) PetscCall(SelfMobilityApply(s->self, x + s->n_velocity, NULL, x));
  }
  PetscCall(VecGetArrayRead(d, &a));
  PetscCall(PetscArraycpy(x + s->n_velocity + s->n_tension, a, s->walls->n));
  PetscCall(VecRestoreArrayRead(d, &a));
  PetscCall(VecRestoreArray(s->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TakeSolution(Saddle s, Vec sigma, Vec d, Vec V) {
  const PetscScalar *x;
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->x, &x));
  if (s->coupling) {
    PetscCall(VecGetArray(sigma, &a));
    PetscCall(PetscArraycpy(a, x + s->n_velocity, s->n_tension));
    PetscCall(VecRestoreArray(sigma, &a));
    PetscCall(VecGetArray(V, &a));
    PetscCall(PetscArraycpy(a, x, s->n_velocity));
    PetscCall(VecRestoreArray(V, &a));
  }
  PetscCall(VecGetArray(d, &a));
  PetscCall(PetscArraycpy(a, x + s->n_velocity + s->n_tension, s->walls->n));
  PetscCall(VecRestoreArray(d, &a));
  PetscCall(VecRestoreArrayRead(s->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Norm of (f, bc2, scaled g). */
static PetscErrorCode Reference(Saddle s, Vec f, Vec g) {
  PetscReal norm, sum;
  PetscFunctionBeginUser;
  PetscCall(VecNorm(f, NORM_2, &norm));
  sum = PetscSqr(norm);
  if (s->fluid->bc2) {
    PetscCall(VecNorm(s->fluid->bc2, NORM_2, &norm));
    sum += PetscSqr(norm);
  }
  if (s->coupling) {
    const PetscScalar *a;
    PetscCall(VecGetArrayRead(g, &a));
    for (PetscInt k = 0; k < s->n_tension; k++) sum += PetscSqr(a[k] * SaddleScale(s, k));
    PetscCall(VecRestoreArrayRead(g, &a));
  }
  s->reference = PetscSqrtReal(sum);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One KSPSolve for the residual b, whose change is added to x, w, p; b becomes the residual that is left. */
static PetscErrorCode Correct(Saddle s, Vec f, Vec g, Vec w, Vec p) {
  const Vec change = s->change;
  PetscBool combined;
  PetscInt its;
  PetscFunctionBeginUser;
  s->products = 0;
  PetscCall(KSPSolve(s->ksp, s->b, change));
  PetscCall(KSPGetIterationNumber(s->ksp, &its));
  PetscCall(KSPGetConvergedReason(s->ksp, &s->why));
  PetscCall(KSPGetResidualNorm(s->ksp, &s->residual));
  s->its += its;
  if (s->why >= 0) {
    PetscCall(SaddleCombine(s, change, w, p, s->b, &combined));
    PetscCall(VecAXPY(s->x, 1, change));
    PetscCall(VecAXPY(s->pending, 1, change));
    if (!combined) {
      PetscCall(SaddleResidual(s, s->pending, f, g, s->x, w, p, s->b));
      PetscCall(VecSet(s->pending, 0));
    }
    PetscCall(VecNorm(s->b, NORM_2, &s->residual));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleSolve(Saddle s, Vec f, Vec g, Vec w, Vec p, Vec sigma, Vec d, Vec V) {
  PetscReal rtol, atol;
  PetscFunctionBeginUser;
  PetscCall(Reference(s, f, g));
  if (s->guess)
    PetscCall(Guess(s, V, sigma, d));
  else
    PetscCall(VecSet(s->x, 0));
  PetscCall(SaddleResidual(s, s->x, f, g, s->x, w, p, s->b));
  PetscCall(KSPGetTolerances(s->ksp, &rtol, &atol, NULL, NULL));
  PetscCall(VecSet(s->pending, 0));
  s->applied = s->renewed = s->its = 0;
  for (int round = 0; round < MOST_ROUNDS; round++) { /* rounding may spoil GMRES's own residual in stiff cases */
    PetscCall(Correct(s, f, g, w, p));
    if (s->why < 0 || s->residual <= 2 * PetscMax(rtol * s->reference, atol)) break;
  }
  if (s->age > 0) s->waste += PetscMax(s->its - s->fresh_its, 0);
  if (s->age == 0 && s->fresh_its < 0) s->fresh_its = s->its - s->renewed;
  s->age++;
  if (s->why >= 0) PetscCall(TakeSolution(s, sigma, d, V));
  PetscFunctionReturn(PETSC_SUCCESS);
}
