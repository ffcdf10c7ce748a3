/* Wall forces: their place on the grid. wallinverse.c finds them. */
#include "fluid/walls.h"

/* The velocity component along the walls of pair dir (0 walls in x, 1 walls in y). */
static Field Tangential(int dir) {
  return dir ? FIELD_U : FIELD_V;
}

/* The lines of pair dir and their transforms: sines between the other pair's walls, Fourier modes where that direction
   is periodic. */
static PetscErrorCode CreatePair(Walls w, int dir) {
  const Grid g = w->fluid->grid;
  const fftw_r2r_kind forward = g->wall[1 - dir] ? FFTW_RODFT00 : FFTW_R2HC;
  const fftw_r2r_kind backward = g->wall[1 - dir] ? FFTW_RODFT00 : FFTW_HC2R;
  WallPair *p = &w->pair[dir];
  PetscFunctionBeginUser;
  p->length = dir ? g->columns[FIELD_U] : g->all_rows[FIELD_V];
  p->start = w->n;
  w->n += 2 * p->length;
  PetscCall(PetscMalloc2(p->length, &p->own, p->length, &p->other));
  for (int side = 0; side < 2; side++) p->line[side] = fftw_alloc_real((size_t)p->length);
  double *line = p->line[0];
  p->forward = p->backward = fftw_plan_r2r_1d((int)p->length, line, line, forward, FFTW_ESTIMATE);
  if (backward != forward) p->backward = fftw_plan_r2r_1d((int)p->length, line, line, backward, FFTW_ESTIMATE);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsCreate(Fluid fluid, Walls *out) {
  const Grid g = fluid->grid;
  const PetscInt longest = PetscMax(g->n[0], g->n[1]);
  Walls w;
  PetscFunctionBeginUser;
  PetscCall(PetscNew(&w));
  *out = w;
  w->fluid = fluid;
  w->alpha = -1;
  if (StokesIsExact(fluid)) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 1; dir >= 0; dir--)
    if (g->wall[dir]) PetscCall(CreatePair(w, dir));
  PetscCall(PetscMalloc3(longest, &w->work[0], longest, &w->work[1], longest, &w->work[2]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyPair(WallPair *p) {
  PetscFunctionBeginUser;
  PetscCall(PetscFree2(p->own, p->other));
  for (int side = 0; side < 2; side++) fftw_free(p->line[side]);
  if (p->backward != p->forward) fftw_destroy_plan(p->backward);
  if (p->forward) fftw_destroy_plan(p->forward);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WallsDestroy(Walls *walls) {
  Walls w = *walls;
  PetscFunctionBeginUser;
  if (!w) PetscFunctionReturn(PETSC_SUCCESS);
  for (int dir = 0; dir < 2; dir++) PetscCall(DestroyPair(&w->pair[dir]));
  PetscCall(PetscFree3(w->work[0], w->work[1], w->work[2]));
  PetscCall(PetscFree(*walls));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* This rank's part of a wall's line: entries first .. first + n - 1, at a[at], a[at + stride], .. of the field. */
typedef struct {
  PetscInt n, first, at, stride;
} LocalPart;

static LocalPart FindLocalPart(Walls w, int dir, int side) {
  const Grid g = w->fluid->grid;
  const Field f = Tangential(dir);
  if (dir) { /* a row of u: all on the rank next to the wall */
    const PetscBool here = g->rank == (side ? g->size - 1 : 0) ? PETSC_TRUE : PETSC_FALSE;
    return (LocalPart){here ? g->columns[f] : 0, 0, side ? (g->rows[f] - 1) * g->columns[f] : 0, 1};
  }
  return (LocalPart){g->rows[f], g->first, side ? g->columns[f] - 1 : 0, g->columns[f]};
}

PetscErrorCode WallsAdd(Walls w, const PetscScalar d[], Vec r) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(r, &a));
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->pair[dir].length; side++) {
      const LocalPart part = FindLocalPart(w, dir, side);
      const PetscInt from = w->pair[dir].start + side * w->pair[dir].length + part.first;
      PetscScalar *to = a + (dir ? 0 : GridLocalU(w->fluid->grid)) + part.at;
      for (PetscInt i = 0; i < part.n; i++) to[i * part.stride] += d[from + i];
    }
  PetscCall(VecRestoreArray(r, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The slope of psi along a wall, on this rank's faces of it, times kappa h. */
static void SlipOfWall(Walls w, int dir, int side, PetscReal kappa, const Rows *psi, PetscScalar y[]) {
  const Grid g = w->fluid->grid;
  const PetscInt columns = g->columns[FIELD_P];
  const LocalPart part = FindLocalPart(w, dir, side);
  PetscScalar *out = y + w->pair[dir].start + side * w->pair[dir].length + part.first;
  for (PetscInt i = 0; i < part.n; i++) {
    const PetscInt j = dir ? (side ? g->rows[FIELD_P] - 1 : 0) : i, column = dir ? i : (side ? columns - 1 : 0);
    const PetscScalar here = RowAt(psi, j)[column];
    const PetscScalar next = dir ? RowAt(psi, j)[column + 1 < columns ? column + 1 : 0] : RowAt(psi, j + 1)[column];
    out[i] = kappa * (next - here);
  }
}

PetscErrorCode WallsSlip(Walls w, Vec psi, PetscScalar y[]) {
  const Grid g = w->fluid->grid;
  const PetscReal kappa = -2 * w->fluid->nu / PetscSqr(g->h) / g->h;
  const PetscScalar *a;
  Rows rows;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(y, w->n));
  PetscCall(VecGetArrayRead(psi, &a));
  PetscCall(GridRows(g, FIELD_P, a, &rows));
  for (int dir = 0; dir < 2; dir++)
    for (int side = 0; side < 2 && w->pair[dir].length; side++) SlipOfWall(w, dir, side, kappa, &rows, y);
  PetscCall(VecRestoreArrayRead(psi, &a));
  if (g->size > 1) /* one rank has an entry, the others zero: the same bits everywhere */
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, y, (PetscMPIInt)w->n, MPIU_SCALAR, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
