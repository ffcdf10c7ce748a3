/* The preconditioner of the coupled problem, P^-1 of DESIGN section 7. */
#include "coupling/saddle.h"

/* From U = E w1 and r_s: sigma, and U overwritten by U3, by whatever stands for the mobility. */
static PetscErrorCode SolveLagrangian(Saddle s, Vec U, Vec r_s, Vec sigma) {
  Coupling c = s->coupling;
  const PetscReal h2 = PetscSqr(c->grid->h), a0 = s->fluid->a0;
  const PetscScalar *ra;
  PetscScalar *ua, *sa;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r_s, &ra));
  PetscCall(VecGetArray(U, &ua));
  PetscCall(VecGetArray(sigma, &sa));
  switch (s->type) {
  case MOBILITY_TABLE:
    PetscCall(DenseBlocksSolve(s->blocks, ua, ra, sa));
    break;
  case MOBILITY_ILU: /* E A^-1 E^T ~ (1/a0) E (I + G diag(L)^-1 G^T) E^T: sigma = a0 Chat^-1 (S^T w1 - r_s) */
    MembraneStretching(c->membrane, c->tau, ua, c->sum);
    for (PetscInt k = 0; k < c->membrane->M; k++) c->sum[k] = a0 * (c->sum[k] / h2 - ra[k]);
    break;
  case MOBILITY_NONE:
    for (PetscInt k = 0; k < c->membrane->M; k++) sa[k] = -ra[k];
    break;
  }
  PetscCall(VecRestoreArray(sigma, &sa));
  PetscCall(VecRestoreArray(U, &ua));
  PetscCall(VecRestoreArrayRead(r_s, &ra));
  if (s->type == MOBILITY_ILU) {
    Vec rhs;
    PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, c->membrane->M, c->sum, &rhs));
    PetscCall(PCApply(s->ilu, rhs, sigma));
    PetscCall(VecDestroy(&rhs));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r = r_u - S sigma - B U3/a0 */
static PetscErrorCode MembraneForce(Saddle s, Vec r_u, Vec sigma, Vec U, Vec r) {
  Coupling c = s->coupling;
  const PetscReal h2 = PetscSqr(c->grid->h);
  const PetscScalar *ua, *sa;
  PetscScalar *F;
  PetscFunctionBeginUser;
  PetscCall(VecCopy(r_u, r));
  PetscCall(VecSet(s->F, 0));
  PetscCall(VecGetArrayRead(U, &ua));
  PetscCall(VecGetArrayRead(sigma, &sa));
  PetscCall(VecGetArray(s->F, &F));
  MembraneStretchingTranspose(c->membrane, c->tau, -1 / h2, sa, F);
  if (c->membrane->bending > 0 && s->type == MOBILITY_TABLE) /* the others know nothing of bending */
    MembraneBending(c->membrane, -c->membrane->bending / (h2 * s->fluid->a0), ua, c->work, F);
  PetscCall(VecRestoreArray(s->F, &F));
  PetscCall(VecRestoreArrayRead(sigma, &sa));
  PetscCall(VecRestoreArrayRead(U, &ua));
  PetscCall(CouplingSpreadAdd(c, 1, c->E, s->F, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The residual's third row is scaled: undo it. */
static PetscErrorCode UnscaleThirdRow(Saddle s, Vec r_s) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(r_s, &a));
  for (PetscInt k = 0; k < s->coupling->membrane->M; k++) a[k] /= SaddleScale(s, k);
  PetscCall(VecRestoreArray(r_s, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddlePrecondition(PC pc, Vec r, Vec z) {
  Saddle s;
  PetscScalar *ra, *za;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(VecGetArrayRead(r, (const PetscScalar **)&ra));
  PetscCall(VecGetArray(z, &za));
  PetscCall(SaddleSplit(s, 0, ra, s->r_s));
  PetscCall(SaddleSplit(s, 1, za, NULL));
  if (!s->coupling)
    PetscCall(StokesSolve(s->stokes, s->w[0], s->p[0], s->w[1], s->p[1]));
  else {
    PetscCall(UnscaleThirdRow(s, s->r_s));
    /* w1 = Stokes(r_u, r_p) */
    PetscCall(StokesSolve(s->stokes, s->w[0], s->p[0], s->u1, s->p1));
    /* U1, sigma, U3 */
    PetscCall(CouplingInterpolate(s->coupling, s->coupling->E, s->u1, s->U));
    PetscCall(SolveLagrangian(s, s->U, s->r_s, s->sigma));
    /* (u, p) = Stokes(r_u - S sigma - B U3/a0, r_p) */
    PetscCall(MembraneForce(s, s->w[0], s->sigma, s->U, s->r));
    PetscCall(StokesSolve(s->stokes, s->r, s->p[0], s->w[1], s->p[1]));
  }
  PetscCall(SaddleJoin(s, 0, ra, NULL));
  PetscCall(SaddleJoin(s, 1, za, s->sigma));
  PetscCall(VecRestoreArray(z, &za));
  PetscCall(VecRestoreArrayRead(r, (const PetscScalar **)&ra));
  PetscFunctionReturn(PETSC_SUCCESS);
}
