#include "scheme/history.h"

PetscErrorCode HistoryCreate(Scheme s, History *h) {
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(s->membrane->layout->bodies, &h->treading));
  for (int j = 0; j < BDF_MOST + BDF_STATES; j++) PetscCall(VecDuplicate(s->state.X, &h->room[j]));
  PetscCall(VecDuplicate(s->state.sigma, &h->carried));
  if (s->state.place) PetscCall(VecDuplicate(s->state.place, &h->guess[0]));
  if (s->state.place) PetscCall(VecDuplicate(s->state.solid, &h->guess[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryDestroy(History *h) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree(h->treading));
  for (int j = 0; j < BDF_MOST + BDF_STATES; j++) PetscCall(VecDestroy(&h->room[j]));
  PetscCall(VecDestroy(&h->carried));
  for (int k = 0; k < 2; k++) PetscCall(VecDestroy(&h->guess[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fit the label speed V of every vesicle, on all ranks. It is 0 unless the membrane is spectral: labels are shifted by
   trigonometric polynomials, which keep the lengths of spectral edges. */
static PetscErrorCode FitLabelSpeeds(History *h, Scheme s) {
  const Membrane m = s->membrane;
  const Layout l = m->layout;
  const PetscScalar *X, *U;
  PetscMPIInt vesicles;
  PetscFunctionBeginUser;
  h->moving = PETSC_FALSE;
  PetscCall(PetscArrayzero(h->treading, l->bodies));
  if (!s->past || m->derivative != DERIVATIVE_SPECTRAL) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecGetArrayRead(s->state.X, &X));
  PetscCall(VecGetArrayRead(s->state.U, &U));
  for (PetscInt v = l->own; v < l->end; v++) {
    const PetscInt at = 2 * LayoutOffset(l, v);
    h->treading[v] = MembraneTreading(m, v, X + at, U + at);
  }
  PetscCall(VecRestoreArrayRead(s->state.U, &U));
  PetscCall(VecRestoreArrayRead(s->state.X, &X));
  PetscCall(PetscMPIIntCast(l->bodies, &vesicles));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, h->treading, vesicles, MPIU_REAL, MPI_SUM, l->comm));
  for (PetscInt v = 0; v < l->bodies; v++)
    if (h->treading[v] != 0) h->moving = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* y(label) = x of state j at the label that this marker had then: labels turn by V times the time since state j. */
static PetscErrorCode CarryState(const History *h, Membrane m, PetscInt j, int each, Vec x, Vec y) {
  PetscScalar *from, *to;
  PetscReal back = 0;
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i <= j; i++) back += h->step[i];
  PetscCall(VecGetArrayPair(x, y, &from, &to));
  MembraneShiftLabels(m, h->treading, back, each, from, to);
  PetscCall(VecRestoreArrayPair(x, y, &from, &to));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Carry the marker vectors x of the first `count` states; copies are made only where labels move. */
static PetscErrorCode CarryAll(const History *h, Membrane m, PetscInt count, const Vec x[], const Vec room[], Vec y[]) {
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < count; j++) {
    y[j] = h->moving ? room[j] : x[j];
    if (h->moving) PetscCall(CarryState(h, m, j, 2, x[j], room[j]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryCarry(History *h, Scheme s, PetscReal dt) {
  Vec X[BDF_STATES], U[BDF_STATES];
  PetscFunctionBeginUser;
  h->n = PetscMin(s->past + 1, BDF_MOST);
  h->solved = 0;
  h->step[0] = dt;
  for (int j = 0; j < BDF_STATES; j++) {
    const State *q = j ? &s->old[j - 1] : &s->state;
    X[j] = q->X;
    U[j] = q->U;
    if (h->solved == j && j <= s->past && q->dt_last > 0) h->solved++;
    if (j + 1 < BDF_STATES) h->step[j + 1] = q->dt_last;
  }
  PetscCall(FitLabelSpeeds(h, s));
  PetscCall(CarryAll(h, s->membrane, h->n, X, h->room, h->X));
  PetscCall(CarryAll(h, s->membrane, PetscMax(1, h->solved), U, h->room + BDF_MOST, h->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistorySum(PetscInt count, const PetscReal weight[], PetscReal scale, const Vec x[], Vec y) {
  PetscReal scaled[BDF_STATES];
  PetscFunctionBeginUser;
  for (PetscInt j = 0; j < count; j++) scaled[j] = scale * weight[j];
  PetscCall(VecSet(y, 0));
  PetscCall(VecMAXPY(y, count, scaled, (Vec *)x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode HistoryEdges(History *h, Membrane m, PetscInt count, const PetscReal weight[], const Vec x[], Vec y) {
  PetscFunctionBeginUser;
  if (!h->moving) {
    PetscCall(HistorySum(count, weight, 1, x, y));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(VecSet(y, 0));
  for (PetscInt j = 0; j < count; j++) {
    PetscCall(CarryState(h, m, j, 1, x[j], h->carried));
    PetscCall(VecAXPY(y, weight[j], h->carried));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
