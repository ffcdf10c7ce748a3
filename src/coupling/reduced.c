/* The coupled problem reduced to its forces: residuals, products, and the velocity put together from the products. */
#include "coupling/saddle.h"

/* F[2M] = Dm^T sigma + (c_b ds/a0) D4 V, minus h^2 times the force on the markers. */
static PetscErrorCode Force(Saddle s, const PetscScalar x[], Vec F) {
  const Membrane m = s->coupling->membrane;
  PetscScalar *f;
  PetscFunctionBeginUser;
  PetscCall(VecSet(F, 0));
  PetscCall(VecGetArray(F, &f));
  if (m->bending > 0) MembraneBending(m, m->bending / s->fluid->a0, x, s->coupling->work, f);
  MembraneStretchingTranspose(m, s->coupling->tau, 1, x + s->n_velocity, f);
  PetscCall(VecRestoreArray(F, &f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* r += -E^T F/h^2 + d; leaves F. */
static PetscErrorCode AddForces(Saddle s, const PetscScalar x[], Vec r) {
  PetscFunctionBeginUser;
  if (s->coupling) {
    PetscCall(Force(s, x, s->F));
    PetscCall(CouplingSpreadAdd(s->coupling, -1 / PetscSqr(s->fluid->grid->h), s->coupling->E, s->F, r));
  }
  PetscCall(WallsAdd(s->walls, x + s->n_velocity + s->n_tension, r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y = scaled (V - E w + Theta F, Dm V/h^2, d + slip) of x and the velocity w that its forces F gave. Collective. */
static PetscErrorCode Conditions(Saddle s, const PetscScalar x[], Vec w, PetscScalar y[]) {
  const PetscInt n = s->n_velocity, walls = n + s->n_tension;
  PetscFunctionBeginUser;
  if (s->coupling) {
    const Coupling c = s->coupling;
    const PetscReal h2 = PetscSqr(c->grid->h);
    const PetscScalar *U;
    PetscScalar *F;
    PetscCall(CouplingInterpolate(c, c->E, w, s->U));
    PetscCall(VecGetArrayRead(s->U, &U));
    PetscCall(VecGetArray(s->F, &F));
    if (s->self)
      PetscCall(SelfMobilityMultTheta(s->self, F));
    else
      PetscCall(PetscArrayzero(F, n));
    for (PetscInt k = 0; k < n; k++) y[k] = SaddleVelocityScale(s, k / 2) * (x[k] - U[k] + F[k]);
    PetscCall(VecRestoreArray(s->F, &F));
    PetscCall(VecRestoreArrayRead(s->U, &U));
    MembraneStretching(c->membrane, c->tau, x, y + n);
    for (PetscInt k = 0; k < s->n_tension; k++) y[n + k] *= SaddleScale(s, k) / h2;
  }
  if (!s->walls->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(WallsSlip(s->walls, StokesPotential(s->stokes), y + walls));
  for (PetscInt k = 0; k < s->walls->n; k++) y[walls + k] += x[walls + k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleMult(Mat A, Vec x, Vec y) {
  Saddle s;
  const PetscScalar *xa;
  PetscScalar *ya;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  const PetscInt slot = PetscMin(s->products, SADDLE_KEPT);
  if (!s->w[slot]) {
    PetscCall(VecDuplicate(s->r, &s->w[slot]));
    PetscCall(DMCreateGlobalVector(s->fluid->grid->da[FIELD_P], &s->p[slot]));
    if (slot < SADDLE_KEPT) {
      PetscCall(VecDuplicate(s->x, &s->z[slot]));
      PetscCall(VecDuplicate(s->x, &s->Az[slot]));
    }
  }
  if (slot < SADDLE_KEPT) PetscCall(VecCopy(x, s->z[slot]));
  s->products++;
  PetscCall(VecGetArrayRead(x, &xa));
  if (s->coupling && !s->walls->n)
    PetscCall(CouplingClear(s->coupling, s->r, s->dirty));
  else /* wall forces are everywhere */
    PetscCall(VecSet(s->r, 0));
  PetscCall(AddForces(s, xa, s->r));
  PetscCall(StokesSolve(s->stokes, s->r, NULL, s->w[slot], s->p[slot]));
  PetscCall(VecGetArray(y, &ya));
  PetscCall(Conditions(s, xa, s->w[slot], ya));
  PetscCall(VecRestoreArray(y, &ya));
  PetscCall(VecRestoreArrayRead(x, &xa));
  if (slot < SADDLE_KEPT) PetscCall(VecCopy(y, s->Az[slot]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleResidual(Saddle s, Vec added, Vec f, Vec g, Vec x, Vec w, Vec p, Vec residual) {
  const PetscScalar *xa, *ga;
  PetscScalar *ra;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(added, &xa));
  PetscCall(AddForces(s, xa, f));
  PetscCall(VecRestoreArrayRead(added, &xa));
  PetscCall(VecGetArrayRead(x, &xa));
  if (s->coupling && added != x) PetscCall(Force(s, xa, s->F));
  if (s->fluid->bc2) { /* p holds the right-hand side, then the solution */
    PetscCall(VecAXPBY(p, -1, 0, s->fluid->bc2));
    PetscCall(StokesSolve(s->stokes, f, p, w, p));
  } else
    PetscCall(StokesSolve(s->stokes, f, NULL, w, p));
  PetscCall(VecGetArray(residual, &ra));
  PetscCall(Conditions(s, xa, w, ra));
  PetscCall(VecRestoreArrayRead(x, &xa));
  if (s->coupling) {
    PetscCall(VecGetArrayRead(g, &ga));
    for (PetscInt k = 0; k < s->n_tension; k++) ra[s->n_velocity + k] -= ga[k] * SaddleScale(s, k);
    PetscCall(VecRestoreArrayRead(g, &ga));
  }
  PetscCall(VecRestoreArray(residual, &ra));
  PetscCall(VecScale(residual, -1));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SaddleCombine(Saddle s, Vec x, Vec w, Vec p, Vec residual, PetscBool *combined) {
  const PetscInt n = s->products;
  const Vec rest = s->rest, *q = s->z;
  PetscReal upper[SADDLE_KEPT][SADDLE_KEPT], y[SADDLE_KEPT];
  PetscFunctionBeginUser;
  *combined = n <= SADDLE_KEPT ? PETSC_TRUE : PETSC_FALSE;
  if (!*combined) PetscFunctionReturn(PETSC_SUCCESS);
  /* x = SUM y_j z_j + rest: least squares by modified Gram-Schmidt, in z's place */
  PetscCall(VecCopy(x, rest));
  for (PetscInt j = 0; j < n; j++) {
    for (PetscInt i = 0; i < j; i++) {
      PetscCall(VecDot(q[j], q[i], &upper[i][j]));
      PetscCall(VecAXPY(q[j], -upper[i][j], q[i]));
    }
    PetscCall(VecNormalize(q[j], &upper[j][j]));
    PetscCall(VecDot(rest, q[j], &y[j]));
    PetscCall(VecAXPY(rest, -y[j], q[j]));
  }
  for (PetscInt j = n - 1; j >= 0; j--) {
    for (PetscInt i = j + 1; i < n; i++) y[j] -= upper[j][i] * y[i];
    y[j] = upper[j][j] > 0 ? y[j] / upper[j][j] : 0;
  }
  PetscCall(VecAXPY(x, -1, rest));
  PetscCall(VecMAXPY(w, n, y, s->w));
  PetscCall(VecMAXPY(p, n, y, s->p));
  for (PetscInt j = 0; j < n; j++) PetscCall(VecAXPY(residual, -y[j], s->Az[j]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
