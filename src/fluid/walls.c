#include "fluid/walls.h"
#include "fluid/wallprofile.h"

#define DECAY 20 /* e^-20 is not felt */
#define SWEEPS 5
#define LONG_WAVES 48

/* Two walls facing one another in direction dir (0 x, 1 y): the field tangential to them, and the direction along. */
static Field Tangential(int dir) {
  return dir ? FIELD_U : FIELD_V;
}

/* Room for the modes of pair dir that are felt at each face of the other pair's walls: e^{-sqrt(lambda) y} large. */
static PetscErrorCode CreateCross(Walls w, int dir) {
  const Grid g = w->fluid->grid;
  const PetscInt faces = w->length[1 - dir], modes = w->length[dir];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(faces + 1, &w->row[dir]));
  w->row[dir][0] = 0;
  for (PetscInt j = 0, reach = modes; j < faces; j++) {
    while (reach > 1 && 2 * PetscSinReal(PETSC_PI * reach / (2.0 * g->n[1 - dir])) * j > DECAY) reach--;
    w->row[dir][j + 1] = w->row[dir][j] + reach;
  }
  PetscCall(PetscMalloc1(w->row[dir][faces], &w->cross[dir]));
  PetscFunctionReturn(PETSC_SUCCESS);
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
  PetscCall(PetscMalloc3(w->n / 2, &w->own, w->n / 2, &w->other, w->n, &w->slip));
  for (int dir = 0; dir < 2 && w->length[0] && w->length[1]; dir++) {
    PetscCall(CreateCross(w, dir));
    w->modes[dir] = PetscMin(w->length[dir], LONG_WAVES);
    PetscCall(PetscMalloc1(2 * w->modes[dir] * g->n[dir], &w->profile[dir]));
    for (int side = 0; side < 2; side++) PetscCall(PetscCalloc1(w->modes[dir], &w->low[dir][side]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsDestroy(Walls *walls) {
  Walls w = *walls;
  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 0; dir < 2; dir++) {
    PetscCall(PetscFree(w->cross[dir]));
    PetscCall(PetscFree(w->row[dir]));
    PetscCall(PetscFree(w->profile[dir]));
    for (int side = 0; side < 2; side++) PetscCall(PetscFree(w->low[dir][side]));
    for (int side = 0; side < 2 && w->length[dir]; side++) {
      fftw_destroy_plan(w->forward[dir][side]);
      fftw_destroy_plan(w->backward[dir][side]);
      fftw_free(w->line[dir][side]);
    }
  }
  PetscCall(PetscFree(w->flow));
  PetscCall(PetscFree3(w->own, w->other, w->slip));
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

/* Mode k of pair dir: its share in the slip along the other pair's walls. A force sin(pi k x/L) has the potential
   sqrt(lambda) psi(y) cos(pi k x/L), half a cell from the wall in x. */
static void FillCross(Walls w, int dir, PetscInt k, PetscReal lambda, const PetscReal psi[]) {
  const Grid g = w->fluid->grid;
  const PetscReal c = -2 * w->fluid->nu / PetscSqr(g->h) / g->h * PetscSqrtReal(lambda) *
                      PetscCosReal(PETSC_PI * (k + 1) / (2.0 * g->n[1 - dir]));
  for (PetscInt j = 0; j < w->length[1 - dir]; j++)
    if (k < w->row[dir][j + 1] - w->row[dir][j]) w->cross[dir][w->row[dir][j] + k] = c * (psi[j + 1] - psi[j]);
}

/* Flow of mode k of pair dir by the distance from its wall: along it (w + lambda psi) sin at half rows, away from it
   -sqrt(lambda) psi' cos between them. */
static void FillProfile(Walls w, int dir, PetscInt k, PetscReal lambda, const PetscReal force[],
                        const PetscReal psi[]) {
  const PetscInt n = w->fluid->grid->n[dir];
  PetscReal *along = w->profile[dir] + 2 * k * n, *away = along + n;
  for (PetscInt j = 0; j < n; j++) {
    along[j] = force[j] + lambda * psi[j];
    away[j] = j + 1 < n ? -PetscSqrtReal(lambda) * (psi[j + 1] - psi[j]) / w->fluid->grid->h : 0;
  }
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
      if (w->cross[dir]) FillCross(w, dir, i, lambda, psi);
      if (i < w->modes[dir]) FillProfile(w, dir, i, lambda, profile, psi);
    }
    PetscCall(PetscFree3(profile, psi, work));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The lines of pair dir: from residuals to the modes of the forces that cancel them (not transformed back yet). */
static void Invert(Walls w, int dir) {
  double **line = w->line[dir];
  for (int side = 0; side < 2; side++) fftw_execute(w->forward[dir][side]);
  for (PetscInt i = 0; i < w->length[dir]; i++) {
    const PetscReal own = w->own[w->start[dir] / 2 + i], other = w->other[w->start[dir] / 2 + i];
    const PetscReal one = line[0][i], two = line[1][i];
    line[0][i] = own * one + other * two;
    line[1][i] = other * one + own * two;
  }
}

/* Slip along the other pair's walls of the forces whose modes are in pair dir's lines. */
static void Cross(Walls w, int dir, PetscScalar slip[]) {
  const PetscInt n = w->length[1 - dir];
  for (PetscInt j = 0; j < n; j++) slip[j] = slip[n + j] = 0;
  for (PetscInt j = 0; j < n; j++) {
    const PetscReal *row = w->cross[dir] + w->row[dir][j];
    const PetscInt reach = w->row[dir][j + 1] - w->row[dir][j];
    for (int side = 0; side < 2; side++) { /* the second wall's share is the first one's mirrored */
      const double *a = w->line[dir][side];
      PetscReal odd = 0, even = 0; /* wave numbers, from 1 */
      for (PetscInt k = 0; k < reach; k += 2) odd += row[k] * a[k];
      for (PetscInt k = 1; k < reach; k += 2) even += row[k] * a[k];
      const PetscInt face = side ? n - 1 - j : j;
      const PetscReal sign = side ? -2 : 2; /* FFTW's sines come twice */
      slip[face] += sign * (even + odd);
      slip[n + face] += sign * (even - odd);
    }
  }
}

PetscErrorCode WallsPrecondition(Walls w, PetscScalar d[]) {
  const PetscBool two = w->cross[0] ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  if (!w->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(w));
  PetscCall(PetscArrayzero(w->slip, w->n));
  for (int sweep = 0; sweep < (two ? SWEEPS : 1); sweep++)
    for (int dir = 1; dir >= 0; dir--) {
      const PetscInt n = w->length[dir];
      if (!n) continue;
      for (int side = 0; side < 2; side++)
        for (PetscInt i = 0; i < n; i++) {
          const PetscInt k = w->start[dir] + side * n + i;
          w->line[dir][side][i] = d[k] - w->slip[k];
        }
      Invert(w, dir);
      if (two) Cross(w, dir, w->slip + w->start[1 - dir]);
    }
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->length[dir]; side++) {
      for (PetscInt k = 0; k < w->modes[dir]; k++) w->low[dir][side][k] = 2 * w->line[dir][side][k];
      fftw_execute(w->backward[dir][side]);
      PetscCall(PetscArraycpy(d + w->start[dir] + side * w->length[dir], w->line[dir][side], w->length[dir]));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Values at the distance eta (in cells) from a wall of entries at (j + offset); zero on the wall and past the end. */
static PetscReal Interpolated(PetscInt n, const PetscReal a[], PetscReal offset, PetscReal eta) {
  const PetscReal at = PetscMax(eta - offset, 0);
  const PetscInt j = PetscMin((PetscInt)at, n - 2);
  return a[j] + (at - j) * (a[j + 1] - a[j]);
}

PetscErrorCode WallsSetMarkers(Walls w, PetscInt M, const PetscScalar X[]) {
  const Grid g = w->fluid->grid;
  PetscReal *column;
  PetscFunctionBeginUser;
  if (!w->modes[0]) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SetUp(w));
  if (w->markers != M) PetscCall(PetscFree(w->flow));
  if (!w->flow) PetscCall(PetscMalloc1(4 * (w->modes[0] + w->modes[1]) * M, &w->flow));
  w->markers = M;
  column = w->flow;
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2; side++)
      for (PetscInt k = 0; k < w->modes[dir]; k++, column += 2 * M) {
        const PetscInt n = g->n[dir];
        const PetscReal *along = w->profile[dir] + 2 * k * n, *away = along + n;
        const PetscReal wave = PETSC_PI * (k + 1) / (g->hi[1 - dir] - g->lo[1 - dir]);
        for (PetscInt m = 0; m < M; m++) {
          const PetscReal x = wave * (X[2 * m + 1 - dir] - g->lo[1 - dir]);
          const PetscReal eta = (side ? g->hi[dir] - X[2 * m + dir] : X[2 * m + dir] - g->lo[dir]) / g->h;
          column[2 * m + 1 - dir] = PetscSinReal(x) * Interpolated(n, along, 0.5, eta);
          column[2 * m + dir] = (side ? -1 : 1) * PetscCosReal(x) * Interpolated(n, away, 1, eta);
        }
      }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsMarkerVelocity(Walls w, PetscReal alpha, PetscScalar U[]) {
  const PetscReal *column = w->flow;
  PetscFunctionBeginUser;
  if (!w->modes[0]) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2; side++)
      for (PetscInt k = 0; k < w->modes[dir]; k++, column += 2 * w->markers)
        for (PetscInt i = 0; i < 2 * w->markers; i++) U[i] += alpha * w->low[dir][side][k] * column[i];
  PetscFunctionReturn(PETSC_SUCCESS);
}
