#include "coupling/saddle.h"

static PetscInt VelocitySize(Grid g) {
  return GridLocalU(g) + g->columns[FIELD_V] * g->rows[FIELD_V];
}
static PetscInt PressureSize(Grid g) {
  return g->columns[FIELD_P] * g->rows[FIELD_P];
}

PetscErrorCode SaddleSplit(Saddle s, int slot, PetscScalar block[], Vec sigma) {
  const Grid g = s->fluid->grid;
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecPlaceArray(s->w[slot], block));
  PetscCall(VecPlaceArray(s->p[slot], block + VelocitySize(g)));
  if (!s->coupling || !sigma) PetscFunctionReturn(PETSC_SUCCESS);
  const PetscInt M = s->coupling->membrane->M;
  PetscCall(VecGetArray(sigma, &a));
  if (!g->rank) PetscCall(PetscArraycpy(a, block + VelocitySize(g) + PressureSize(g), M));
  PetscCallMPI(MPI_Bcast(a, (PetscMPIInt)M, MPIU_SCALAR, 0, g->comm));
  PetscCall(VecRestoreArray(sigma, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleJoin(Saddle s, int slot, PetscScalar block[], Vec sigma) {
  const Grid g = s->fluid->grid;
  const PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecResetArray(s->w[slot]));
  PetscCall(VecResetArray(s->p[slot]));
  if (!s->coupling || !sigma || g->rank) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(sigma, &a));
  PetscCall(PetscArraycpy(block + VelocitySize(g) + PressureSize(g), a, s->coupling->membrane->M));
  PetscCall(VecRestoreArrayRead(sigma, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal SaddleScale(Saddle s, PetscInt k) {
  const PetscReal h = s->fluid->grid->h;
  return PetscSqr(h) / s->coupling->membrane->spacing[k] * (1 + h * s->fluid->alpha);
}

/* Third row, scaled: S^T u = Dm U/h^2. */
static void ScaledStretching(Saddle s, const PetscScalar U[], PetscScalar y[]) {
  const Coupling c = s->coupling;
  MembraneStretching(c->membrane, c->tau, U, y);
  for (PetscInt k = 0; k < c->membrane->M; k++) y[k] *= SaddleScale(s, k) / PetscSqr(c->grid->h);
}

/* The membrane's part of A x: forces from sigma and from U = E u, and the third row; one interpolation, one spreading.
 */
static PetscErrorCode MultMembrane(Saddle s, Vec w, Vec sigma, Vec yw, Vec ysigma) {
  Coupling c = s->coupling;
  const PetscReal h2 = PetscSqr(c->grid->h);
  const PetscScalar *U, *sa;
  PetscScalar *F, *y;
  PetscFunctionBeginUser;
  PetscCall(CouplingInterpolate(c, c->E, w, s->U));
  PetscCall(VecSet(s->F, 0));
  PetscCall(VecGetArrayRead(sigma, &sa));
  if (s->self) { /* U = R (E u - Theta Dm^T sigma) */
    PetscScalar *ua;
    PetscCall(VecGetArray(s->U, &ua));
    PetscCall(SelfMobilityApply(s->self, sa, NULL, ua));
    PetscCall(VecRestoreArray(s->U, &ua));
  }
  PetscCall(VecGetArrayRead(s->U, &U));
  PetscCall(VecGetArray(s->F, &F));
  PetscCall(VecGetArray(ysigma, &y));
  MembraneStretchingTranspose(c->membrane, c->tau, 1 / h2, sa, F);
  if (c->membrane->bending > 0) MembraneBending(c->membrane, c->membrane->bending / (h2 * s->fluid->a0), U, c->work, F);
  ScaledStretching(s, U, y);
  PetscCall(VecRestoreArray(ysigma, &y));
  PetscCall(VecRestoreArray(s->F, &F));
  PetscCall(VecRestoreArrayRead(sigma, &sa));
  PetscCall(VecRestoreArrayRead(s->U, &U));
  PetscCall(CouplingSpreadAdd(c, 1, c->E, s->F, yw));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MultSaddle(Mat A, Vec x, Vec y) {
  Saddle s;
  PetscScalar *xa, *ya;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  Fluid f = s->fluid;
  PetscCall(VecGetArrayRead(x, (const PetscScalar **)&xa));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(SaddleSplit(s, 0, xa, s->sigma));
  PetscCall(SaddleSplit(s, 1, ya, NULL));
  PetscCall(MatMult(f->H, s->w[0], s->w[1]));
  PetscCall(GridGradient(f->grid, 1, s->p[0], PETSC_TRUE, s->w[1]));
  PetscCall(GridGradientTranspose(f->grid, 1, s->w[0], s->p[1]));
  if (s->coupling) PetscCall(MultMembrane(s, s->w[0], s->sigma, s->w[1], s->r_s));
  PetscCall(SaddleJoin(s, 0, xa, NULL));
  PetscCall(SaddleJoin(s, 1, ya, s->r_s));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(x, (const PetscScalar **)&xa));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMembranePart(Scene scene, Saddle s) {
  PetscFunctionBeginUser;
  PetscCall(MembraneCreateMarkerVec(s->coupling->membrane, &s->U));
  PetscCall(VecDuplicate(s->U, &s->F));
  PetscCall(MembraneCreateTensionVec(s->coupling->membrane, &s->sigma));
  PetscCall(VecDuplicate(s->sigma, &s->r_s));
  if (s->type == MOBILITY_TABLE) {
    PetscCall(MobilityCreate(scene, s->coupling, &s->mobility));
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

PetscErrorCode SaddleCreate(Scene scene, Fluid fluid, Coupling coupling, SelfMobility self, Saddle *out) {
  const Grid g = fluid->grid;
  const PetscInt nw = VelocitySize(g), np = PressureSize(g),
                 n = nw + np + (coupling && !g->rank ? coupling->membrane->M : 0);
  Saddle s;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  *out = s;
  s->fluid = fluid;
  s->coupling = coupling;
  s->self = self;
  s->type = (MobilityType)scene->mobility;
  s->fresh_its = -1;
  s->life = 1000;
  PetscCall(StokesCreate(fluid, &s->stokes));
  PetscCall(VecCreateMPI(g->comm, n, PETSC_DETERMINE, &s->x));
  PetscCall(VecDuplicate(s->x, &s->b));
  for (int k = 0; k < 2; k++) {
    PetscCall(VecCreateMPIWithArray(g->comm, 1, nw, PETSC_DETERMINE, NULL, &s->w[k]));
    PetscCall(VecCreateMPIWithArray(g->comm, 1, np, PETSC_DETERMINE, NULL, &s->p[k]));
  }
  PetscCall(VecCreateMPI(g->comm, nw, PETSC_DETERMINE, &s->r));
  PetscCall(VecDuplicate(s->r, &s->u1));
  PetscCall(VecCreateMPI(g->comm, np, PETSC_DETERMINE, &s->p1));
  if (coupling) PetscCall(CreateMembranePart(scene, s));
  PetscCall(MatCreateShell(g->comm, n, n, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))MultSaddle));
  PetscCall(KSPCreate(g->comm, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "coupled_"));
  PetscCall(KSPSetType(s->ksp, KSPFGMRES));
  PetscCall(KSPGMRESSetRestart(s->ksp, 60));
  PetscCall(KSPGMRESSetCGSRefinementType(s->ksp, KSP_GMRES_CGS_REFINE_IFNEEDED));
  PetscCall(KSPSetTolerances(s->ksp, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, 200));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, s));
  PetscCall(PCShellSetApply(pc, SaddlePrecondition));
  PetscCall(PCShellSetName(pc, "Stokes solves around the Lagrangian problem"));
  PetscCall(KSPSetFromOptions(s->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleDestroy(Saddle *saddle) {
  Saddle s = *saddle;
  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  Vec *vectors[] = {&s->x,  &s->b,  &s->w[0], &s->w[1], &s->p[0],  &s->p[1], &s->r,
                    &s->u1, &s->p1, &s->U,    &s->F,    &s->sigma, &s->r_s};
  for (size_t i = 0; i < sizeof(vectors) / sizeof(vectors[0]); i++) PetscCall(VecDestroy(vectors[i]));
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

/* Make the dense blocks for the present markers. */
static PetscErrorCode Refresh(Saddle s) {
  const GreenTable *table;
  PetscFunctionBeginUser;
  PetscCall(MobilityGetTable(s->mobility, s->fluid->alpha, &table));
  PetscCall(DenseBlocksFactor(s->blocks, s->mobility, table, s->self, s->fluid->a0));
  s->factored_a0 = s->fluid->a0;
  s->fresh_its = -1;
  s->age = 0;
  if (++s->refreshed % 16 == 0) s->life++; /* try a longer life now and then */
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleSetUp(Saddle s) {
  PetscFunctionBeginUser;
  if (!s->coupling) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->type == MOBILITY_ILU) {
    PetscCall(MatDestroy(&s->Chat));
    PetscCall(TensionAssemble(s->coupling, &s->Chat));
    PetscCall(PCSetOperators(s->ilu, s->Chat, s->Chat));
    PetscCall(PCSetUp(s->ilu));
  }
  if (s->type != MOBILITY_TABLE) PetscFunctionReturn(PETSC_SUCCESS);
  if (s->age >= s->life || !(PetscAbsReal(s->factored_a0 / s->fluid->a0 - 1) < 0.1)) PetscCall(Refresh(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* KSPSolve with old dense blocks for as many iterations as they are good for, then with new ones from there on. */
static PetscErrorCode Iterate(Saddle s) {
  const PetscBool old = s->type == MOBILITY_TABLE && s->coupling && s->age > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscReal rtol, atol, dtol;
  PetscInt max_it;
  PetscFunctionBeginUser;
  PetscCall(KSPGetTolerances(s->ksp, &rtol, &atol, &dtol, &max_it));
  if (old) PetscCall(KSPSetTolerances(s->ksp, rtol, atol, dtol, PetscMin(max_it, s->fresh_its + 2)));
  PetscCall(KSPSolve(s->ksp, s->b, s->x));
  PetscCall(KSPGetIterationNumber(s->ksp, &s->its));
  PetscCall(KSPGetConvergedReason(s->ksp, &s->why));
  if (old) PetscCall(KSPSetTolerances(s->ksp, rtol, atol, dtol, max_it));
  if (old && s->its < s->fresh_its + 2)
    s->life = PetscMax(s->life, s->age + 2); /* good so far */
  else if (old) {
    s->life = PetscMax(1, s->age); /* next time they are made anew before this happens */
    if (s->why == KSP_DIVERGED_ITS && s->its < max_it) {
      PetscBool nonzero;
      const PetscInt before = s->its;
      PetscCall(Refresh(s));
      PetscCall(KSPGetInitialGuessNonzero(s->ksp, &nonzero));
      PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
      PetscCall(KSPSolve(s->ksp, s->b, s->x));
      PetscCall(KSPSetInitialGuessNonzero(s->ksp, nonzero));
      PetscCall(KSPGetIterationNumber(s->ksp, &s->its));
      PetscCall(KSPGetConvergedReason(s->ksp, &s->why));
      s->its += before;
    }
  }
  if (s->age == 0 && s->fresh_its < 0) s->fresh_its = s->its;
  s->age++;
  PetscCall(KSPGetResidualNorm(s->ksp, &s->residual));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleSolve(Saddle s, Vec f, Vec g, Vec w, Vec p, Vec sigma) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(s->b, &a));
  PetscCall(SaddleSplit(s, 0, a, NULL));
  PetscCall(VecCopy(f, s->w[0]));
  if (s->fluid->bc2)
    PetscCall(VecAXPBY(s->p[0], -1, 0, s->fluid->bc2));
  else
    PetscCall(VecSet(s->p[0], 0));
  if (s->coupling) {
    const PetscScalar *ga;
    PetscScalar *ra;
    PetscCall(VecGetArrayRead(g, &ga));
    PetscCall(VecGetArray(s->r_s, &ra));
    for (PetscInt k = 0; k < s->coupling->membrane->M; k++) ra[k] = ga[k] * SaddleScale(s, k);
    PetscCall(VecRestoreArray(s->r_s, &ra));
    PetscCall(VecRestoreArrayRead(g, &ga));
  }
  PetscCall(SaddleJoin(s, 0, a, s->r_s));
  PetscCall(VecRestoreArray(s->b, &a));
  PetscCall(VecGetArray(s->x, &a));
  PetscCall(SaddleSplit(s, 0, a, NULL));
  PetscCall(VecCopy(w, s->w[0]));
  PetscCall(VecCopy(p, s->p[0]));
  PetscCall(SaddleJoin(s, 0, a, sigma));
  PetscCall(VecRestoreArray(s->x, &a));
  PetscCall(Iterate(s));
  if (s->why < 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArray(s->x, &a));
  PetscCall(SaddleSplit(s, 0, a, sigma));
  PetscCall(VecCopy(s->w[0], w));
  PetscCall(VecCopy(s->p[0], p));
  PetscCall(SaddleJoin(s, 0, a, NULL));
  PetscCall(VecRestoreArray(s->x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
