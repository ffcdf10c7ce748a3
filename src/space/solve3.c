#include "numerics/blas.h"
#include "space/space.h"

#define RENEWAL 0.1     /* iterations that new factors cost, over the number of harmonics */
#define STEP_RATIO 1.45 /* of two steps with the same factors */

/* Whether velocities are unknowns. */
static PetscBool SpaceSolvesVelocities(Space s) {
  return (PetscBool)(s->unknowns > s->size + s->count);
}

/* V += D_o (1 - ratio) U. The double layer of a rigid motion is nothing outside, but for an error which the viscosity
   inside would amplify. */
static PetscErrorCode SpaceAddDoubleLayers(Space s, const PetscReal U[], PetscReal V[]) {
  PetscReal *jump;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->share.own * s->size, &jump));
  for (PetscInt k = 0; k < s->share.own * s->size; k++) jump[k] = (1 - s->vesicle[k / s->size]->setting.ratio) * U[k];
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(Vesicle3RemoveMotion(s->vesicle[v], jump + v * s->size));
  PetscCall(CrossLayerAdd(s->cross, STRESSLET, jump, V));
  if (s->tube.tube) PetscCall(SpaceAddTube(s, STRESSLET, jump, V));
  PetscCall(PetscFree(jump));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceMobility(Space s, const PetscReal F[], const PetscReal U[], PetscReal V[]) {
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(DenseProduct(PETSC_FALSE, s->size, 1, s->size, s->vesicle[v]->S, F + v * s->size, V + v * s->size));
  if (s->cross) PetscCall(CrossLayerAdd(s->cross, STOKESLET, F, V));
  if (s->cross && s->tube.tube) PetscCall(SpaceAddTube(s, STOKESLET, F, V));
  if (SpaceSolvesVelocities(s)) PetscCall(SpaceAddDoubleLayers(s, U, V));
  for (PetscInt v = 0; v < s->share.own; v++) PetscCall(Vesicle3Velocity(s->vesicle[v], 1, V + v * s->size));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* F = C x of all vesicles, with what the motion Q/a0 adds to repulsion; V is work. */
static PetscErrorCode SpaceForces(Space s, const PetscScalar x[]) {
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscCall(Vesicle3Force(s->vesicle[v], x + v * s->unknowns, s->work.F + v * s->size));
    for (PetscInt k = 0; k < s->size; k++) s->work.V[v * s->size + k] = x[v * s->unknowns + k] / s->vesicle[v]->a0;
  }
  if (s->cross) PetscCall(CrossLayerAddContact(s->cross, PETSC_FALSE, s->work.V, s->work.F));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U of x, where velocities are unknowns. */
static void SpaceTakeVelocities(Space s, const PetscScalar x[]) {
  if (!SpaceSolvesVelocities(s)) return;
  for (PetscInt k = 0; k < s->share.own * s->size; k++)
    s->work.U[k] = x[(k / s->size + 1) * s->unknowns - s->size + k % s->size];
}

/* y = what the rows make of x by U = -M C x, or of U, with the equation of U. */
static PetscErrorCode SpaceMult(Mat A, Vec X, Vec Y) {
  Space s;
  const PetscScalar *x;
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(A, &s));
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(Y, &y));
  PetscCall(SpaceForces(s, x));
  SpaceTakeVelocities(s, x);
  PetscCall(SpaceMobility(s, s->work.F, s->work.U, s->work.V));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const PetscReal *U = s->work.U + v * s->size;
    PetscReal *V = s->work.V + v * s->size;
    for (PetscInt k = 0; k < s->size; k++) {
      if (SpaceSolvesVelocities(s)) y[v * s->unknowns + s->size + s->count + k] = U[k] + V[k];
      V[k] = SpaceSolvesVelocities(s) ? U[k] : -V[k];
    }
    PetscCall(Vesicle3Rows(s->vesicle[v], x + v * s->unknowns, V, y + v * s->unknowns));
  }
  PetscCall(VecRestoreArrayWrite(Y, &y));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x of each vesicle alone: of (Q, sigma), and where velocities are unknowns, of these, U = r_U - M C x with the rows of
   r_U on the right of (Q, sigma). */
static PetscErrorCode SpaceApplyFactors(PC pc, Vec r, Vec z) {
  Space s;
  PetscScalar *all;
  PetscReal *y;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &s));
  const PetscInt n = s->size + s->count, size = s->size;
  PetscCall(PetscMalloc1(n, &y));
  PetscCall(VecCopy(r, z));
  PetscCall(VecGetArray(z, &all));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const Vesicle3 vesicle = s->vesicle[v];
    PetscReal *x = all + v * s->unknowns, *F = s->work.F, *V = s->work.V;
    if (SpaceSolvesVelocities(s)) PetscCall(Vesicle3Rows(vesicle, NULL, x + n, y));
    for (PetscInt k = 0; k < n && SpaceSolvesVelocities(s); k++) x[k] -= y[k];
    PetscCall(DenseSolve(n, s->made.matrix + v * n * n, s->made.pivot + v * n, PETSC_FALSE, 1, x));
    if (!SpaceSolvesVelocities(s)) continue;
    PetscCall(Vesicle3Force(vesicle, x, F));
    PetscCall(DenseProduct(PETSC_FALSE, size, 1, size, vesicle->S, F, V));
    PetscCall(Vesicle3Velocity(vesicle, 1, V));
    for (PetscInt k = 0; k < size; k++) x[n + k] -= V[k];
  }
  PetscCall(VecRestoreArray(z, &all));
  PetscCall(PetscFree(y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceSolverCreate(Space s) {
  const PetscInt n = s->size + s->count, all = s->share.own * s->unknowns;
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(MatCreateShell(s->share.comm, all, all, PETSC_DETERMINE, PETSC_DETERMINE, s, &s->A));
  PetscCall(MatShellSetOperation(s->A, MATOP_MULT, (void (*)(void))SpaceMult));
  PetscCall(MatCreateVecs(s->A, &s->x, &s->b));
  PetscCall(PetscMalloc2(s->share.own * n * n, &s->made.matrix, s->share.own * n, &s->made.pivot));
  PetscCall(PetscMalloc2(s->share.own * s->size, &s->made.X, s->share.own * s->count, &s->made.sigma));
  PetscCall(KSPCreate(s->share.comm, &s->ksp));
  PetscCall(KSPSetOptionsPrefix(s->ksp, "coupled_"));
  PetscCall(KSPSetType(s->ksp, KSPFGMRES));
  PetscCall(KSPSetTolerances(s->ksp, s->setting.rtol, 0, PETSC_DEFAULT, 200));
  PetscCall(KSPSetOperators(s->ksp, s->A, s->A));
  PetscCall(KSPGetPC(s->ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetApply(pc, SpaceApplyFactors));
  PetscCall(PCShellSetContext(pc, s));
  PetscCall(PCShellSetName(pc, "dense problem of each vesicle"));
  PetscCall(KSPSetInitialGuessNonzero(s->ksp, PETSC_TRUE));
  PetscCall(KSPSetFromOptions(s->ksp));
  s->age = AgeNone();
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceSolverDestroy(Space s) {
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&s->ksp));
  PetscCall(MatDestroy(&s->A));
  PetscCall(VecDestroy(&s->x));
  PetscCall(VecDestroy(&s->b));
  PetscCall(PetscFree2(s->made.matrix, s->made.pivot));
  PetscCall(PetscFree2(s->made.X, s->made.sigma));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors of the vesicles where they are placed; report.failure when one is singular. */
static PetscErrorCode SpaceMakeFactors(Space s) {
  const PetscInt n = s->size + s->count;
  PetscBool singular = PETSC_FALSE;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscBool factored;
    PetscCall(Vesicle3Matrix(s->vesicle[v], s->made.matrix + v * n * n));
    PetscCall(DenseFactor(n, s->made.matrix + v * n * n, s->made.pivot + v * n, &factored));
    if (!factored) singular = PETSC_TRUE;
  }
  PetscCall(SpaceFailWhere(s, singular, "the problem of a vesicle is singular"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* New factors where the old ones have cost as much. */
static PetscErrorCode SpaceRenewFactors(Space s, PetscReal a0) {
  PetscFunctionBeginUser;
  if (!AgeIsOver(&s->age, a0, STEP_RATIO, RENEWAL * (PetscReal)s->count)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpaceMakeFactors(s));
  AgeRenew(&s->age, a0);
  s->made.a0 = a0;
  PetscCall(PetscArraycpy(s->made.X, s->work.star.X, s->share.own * s->size));
  PetscCall(PetscArraycpy(s->made.sigma, s->state.sigma, s->share.own * s->count));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceRecall(Space s) {
  PetscFunctionBeginUser;
  if (s->made.a0 <= 0) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpacePlace(s, s->made.X, s->made.sigma));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const PetscReal *X = s->made.X + v * s->size;
    PetscCall(Vesicle3Linearise(s->vesicle[v], s->made.a0, X, X, X));
  }
  PetscCall(SpaceMakeFactors(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceGuess(Space s, PetscReal a0) {
  const PetscInt pair = s->size + s->count;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(s->x, &x));
  for (PetscInt v = 0; v < s->share.own; v++) {
    PetscScalar *Q = x + v * s->unknowns;
    for (PetscInt k = 0; k < s->size; k++)
      Q[k] = a0 * (s->work.star.X[v * s->size + k] - s->work.Xhat[v * s->size + k]);
    PetscCall(PetscArraycpy(Q + s->size, s->work.star.sigma + v * s->count, s->count));
    PetscCall(PetscArraycpy(Q + pair, s->work.star.U + v * s->size, s->unknowns - pair));
  }
  PetscCall(VecRestoreArrayWrite(s->x, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceIterate(Space s, PetscReal a0, PetscReal *moved) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  *moved = 0;
  PetscCall(VecGetArrayRead(s->x, &x));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const PetscReal R = PetscCbrtReal(0.75 / PETSC_PI * s->vesicle[v]->volume);
    PetscReal sum = 0;
    for (PetscInt k = 0; k < s->size; k++) {
      const PetscInt at = v * s->size + k;
      const PetscReal new = s->work.Xhat[at] + x[v * s->unknowns + k] / a0;
      sum += PetscSqr(new - s->work.Y[at]);
      s->work.Y[at] = new;
    }
    *moved = PetscMax(*moved, PetscSqrtReal(sum / (4 * PETSC_PI)) / R);
  }
  PetscCall(VecRestoreArrayRead(s->x, &x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, moved, 1, MPIU_REAL, MPI_MAX, s->share.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* V = u_inf - M F, with the double layers of U. */
static PetscErrorCode SpaceFlow(Space s) {
  PetscFunctionBeginUser;
  PetscCall(SpaceMobility(s, s->work.F, s->work.U, s->work.V));
  for (PetscInt k = 0; k < s->share.own * s->size; k++) s->work.V[k] = s->work.background[k] - s->work.V[k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* b = targets - rows of the velocity u_inf - M known, which V becomes; or the targets and this velocity. */
static PetscErrorCode SpaceRightHandSide(Space s) {
  const PetscInt n = s->size + s->count;
  PetscScalar *all;
  PetscReal *y;
  PetscFunctionBeginUser;
  for (PetscInt v = 0; v < s->share.own; v++)
    PetscCall(PetscArraycpy(s->work.F + v * s->size, s->vesicle[v]->known, s->size));
  PetscCall(PetscArrayzero(s->work.U, s->share.own * s->size));
  PetscCall(SpaceFlow(s));
  PetscCall(PetscMalloc1(n, &y));
  PetscCall(VecGetArrayWrite(s->b, &all));
  for (PetscInt v = 0; v < s->share.own; v++) {
    const PetscInt at = v * s->size;
    const PetscReal *U = s->state.solved ? s->state.U + at : NULL;
    PetscScalar *b = all + v * s->unknowns;
    PetscCall(Vesicle3Target(s->vesicle[v], s->work.Xhat + at, s->work.star.X + at, U, b));
    if (SpaceSolvesVelocities(s)) {
      PetscCall(PetscArraycpy(b + n, s->work.V + at, s->size));
      continue;
    }
    PetscCall(Vesicle3Rows(s->vesicle[v], NULL, s->work.V + at, y));
    for (PetscInt k = 0; k < n; k++) b[k] -= y[k];
  }
  PetscCall(VecRestoreArrayWrite(s->b, &all));
  PetscCall(PetscFree(y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* V = u_inf - M (known + C x), or U of x. */
static PetscErrorCode SpaceVelocities(Space s) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(s->x, &x));
  PetscCall(SpaceForces(s, x));
  SpaceTakeVelocities(s, x);
  PetscCall(VecRestoreArrayRead(s->x, &x));
  for (PetscInt v = 0; v < s->share.own; v++)
    for (PetscInt k = 0; k < s->size; k++) s->work.F[v * s->size + k] += s->vesicle[v]->known[k];
  PetscCall(SpaceFlow(s));
  if (s->tube.tube) PetscCall(SpaceMeasureThrust(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SpaceSolve(Space s, PetscReal a0, PetscInt pass) {
  KSPConvergedReason why;
  PetscInt its;
  PetscReal residual;
  PetscFunctionBeginUser;
  if (!pass) PetscCall(SpaceRenewFactors(s, a0));
  if (*s->report.failure) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SpaceRightHandSide(s));
  PetscCall(KSPSolve(s->ksp, s->b, s->x));
  PetscCall(KSPGetConvergedReason(s->ksp, &why));
  PetscCall(KSPGetIterationNumber(s->ksp, &its));
  PetscCall(KSPGetResidualNorm(s->ksp, &residual));
  AgeSolved(&s->age, its);
  s->report.its += its;
  if (why < 0)
    PetscCall(PetscSNPrintf(s->report.failure, PETVES_MAX_MESSAGE,
                            "the solve with prefix coupled_ failed: %s after %" PetscInt_FMT " iterations, residual %g",
                            KSPConvergedReasons[why], its, (double)residual));
  else
    PetscCall(SpaceVelocities(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
