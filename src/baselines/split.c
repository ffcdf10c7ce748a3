/* Scheme "split": the immersed boundary projection method of Ong and Lai, J. Comput. Phys. 408 (2020) 109277,
   sections 4.1 (no bending) and 4.2. First order in time. */
#include "baselines/baselines.h"
#include "baselines/lagrangian.h"
#include "scheme/stepcommon.h"

typedef struct {
  LagrangianSolver tension, bending; /* NULL where the scene has no such part */
  Vec r, u2, dp, q;                  /* momentum's right-hand side, velocity, pressures */
  Vec dsigma, rhs_sigma;             /* tension increment and right-hand side */
  Vec z, rhs_z, Xhat;                /* bending unknown, its right-hand side, X + dt u_inf */
  Vec U;                             /* marker vector, work */
} Split;

static PetscErrorCode SolverFailed(Scheme s, LagrangianSolver solver) {
  return SchemeSolverFailed(s, solver->prefix, solver->why, solver->its, solver->residual);
}

/* 1  H u3 = r - G p - S sigma - B X + bc1, where r = u/dt and B acts on X + dt u_inf */
static PetscErrorCode PredictVelocity(Scheme s, Split *d) {
  const State *q = &s->state;
  Fluid f = s->fluid;
  Coupling c = s->coupling;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(q->w, d->r));
  PetscCall(VecScale(d->r, 1 / q->dt));
  PetscCall(GridGradient(f->grid, -1, q->p, PETSC_TRUE, d->r));
  if (f->bc1) PetscCall(VecAXPY(d->r, 1, f->bc1));
  if (CouplingHasMembrane(c)) PetscCall(CouplingSpreadTension(c, -1, q->sigma, d->r));
  if (CouplingBending(c) > 0) {
    PetscCall(VecWAXPY(d->Xhat, q->dt, s->background, q->X));
    PetscCall(CouplingSpreadBending(c, -1, d->Xhat, d->r));
  }
  PetscCall(FluidSolveHelmholtz(f, d->r, d->u2));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 2  u2 = u3 + H^-1 B z, (I + dt E H^-1 B) z = -dt E u3 */
static PetscErrorCode ImplicitBending(Scheme s, Split *d) {
  Coupling c = s->coupling;
  PetscFunctionBeginUser;
  PetscCall(MarkersInterpolate(c->markers, d->u2, d->rhs_z));
  PetscCall(VecScale(d->rhs_z, -s->state.dt));
  PetscCall(LagrangianSolverSolve(d->bending, d->rhs_z, d->z));
  SchemeIterations(s, 0, d->bending->its);
  if (d->bending->why < 0) {
    PetscCall(SolverFailed(s, d->bending));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSet(d->r, 0));
  PetscCall(CouplingSpreadBending(c, 1, d->z, d->r));
  PetscCall(FluidSolveHelmholtz(s->fluid, d->r, d->r));
  PetscCall(VecAXPY(d->u2, 1, d->r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* 4  (S^T S + S^T G L^-1 G^T S) dsigma = (1/dt)(S^T u2 - g) - S^T G dp*
   5  dp = dp* + L^-1 G^T S dsigma */
static PetscErrorCode SolveTension(Scheme s, Split *d) {
  Fluid f = s->fluid;
  Coupling c = s->coupling;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(d->u2, d->r)); /* (1/dt) S^T u2 - S^T G dp* = (1/dt) S^T (u2 - dt G dp*) */
  PetscCall(GridGradient(f->grid, -s->state.dt, d->dp, PETSC_TRUE, d->r));
  PetscCall(MarkersInterpolate(c->markers, d->r, d->U));
  PetscCall(CouplingStretching(c, d->U, d->rhs_sigma));
  PetscCall(VecAXPY(d->rhs_sigma, -1, s->g));
  PetscCall(VecScale(d->rhs_sigma, 1 / s->state.dt));
  PetscCall(LagrangianSolverSolve(d->tension, d->rhs_sigma, d->dsigma));
  SchemeIterations(s, d->tension->its, s->report.bending_its);
  if (d->tension->why < 0) {
    PetscCall(SolverFailed(s, d->tension));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSet(d->r, 0));
  PetscCall(CouplingSpreadTension(c, 1, d->dsigma, d->r));
  PetscCall(MatMultTranspose(f->G, d->r, d->q));
  PetscCall(FluidSolvePoisson(f, d->q, d->q));
  PetscCall(VecAXPY(d->dp, 1, d->q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step_Split(Scheme s, PetscReal most) {
  Split *d = (Split *)s->data;
  State *q = &s->state;
  Fluid f = s->fluid;
  Coupling c = s->coupling;
  const PetscBool any = CouplingHasMembrane(c);
  PetscFunctionBeginUser;
  PetscCall(SchemePlace(s, 1 / q->dt, q->X, NULL, StateInstant(q)));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PredictVelocity(s, d));                 /* step 1 */
  if (d->bending) PetscCall(ImplicitBending(s, d)); /* step 2 */
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  /* 3  L dp* = -(1/dt)(G^T u2 + bc2) */
  PetscCall(GridGradientTranspose(f->grid, -1 / q->dt, d->u2, d->dp));
  if (f->bc2) PetscCall(VecAXPY(d->dp, -1 / q->dt, f->bc2));
  PetscCall(FluidSolvePoisson(f, d->dp, d->dp));
  if (any) PetscCall(SolveTension(s, d)); /* steps 4 and 5 */
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  /* 6  u = u2 - dt (G dp + S dsigma) */
  PetscCall(VecCopy(d->u2, q->w));
  PetscCall(GridGradient(f->grid, -q->dt, d->dp, PETSC_TRUE, q->w));
  if (any) PetscCall(CouplingSpreadTension(c, -q->dt, d->dsigma, q->w));
  PetscCall(SchemeMeasureDivergence(s, q->w, s->fluid->bc2));
  /* 7  X += dt (u_inf + E u),  p += dp,  sigma += dsigma */
  PetscCall(VecAXPY(q->p, 1, d->dp));
  if (!any) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingInterpolate(c, q->w, q->U));
  PetscCall(SchemeMarkerVelocity(s, q->U, q->sigma, q->U));
  PetscCall(VecAXPY(q->X, q->dt, q->U));
  PetscCall(VecAXPY(q->sigma, 1, d->dsigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp_Split(Scheme s) {
  Split *d = (Split *)s->data;
  const State *q = &s->state;
  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(q->w, &d->r));
  PetscCall(VecDuplicate(q->w, &d->u2));
  PetscCall(VecDuplicate(q->p, &d->dp));
  PetscCall(VecDuplicate(q->p, &d->q));
  PetscCall(VecDuplicate(q->sigma, &d->dsigma));
  PetscCall(VecDuplicate(q->sigma, &d->rhs_sigma));
  PetscCall(VecDuplicate(q->X, &d->z));
  PetscCall(VecDuplicate(q->X, &d->rhs_z));
  PetscCall(VecDuplicate(q->X, &d->Xhat));
  PetscCall(VecDuplicate(q->X, &d->U));
  if (!CouplingHasMembrane(s->coupling)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TensionSolverCreate(s->coupling, &d->tension));
  PetscCall(SchemeAddSolver(s, d->tension->ksp, d->tension->chat));
  if (CouplingBending(s->coupling) <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(BendingSolverCreate(s->coupling, &d->bending));
  PetscCall(SchemeAddSolver(s, d->bending->ksp, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy_Split(Scheme s) {
  Split *d = (Split *)s->data;
  Vec *all[] = {&d->r, &d->u2, &d->dp, &d->q, &d->dsigma, &d->rhs_sigma, &d->z, &d->rhs_z, &d->Xhat, &d->U};
  PetscFunctionBeginUser;
  PetscCall(LagrangianSolverDestroy(&d->tension));
  PetscCall(LagrangianSolverDestroy(&d->bending));
  for (size_t i = 0; i < sizeof(all) / sizeof(all[0]); i++) PetscCall(VecDestroy(all[i]));
  PetscCall(PetscFree(d));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SchemeCreate_Split(Scheme s) {
  const SchemeOps ops = {.step = Step_Split, .destroy = Destroy_Split};
  Split *d;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&d));
  SchemeImplement(s, &ops, d);
  PetscCall(SetUp_Split(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
