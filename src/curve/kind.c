#include "curve/kind.h"

#define KIND_ORDER 6 /* markers that a polynomial goes through */
#define KIND_ENDS 4  /* markers from an end within which forces are interpolated linearly */

/* Weights of the markers first .. first + KIND_ORDER - 1 in the value at t of the polynomial through these markers, or
   in the derivative of the polynomial; returns first. */
static PetscInt KindLagrange(PetscInt n, PetscReal t, PetscBool derivative, PetscReal weight[KIND_ORDER]) {
  const PetscInt low = (PetscInt)PetscFloorReal(t) - KIND_ORDER / 2 + 1,
                 first = PetscMax(0, PetscMin(n - KIND_ORDER, low));
  const PetscReal x = t - (PetscReal)first;
  for (int i = 0; i < KIND_ORDER; i++) {
    PetscReal value = 1, slope = 0;
    for (int j = 0; j < KIND_ORDER; j++) {
      if (j == i) continue;
      slope = (slope * (x - j) + value) / (i - j);
      value *= (x - j) / (i - j);
    }
    weight[i] = derivative ? slope : value;
  }
  return first;
}

/* X(t) of an open curve, or dX/dt. */
static void KindOpenValue(PetscInt n, const PetscReal X[], PetscReal t, PetscBool derivative, PetscReal Y[2]) {
  PetscReal weight[KIND_ORDER];
  const PetscInt first = KindLagrange(n, t, derivative, weight);
  Y[0] = Y[1] = 0;
  for (int i = 0; i < KIND_ORDER; i++)
    for (int c = 0; c < 2; c++) Y[c] += weight[i] * X[2 * (first + i) + c];
}

/* P = X less the straight line from the first point of a spanning curve to its image a period on. */
static PetscErrorCode KindPeriodicPart(const CurveKind *kind, PetscInt n, const PetscReal X[], PetscReal **P) {
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, P));
  for (PetscInt k = 0; k < 2 * n; k++) (*P)[k] = X[k] - kind->span[k % 2] * (PetscReal)(k / 2) / (PetscReal)n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveTangents(const CurveKind *kind, Spectral s, PetscInt n, const PetscReal X[], PetscReal T[]) {
  PetscReal *P;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n && kind->type == CURVE_OPEN; k++) KindOpenValue(n, X, (PetscReal)k, PETSC_TRUE, T + 2 * k);
  if (kind->type == CURVE_OPEN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KindPeriodicPart(kind, n, X, &P));
  for (PetscInt k = 0; k < 2 * n; k++) T[k] = kind->span[k % 2] / (PetscReal)n;
  SpectralDerivative(s, 1, 1, P, T);
  PetscCall(PetscFree(P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal CurveFinePlace(const CurveKind *kind, PetscInt times, PetscInt q) {
  return ((PetscReal)q + (kind->type == CURVE_OPEN ? 0.5 : 0)) / (PetscReal)times -
         (kind->type == CURVE_OPEN ? 0.5 : 0);
}

PetscErrorCode CurveFinePoints(const CurveKind *kind, PetscInt n, const PetscReal X[], PetscInt times, PetscReal Y[]) {
  PetscReal *P;
  PetscFunctionBeginUser;
  for (PetscInt q = 0; q < n * times && kind->type == CURVE_OPEN; q++)
    KindOpenValue(n, X, CurveFinePlace(kind, times, q), PETSC_FALSE, Y + 2 * q);
  if (kind->type == CURVE_OPEN) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(KindPeriodicPart(kind, n, X, &P));
  TrigonometricPoints(n, P, times, Y);
  for (PetscInt q = 0; q < 2 * n * times; q++) Y[q] += kind->span[q % 2] * (PetscReal)(q / 2) / (PetscReal)(n * times);
  PetscCall(PetscFree(P));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CurveOpenWeights(PetscInt n, PetscInt times, PetscInt q, PetscReal weight[]) {
  const CurveKind open = {.type = CURVE_OPEN};
  const PetscReal t = PetscMax(0, PetscMin((PetscReal)(n - 1), CurveFinePlace(&open, times, q)));
  PetscReal part[KIND_ORDER];
  for (PetscInt k = 0; k < n; k++) weight[k] = 0;
  if (t < KIND_ENDS || t > (PetscReal)(n - 1 - KIND_ENDS)) {
    const PetscInt k = PetscMin(n - 2, (PetscInt)t);
    weight[k + 1] = t - (PetscReal)k;
    weight[k] = 1 - weight[k + 1];
    return;
  }
  const PetscInt first = KindLagrange(n, t, PETSC_FALSE, part);
  for (int i = 0; i < KIND_ORDER; i++) weight[first + i] = part[i];
}

PetscBool CurveSetWalk(const CurveSet *set, PetscInt v, PetscInt k, PetscInt steps, PetscReal X[2]) {
  const CurveKind kind = CurveSetKind(set, v);
  const PetscInt first = set->start[v], n = set->start[v + 1] - first, to = k - first + steps;
  const PetscInt turns = to < 0 ? -((n - 1 - to) / n) : to / n;
  if (turns && kind.type == CURVE_OPEN) return PETSC_FALSE;
  for (int c = 0; c < 2; c++) X[c] = set->X[2 * (first + to - turns * n) + c] + (PetscReal)turns * kind.span[c];
  return PETSC_TRUE;
}

void CurveBounds(PetscInt n, const PetscReal X[], PetscReal around[4]) {
  for (PetscInt k = 0; k < 2 * n; k++) {
    PetscReal *side = around + 2 * (k % 2);
    side[0] = PetscMin(side[0], X[k]);
    side[1] = PetscMax(side[1], X[k]);
  }
}

PetscReal CurveLongestEdge(const CurveSet *set) {
  PetscReal longest = 0, to[2];
  for (PetscInt v = 0; v < set->curves; v++) {
    const PetscInt last = set->start[v + 1] - 1;
    for (PetscInt k = set->start[v]; k < last; k++) {
      const PetscReal x = set->X[2 * k + 2] - set->X[2 * k], y = set->X[2 * k + 3] - set->X[2 * k + 1];
      longest = PetscMax(longest, x * x + y * y);
    }
    if (last >= set->start[v] && CurveSetWalk(set, v, last, 1, to))
      longest = PetscMax(longest, PetscSqr(to[0] - set->X[2 * last]) + PetscSqr(to[1] - set->X[2 * last + 1]));
  }
  return PetscSqrtReal(longest);
}

PetscErrorCode CurveFineCreate(const CurveSet *set, PetscInt n, const PetscInt which[], PetscInt times,
                               CurveFine *fine) {
  PetscFunctionBeginUser;
  *fine = (CurveFine){.set = *set};
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt *start = set->start + which[k];
    fine->start[k + 1] = fine->start[k] + times * (start[1] - start[0]);
    fine->kind[k] = CurveSetKind(set, which[k]);
    fine->kind[k].around = n == 2 && fine->kind[k].around == which[1 - k] + 1 ? 2 - k : 0;
  }
  PetscCall(PetscMalloc1(2 * fine->start[n], &fine->X));
  for (PetscInt k = 0; k < n; k++) {
    const PetscInt *start = set->start + which[k];
    if (times == 1)
      PetscCall(PetscArraycpy(fine->X + 2 * fine->start[k], set->X + 2 * start[0], 2 * (start[1] - start[0])));
    else
      PetscCall(CurveFinePoints(&fine->kind[k], start[1] - start[0], set->X + 2 * start[0], times,
                                fine->X + 2 * fine->start[k]));
  }
  fine->set.curves = fine->set.moving = n;
  fine->set.start = fine->start;
  fine->set.kind = fine->kind;
  fine->set.X = fine->X;
  fine->set.smooth = PETSC_FALSE;
  fine->set.part = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CurveFineDestroy(CurveFine *fine) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(fine->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}
