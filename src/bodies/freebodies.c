#include "bodies/freebodies.h"

PetscErrorCode FreeBodiesCreateVecs(Obstacles o, Vec *force, Vec *place) {
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(VecCreate(o->layout->comm, force));
  PetscCall(VecSetSizes(*force, 2 * o->layout->n + FreeBodiesOwn(o), PETSC_DETERMINE));
  PetscCall(VecSetType(*force, VECSTANDARD));
  if (!o->free->M) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 3 * o->free->M, place));
  PetscCall(VecGetArray(*place, &y));
  for (PetscInt b = 0; b < o->layout->bodies; b++)
    if (o->motion[b].free) PetscCall(PetscArraycpy(y + 3 * (o->motion[b].free - 1), o->motion[b].center, 2));
  PetscCall(VecRestoreArray(*place, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBodiesShift(Obstacles o, Vec place, Vec from, PetscReal d[]) {
  const PetscScalar *x, *y;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(place, &x));
  PetscCall(VecGetArrayRead(from, &y));
  for (PetscInt k = 0; k < FreeBodiesOwn(o); k++) d[k] = x[3 * o->free->first + k] - y[3 * o->free->first + k];
  PetscCall(VecRestoreArrayRead(from, &y));
  PetscCall(VecRestoreArrayRead(place, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void FreeBodiesRows(Obstacles o, const PetscReal load[], const PetscScalar x[], PetscScalar y[]) {
  const Layout l = o->layout;
  for (PetscInt k = 0; k < FreeBodiesOwn(o); k++) y[2 * l->n + k] = load ? load[k] : 0;
  for (PetscInt b = l->own; b < l->end; b++) {
    if (!o->motion[b].free) continue;
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    const PetscReal *X = o->X + 2 * l->start[b];
    const PetscScalar *q = x + FreeBodyAt(o, b);
    PetscScalar *u = y + 2 * LayoutOffset(l, b);
    MotionSum(p.center, LayoutCount(l, b), X, x + 2 * LayoutOffset(l, b), y + FreeBodyAt(o, b));
    for (PetscInt k = 0; k < 2 * LayoutCount(l, b); k += 2) {
      u[k] += o->ratio[b] * (q[0] - q[2] * (X[k + 1] - p.center[1]));
      u[k + 1] += o->ratio[b] * (q[1] + q[2] * (X[k] - p.center[0]));
    }
  }
}

/* A force alike on all markers, and a turn about their mean, by which R^T F becomes s. */
static void FreeBodyBalance(const PetscReal center[2], PetscInt n, const PetscReal X[], const PetscReal s[3],
                            PetscScalar F[]) {
  PetscReal mean[2] = {0, 0}, squares = 0, sum[3] = {0, 0, 0};
  MotionSum(center, n, X, F, sum);
  const PetscReal push[2] = {(s[0] - sum[0]) / n, (s[1] - sum[1]) / n};
  for (PetscInt k = 0; k < 2 * n; k++) mean[k % 2] += (X[k] - center[k % 2]) / n;
  for (PetscInt k = 0; k < 2 * n; k++) squares += PetscSqr(X[k] - center[k % 2] - mean[k % 2]);
  const PetscReal turn = (s[2] - sum[2] - n * (mean[0] * push[1] - mean[1] * push[0])) / squares;
  for (PetscInt k = 0; k < 2 * n; k += 2) {
    F[k] += push[0] - turn * (X[k + 1] - center[1] - mean[1]);
    F[k + 1] += push[1] + turn * (X[k] - center[0] - mean[0]);
  }
}

void FreeBodiesBalance(Obstacles o, const PetscReal load[], PetscScalar F[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    if (!o->motion[b].free) continue;
    const PetscReal *own = load + FreeBodyAt(o, b) - 2 * l->n, s[] = {-own[0], -own[1], -own[2]};
    FreeBodyBalance(p.center, LayoutCount(l, b), o->X + 2 * l->start[b], s, F + 2 * LayoutOffset(l, b));
  }
}

PetscErrorCode FreeBodiesBorder(Obstacles o, PetscInt begin, PetscInt end, PetscReal inertia, const PetscReal mass[],
                                PetscReal A[]) {
  const PetscInt first = 2 * o->layout->start[begin], markers = 2 * o->layout->start[end] - first;
  PetscInt at = markers, n = markers;
  PetscFunctionBeginUser;
  for (PetscInt b = begin; b < end; b++) n += o->motion[b].free ? 3 : 0;
  for (PetscInt k = markers - 1; k >= 0 && n > markers; k--) {
    PetscCall(PetscArraymove(A + k * n, A + k * markers, markers));
    PetscCall(PetscArrayzero(A + k * n + markers, n - markers));
  }
  PetscCall(PetscArrayzero(A + markers * n, (n - markers) * n));
  for (PetscInt b = begin; b < end; b++) {
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    for (PetscInt j = 0; j < 3 && o->motion[b].free; j++, at++) {
      const PetscReal unit = FreeBodyUnit(o, b, j);
      for (PetscInt k = 2 * o->layout->start[b]; k < 2 * o->layout->start[b + 1]; k++) {
        const PetscReal turn = k % 2 ? o->X[k - 1] - p.center[0] : p.center[1] - o->X[k + 1];
        A[at * n + k - first] = A[(k - first) * n + at] = unit * (j < 2 ? k % 2 == j : turn);
      }
      if (mass) A[at * (n + 1)] = -inertia * PetscSqr(unit) * mass[3 * (o->motion[b].free - 1) + j] / o->ratio[b];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal FreeBodiesSpeed(Obstacles o, const PetscScalar x[]) {
  PetscReal speed = 0;
  for (PetscInt b = o->layout->own; b < o->layout->end; b++) {
    if (!o->motion[b].free) continue;
    const PetscScalar *q = x + FreeBodyAt(o, b);
    speed = PetscMax(speed, PetscHypotReal(q[0], q[1]) + PetscAbsReal(q[2]) * ObstacleRadius(o, b));
  }
  return speed;
}

PetscErrorCode FreeBodiesRates(Obstacles o, Vec force, PetscReal q[]) {
  const PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(force, &x));
  PetscCall(LayoutGather(o->free, 3, x + 2 * o->layout->n, q));
  PetscCall(VecRestoreArrayRead(force, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A body's F turns with it to a new place; its sum stays. */
static void FreeBodyTurn(Obstacles o, PetscInt b, Instant to, PetscScalar F[]) {
  const PetscInt n = LayoutCount(o->layout, b);
  PetscReal lost[2] = {0, 0};
  for (PetscInt k = 0; k < 2 * n; k++) lost[k % 2] += F[k];
  MotionTurn(&o->motion[b], o->at, to, n, F);
  for (PetscInt k = 0; k < 2 * n; k++) lost[k % 2] -= F[k];
  for (PetscInt k = 0; k < 2 * n; k++) F[k] += lost[k % 2] / n;
}

PetscErrorCode FreeBodiesMove(Obstacles o, Vec force, PetscReal time, Vec place) {
  PetscReal *q;
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * o->free->M, &q));
  PetscCall(FreeBodiesRates(o, force, q));
  PetscCall(VecGetArray(place, &y));
  for (PetscInt k = 0; k < 3 * o->free->M; k++) y[k] += time * q[k];
  PetscCall(VecRestoreArray(place, &y));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeBodiesTurn(Obstacles o, Vec place, Vec force) {
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(force, &y));
  for (PetscInt b = o->layout->own; b < o->layout->end; b++)
    if (o->motion[b].turned && o->motion[b].free)
      FreeBodyTurn(o, b, (Instant){.place = place}, y + 2 * LayoutOffset(o->layout, b));
  PetscCall(VecRestoreArray(force, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
