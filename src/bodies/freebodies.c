#include "bodies/freebodies.h"

PetscErrorCode FreeBodiesCreateVecs(Obstacles o, Vec *force, Vec *place) {
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(o->layout->comm, 2 * o->layout->n + 3 * o->free->n, PETSC_DETERMINE, force));
  if (!o->free->M) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, 3 * o->free->M, place));
  PetscCall(VecGetArray(*place, &y));
  for (PetscInt b = 0; b < o->layout->bodies; b++)
    if (o->motion[b].free) PetscCall(PetscArraycpy(y + 3 * (o->motion[b].free - 1), o->motion[b].center, 2));
  PetscCall(VecRestoreArray(*place, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* U += alpha R q at the markers of one own body. */
static void FreeBodyCarry(Obstacles o, PetscInt b, PetscReal alpha, const PetscScalar q[3], PetscScalar U[]) {
  const PetscInt n = 2 * LayoutCount(o->layout, b);
  const BodyPose p = MotionPose(&o->motion[b], o->at);
  const PetscReal *X = o->X + 2 * o->layout->start[b];
  PetscScalar *u = U + 2 * LayoutOffset(o->layout, b);
  for (PetscInt k = 0; k < n; k += 2) {
    u[k] += alpha * (q[0] - q[2] * (X[k + 1] - p.center[1]));
    u[k + 1] += alpha * (q[1] + q[2] * (X[k] - p.center[0]));
  }
}

void FreeBodiesCarry(Obstacles o, PetscReal alpha, const PetscReal ratio[], const PetscScalar q[], PetscScalar U[]) {
  for (PetscInt b = o->layout->own; b < o->layout->end; b++)
    if (o->motion[b].free) FreeBodyCarry(o, b, ratio ? alpha * ratio[b] : alpha, q + FreeBodyAt(o, b), U);
}

void FreeBodiesShift(Obstacles o, Vec place, PetscScalar X[]) {
  for (PetscInt b = o->layout->own; b < o->layout->end; b++) {
    const BodyPose from = MotionPose(&o->motion[b], o->at), to = MotionPose(&o->motion[b], (Instant){.place = place});
    const PetscScalar way[] = {to.center[0] - from.center[0], to.center[1] - from.center[1], to.angle - from.angle};
    if (o->motion[b].free) FreeBodyCarry(o, b, 1, way, X);
  }
}

void FreeBodiesSum(Obstacles o, const PetscScalar F[], PetscScalar sum[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    if (!o->motion[b].free) continue;
    MotionSum(p.center, LayoutCount(l, b), o->X + 2 * l->start[b], F + 2 * LayoutOffset(l, b), sum + FreeBodyAt(o, b));
  }
}

/* A force alike on all markers, and a turn about their mean. */
void FreeBodiesBalance(Obstacles o, const PetscReal load[], PetscScalar F[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const PetscInt n = LayoutCount(l, b);
    const PetscReal *X = o->X + 2 * l->start[b], *own = load + FreeBodyAt(o, b);
    const BodyPose p = MotionPose(&o->motion[b], o->at);
    PetscReal mean[2] = {0, 0}, squares = 0;
    if (!o->motion[b].free) continue;
    PetscReal sum[3] = {own[0], own[1], own[2]};
    MotionSum(p.center, n, X, F + 2 * LayoutOffset(l, b), sum);
    for (PetscInt k = 0; k < 2 * n; k++) mean[k % 2] += (X[k] - p.center[k % 2]) / n;
    for (PetscInt k = 0; k < 2 * n; k++) squares += PetscSqr(X[k] - p.center[k % 2] - mean[k % 2]);
    const PetscReal turn = (mean[0] * sum[1] - mean[1] * sum[0] - sum[2]) / squares;
    FreeBodyCarry(o, b, 1, (PetscScalar[]){turn * mean[1] - sum[0] / n, -turn * mean[0] - sum[1] / n, turn}, F);
  }
}

PetscErrorCode FreeBodiesBlock(Obstacles o, PetscInt begin, PetscInt end, PetscReal h, PetscReal inertia,
                               const PetscReal mass[], PetscReal A[]) {
  const PetscInt first = 2 * o->layout->start[begin], markers = 2 * o->layout->start[end] - first;
  PetscInt at = markers, n = markers;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < markers * markers; k++) A[k] /= PetscSqr(h);
  for (PetscInt b = begin; b < end; b++) {
    const PetscInt low = 2 * o->layout->start[b], high = 2 * o->layout->start[b + 1];
    for (PetscInt j = low; j < high; j++)
      for (PetscInt i = low; i < high; i++) A[(j - first) * markers + i - first] += o->beta * o->N[i] * o->N[j];
    n += o->motion[b].free ? 3 : 0;
  }
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

void FreeBodiesFarthest(Obstacles o, Vec from, Vec to, PetscReal *farthest) {
  for (PetscInt b = 0; b < o->layout->bodies; b++)
    if (o->motion[b].free)
      *farthest = PetscMax(*farthest, ObstacleStride(o, b, (Instant){.place = from}, (Instant){.place = to}));
}

PetscErrorCode FreeBodiesMove(Obstacles o, Vec force, PetscReal time, Vec place) {
  const PetscScalar *x;
  PetscScalar *q, *y;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * o->free->M, &q));
  PetscCall(VecGetArrayRead(force, &x));
  PetscCall(LayoutGather(o->free, 3, x + 2 * o->layout->n, q));
  PetscCall(VecRestoreArrayRead(force, &x));
  PetscCall(VecGetArray(place, &y));
  for (PetscInt k = 0; k < 3 * o->free->M; k++) y[k] += time * q[k];
  PetscCall(VecRestoreArray(place, &y));
  PetscCall(PetscFree(q));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The sum of a body's F stays. */
PetscErrorCode FreeBodiesTurn(Obstacles o, Vec place, Vec force) {
  PetscScalar *y;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(force, &y));
  for (PetscInt b = o->layout->own; b < o->layout->end; b++) {
    const PetscInt n = LayoutCount(o->layout, b);
    PetscScalar *F = y + 2 * LayoutOffset(o->layout, b);
    PetscReal lost[2] = {0, 0};
    if (!o->motion[b].free) continue;
    for (PetscInt k = 0; k < 2 * n; k++) lost[k % 2] += F[k];
    MotionTurn(&o->motion[b], o->at, (Instant){.place = place}, n, F);
    for (PetscInt k = 0; k < 2 * n; k++) lost[k % 2] -= F[k];
    for (PetscInt k = 0; k < 2 * n && o->motion[b].turned; k++) F[k] += lost[k % 2] / n;
  }
  PetscCall(VecRestoreArray(force, &y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
