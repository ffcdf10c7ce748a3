#include "fluid/walls.h"

/* Two walls facing one another in direction dir (0 x, 1 y): the field tangential to them, and the direction along. */
static Field Tangential(int dir) {
  return dir ? FIELD_U : FIELD_V;
}

PetscErrorCode WallsCreate(Fluid fluid, Walls *out) {
  const Grid g = fluid->grid;
  Walls w;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  *out = w;
  w->fluid = fluid;
  w->alpha = -1;
  if (StokesIsExact(fluid)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 1; dir >= 0; dir--) {
    if (!g->wall[dir]) continue;
    const PetscInt n = w->length[dir] = dir ? g->columns[FIELD_U] : g->all_rows[FIELD_V];
    const fftw_r2r_kind there = g->wall[1 - dir] ? FFTW_RODFT00 : FFTW_R2HC;
    const fftw_r2r_kind back = g->wall[1 - dir] ? FFTW_RODFT00 : FFTW_HC2R;
    w->start[dir] = w->n;
    w->n += 2 * n;
    for (int side = 0; side < 2; side++) {
      double *line = w->line[dir][side] = fftw_alloc_real((size_t)n);
      w->forward[dir][side] = fftw_plan_r2r_1d((int)n, line, line, there, FFTW_ESTIMATE);
      w->backward[dir][side] = fftw_plan_r2r_1d((int)n, line, line, back, FFTW_ESTIMATE);
    }
  }
  PetscCall(PetscMalloc2(w->n / 2, &w->own, w->n / 2, &w->other));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsDestroy(Walls *walls) {
  Walls w = *walls;
  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->length[dir]; side++) {
      fftw_destroy_plan(w->forward[dir][side]);
      fftw_destroy_plan(w->backward[dir][side]);
      fftw_free(w->line[dir][side]);
    }
  PetscCall(PetscFree2(w->own, w->other));
  PetscCall(PetscFree(*walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part of a wall's line: entries first .. first + n - 1, at a[0], a[stride], .. of the field. */
static PetscInt LocalPart(Walls w, int dir, int side, PetscInt *first, PetscInt *at, PetscInt *stride) {
  const Grid g = w->fluid->grid;
  const Field f = Tangential(dir);
  *first = 0;
  *at = 0;
  *stride = 1;
  if (dir) { /* a row of u */
    if (side) *at = (g->rows[f] - 1) * g->columns[f];
    return g->rank == (side ? g->size - 1 : 0) ? g->columns[f] : 0;
  }
  *first = g->first;
  *at = side ? g->columns[f] - 1 : 0;
  *stride = g->columns[f];
  return g->rows[f];
}

PetscErrorCode WallsAdd(Walls w, const PetscScalar d[], Vec r) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(r, &a));
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->length[dir]; side++) {
      PetscInt first, at, stride;
      const PetscInt n = LocalPart(w, dir, side, &first, &at, &stride);
      const PetscScalar *from = d + w->start[dir] + side * w->length[dir] + first;
      PetscScalar *to = a + (dir ? 0 : GridLocalU(w->fluid->grid)) + at;
      for (PetscInt i = 0; i < n; i++) to[i * stride] += from[i];
    }
  PetscCall(VecRestoreArray(r, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsSlip(Walls w, Vec psi, PetscScalar y[]) {
  const Grid g = w->fluid->grid;
  const PetscReal kappa = -2 * w->fluid->nu / PetscSqr(g->h) / g->h;
  const PetscInt columns = g->columns[FIELD_P];
  const PetscScalar *a;
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(y, w->n));
  PetscCall(VecGetArrayRead(psi, &a));
  PetscCall(GridRows(g, FIELD_P, a, &rows));
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->length[dir]; side++) {
      PetscInt first, at, stride;
      const PetscInt n = LocalPart(w, dir, side, &first, &at, &stride);
      PetscScalar *out = y + w->start[dir] + side * w->length[dir] + first;
      for (PetscInt i = 0; i < n; i++) {
        const PetscInt j = dir ? (side ? g->rows[FIELD_P] - 1 : 0) : i, column = dir ? i : (side ? columns - 1 : 0);
        const PetscScalar here = RowAt(&rows, j)[column];
        const PetscScalar next = dir ? RowAt(&rows, j)[column + 1 < columns ? column + 1 : 0]
                                     : RowAt(&rows, j + 1)[column];
        out[i] = kappa * (next - here);
      }
    }
  PetscCall(VecRestoreArrayRead(psi, &a));
  if (g->size > 1) /* one rank has an entry, the others zero: the same bits everywhere */
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, y, (PetscMPIInt)w->n, MPIU_SCALAR, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SetUp(Walls w) {
  const Grid g = w->fluid->grid;
  const PetscReal h2 = PetscSqr(g->h), kappa = -2 * w->fluid->nu / h2;
  PetscFunctionBeginUser;
  if (w->alpha == w->fluid->alpha) PetscFunctionReturn(PETSC_SUCCESS);
  w->alpha = w->fluid->alpha;
  for (int dir = 0; dir < 2; dir++) {
    const PetscInt m = w->length[dir], n = g->n[dir], cells = g->n[1 - dir];
    PetscReal *profile, *psi, *work;
    PetscCall(PetscMalloc3(n, &profile, n, &psi, n, &work));
    for (PetscInt i = 0; i < m; i++) {
      const PetscInt k = w->start[dir] / 2 + i;
      const PetscReal argument = g->wall[1 - dir] ? PETSC_PI * (i + 1) / (2.0 * cells)
                                                  : PETSC_PI * PetscMin(i, m - i) / m;
      const PetscReal lambda = 4 / h2 * PetscSqr(PetscSinReal(argument));
      const PetscReal size = g->wall[1 - dir] ? 2.0 * cells : m; /* of FFTW's transforms there and back */
      if (lambda == 0) {                                         /* no slip */
        w->own[k] = 1 / size;
        w->other[k] = 0;
        continue;
      }
      WallProfile(w->fluid, n, lambda, work, profile, psi);
      const PetscReal own = 1 - kappa * lambda * psi[0], other = -kappa * lambda * psi[n - 1];
      const PetscReal determinant = PetscSqr(own) - PetscSqr(other);
      w->own[k] = own / determinant / size;
      w->other[k] = -other / determinant / size;
    }
    PetscCall(PetscFree3(profile, psi, work));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsPrecondition(Walls w, PetscScalar d[]) {
  PetscFunctionBeginUser;
  if (!w->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(w));
  for (int dir = 0; dir < 2; dir++) {
    const PetscInt n = w->length[dir];
    double **line = w->line[dir];
    PetscScalar *at = d + w->start[dir];
    if (!n) continue;
    for (int side = 0; side < 2; side++) {
      PetscCall(PetscArraycpy(line[side], at + side * n, n));
      fftw_execute(w->forward[dir][side]);
    }
    for (PetscInt i = 0; i < n; i++) {
      const PetscReal own = w->own[w->start[dir] / 2 + i], other = w->other[w->start[dir] / 2 + i];
      const PetscReal one = line[0][i], two = line[1][i];
      line[0][i] = own * one + other * two;
      line[1][i] = other * one + own * two;
    }
    for (int side = 0; side < 2; side++) {
      fftw_execute(w->backward[dir][side]);
      PetscCall(PetscArraycpy(at + side * n, line[side], n));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
