/* Viscosity contrast in the matrix of the scheme direct (coupling/contrast.h). The jump J, less its flux, is an unknown
   of its own, so that the fluid's rows have the few markers near them only. */
#include "coupling/contrast.h"
#include "scheme/directrows.h"

/* The tensor of the unit jump of marker k in direction c. */
static void UnitTensor(DoubleLayer s, PetscInt k, int c, PetscReal T[DIPOLE_COUNT]) {
  const PetscReal *N = s->normal + 2 * k;
  T[DIPOLE_XX] = c ? 0 : 2 * N[0];
  T[DIPOLE_YY] = c ? 2 * N[1] : 0;
  T[DIPOLE_XY] = N[1 - c];
}

/* A column of J, whose tensor has T of the spot's part, in the fluid's rows; without a matrix the entries of the own
 * ones, into room. */
static PetscErrorCode AddDipole(DirectSolver d, Mat A, PetscInt room[], PetscInt column, PetscReal T,
                                const DipoleSpot *s) {
  const Grid g = d->fluid->grid;
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < s->line[1].n; b++)
    for (PetscInt a = 0; a < s->line[0].n; a++) {
      const PetscReal value = -T * s->value * s->line[0].weight[a] * s->line[1].weight[b];
      const PetscInt row = DirectIndex(d, s->field, DipoleEntry(g, s, 0, a), DipoleEntry(g, s, 1, b));
      if (A)
        PetscCall(MatSetValue(A, row, column, value, ADD_VALUES));
      else if (row >= d->start[g->rank] && row < d->start[g->rank + 1])
        room[row - d->start[g->rank]]++;
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddDipoles(DirectSolver d, Mat A, PetscInt room[], PetscInt J) {
  const DoubleLayer s = d->coupling->contrast;
  const Layout l = d->coupling->membrane->layout;
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < l->M; k++)
    for (int c = 0; c < 2 && s->ratio[LayoutBody(l, k)] != 1; c++) {
      PetscReal T[DIPOLE_COUNT];
      DipoleSpot spot[DIPOLE_SPOTS];
      UnitTensor(s, k, c, T);
      DipoleSpots(d->fluid->grid, d->fluid->nu, d->coupling->markers->X + 2 * k, spot);
      for (int q = 0; q < DIPOLE_SPOTS; q++)
        if (T[spot[q].part] != 0) PetscCall(AddDipole(d, A, room, J + 2 * k + c, T[spot[q].part], &spot[q]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectRoom(DirectSolver d, PetscInt room[]) {
  PetscFunctionBeginUser;
  PetscCall(AddDipoles(d, NULL, room, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* J - Q (1 - ratio) (U + (treading/a0) dU/dt) = 0 of one vesicle, a column of U at a time. */
static PetscErrorCode AddJump(DirectSolver d, Mat A, PetscInt v, PetscInt U, PetscInt J) {
  const DoubleLayer s = d->coupling->contrast;
  const Membrane m = d->coupling->membrane;
  const PetscInt first = 2 * m->layout->start[v], n = 2 * LayoutCount(m->layout, v);
  const PetscReal *N = s->normal + first, *along = s->along + first / 2;
  PetscReal *unit, *out;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(n, &unit, n, &out));
  for (PetscInt c = 0; c < n; c++) {
    PetscReal flux = 0;
    PetscCall(MatSetValue(A, J + first + c, J + first + c, 1, ADD_VALUES));
    if (s->ratio[v] == 1) continue;
    unit[c] = 1;
    PetscCall(PetscArraycpy(out, unit, n));
    MembraneLabelDerivative(m, v, d->coupling->treading[v] / d->fluid->a0, unit, out);
    for (PetscInt k = 0; k < n; k++) flux += N[k] * out[k];
    for (PetscInt k = 0; k < n; k++) {
      const PetscReal jump = (1 - s->ratio[v]) * (out[k] - flux / s->length[v] * N[k] / along[k / 2]);
      PetscCall(MatSetValue(A, J + first + k, U + first + c, -jump, ADD_VALUES));
    }
    unit[c] = 0;
  }
  PetscCall(PetscFree2(unit, out));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The box part in the rows of the own bodies' velocities: minus D of J's dipoles. */
static PetscErrorCode AddBoxPart(DirectSolver d, Mat A, PetscInt J) {
  const DoubleLayer s = d->coupling->contrast;
  const Layout all = d->coupling->bodies->layout, l = d->coupling->membrane->layout;
  PetscReal *D;
  PetscFunctionBeginUser;
  if (!DoubleBoxServes(s->box)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(2 * DIPOLE_COUNT * all->M * all->M, &D));
  PetscCall(DoubleBoxMatrix(s->box, -1, D));
  for (PetscInt i = 2 * all->first; i < 2 * (all->first + all->n); i++)
    for (PetscInt j = 0; j < 2 * l->M; j++) {
      PetscReal T[DIPOLE_COUNT], sum = 0;
      if (s->ratio[LayoutBody(l, j / 2)] == 1) continue;
      UnitTensor(s, j / 2, (int)(j % 2), T);
      for (int q = 0; q < DIPOLE_COUNT; q++) sum += T[q] * D[(DIPOLE_COUNT * (j / 2) + q) * 2 * all->M + i];
      PetscCall(MatSetValue(A, RowOf(d, i), J + j, sum, ADD_VALUES));
    }
  PetscCall(PetscFree(D));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Minus C_D of the vesicles' motion in the rows of the own obstacles. */
static PetscErrorCode AddToObstacles(DirectSolver d, Mat A, PetscInt U) {
  const Membrane m = d->coupling->membrane;
  const Layout all = d->coupling->bodies->layout;
  const PetscInt M = 2 * m->layout->M, n = 2 * all->M;
  PetscReal *C, *row;
  PetscFunctionBeginUser;
  if (n == M) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(n * n, &C, M, &row));
  PetscCall(DoubleLayerAdd(d->coupling->contrast, -1, PETSC_TRUE, 0, all->M, C));
  for (PetscInt i = PetscMax(M, 2 * all->first); i < 2 * (all->first + all->n); i++) {
    for (PetscInt j = 0; j < M; j++) row[j] = C[j * n + i];
    PetscCall(ContrastTread(m, 0, m->layout->bodies, d->coupling->treading, d->fluid->a0, 1, row));
    for (PetscInt j = 0; j < M; j++)
      if (row[j] != 0) PetscCall(MatSetValue(A, RowOf(d, i), U + j, row[j], ADD_VALUES));
  }
  PetscCall(PetscFree2(C, row));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectAddContrast(DirectSolver d, Mat A, PetscInt U, PetscInt J) {
  const Grid g = d->fluid->grid;
  const Layout l = d->coupling->membrane->layout;
  PetscReal *B;
  PetscFunctionBeginUser;
  if (g->rank == g->size - 1) PetscCall(AddDipoles(d, A, NULL, J));
  for (PetscInt v = l->own; v < l->end; v++) PetscCall(AddJump(d, A, v, U, J));
  PetscCall(PetscCalloc1(PetscSqr(2 * l->M), &B));
  PetscCall(ContrastMatrix(d->coupling, PETSC_TRUE, d->fluid->a0, 0, l->M, B));
  for (PetscInt i = 2 * l->first; i < 2 * (l->first + l->n); i++)
    for (PetscInt j = 0; j < 2 * l->M; j++)
      if (B[i * 2 * l->M + j] != 0) PetscCall(MatSetValue(A, U + i, U + j, B[i * 2 * l->M + j], ADD_VALUES));
  PetscCall(PetscFree(B));
  PetscCall(AddToObstacles(d, A, U));
  PetscCall(AddBoxPart(d, A, J));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode DirectContrastMean(DirectSolver d, Mat A, PetscInt J) {
  const DoubleLayer s = d->coupling->contrast;
  const Layout l = d->coupling->membrane->layout;
  const PetscReal h2 = PetscSqr(d->fluid->grid->h);
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * l->M; k++)
    for (PetscInt f = 0; f < MeanForces(d) && s->ratio[LayoutBody(l, k / 2)] != 1; f++)
      PetscCall(MatSetValue(A, FirstMean(d) + f, J + k, d->coupling->markers->X[2 * (k / 2) + f] * s->normal[k] / h2,
                            ADD_VALUES));
  PetscFunctionReturn(PETSC_SUCCESS);
}
