#include "mobility/boxgrid.h"
#include "layers/layerpairs.h"
#include "fluid/stokes/stokes.h"
#include "markers/streamresponse.h"

typedef struct {
  Fluid fluid;
  Stokes stokes;
  Layout layout; /* one body: the places, x fastest */
  Markers markers;
  LayerSetting set;
  LayerPairs pairs; /* pairs of places */
  Vec F, U;         /* at the places */
  const BoxAxis *axis;
  const BoxLattice *lattice;
  PaddedStencil *dipole; /* [DIPOLE_COUNT places] stencils of dipoles; NULL for forces, as the next two */
  StencilRows spots;     /* of one dipole on the grid */
  DipoleRows rows;       /* this dipole in the rows of a solve */
} BoxGrid;

static PetscErrorCode BoxGridPlace(BoxGrid *b, const char kernel[]) {
  const BoxAxis *x = &b->axis[0], *y = &b->axis[1];
  const PetscInt start[2] = {0, x->places * y->places};
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(LayoutCreate(PETSC_COMM_SELF, 1, start, NULL, &b->layout));
  PetscCall(MarkersCreate(b->fluid->grid, b->layout, kernel, PETSC_TRUE, 0, NULL, &b->markers));
  MarkersLeaveUnscaled(b->markers);
  PetscCall(LayoutCreateVec(b->layout, 2, &b->F));
  PetscCall(VecDuplicate(b->F, &b->U));
  PetscCall(VecGetArray(b->U, &a));
  for (PetscInt k = 0; k < start[1]; k++) {
    a[2 * k] = x->place[k % x->places];
    a[2 * k + 1] = y->place[k / x->places];
  }
  PetscCall(VecRestoreArray(b->U, &a));
  PetscCall(MarkersPlace(b->markers, b->U));
  if (!b->lattice->dipole) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(DIPOLE_COUNT * start[1], &b->dipole));
  for (PetscInt k = 0; k < start[1]; k++) {
    Stencil part[DIPOLE_COUNT];
    DipoleStencilsUnwrapped(b->fluid->grid, b->markers->X + 2 * k, part);
    for (int c = 0; c < DIPOLE_COUNT; c++) StencilPad(&part[c], &b->dipole[DIPOLE_COUNT * k + c]);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BoxGridCreate(const FluidSpec *spec, const char kernel[], const BoxLattice *lattice,
                                    const BoxAxis axis[2], BoxGrid *b) {
  const PetscBool dipole = lattice->dipole ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  *b = (BoxGrid){.axis = axis, .lattice = lattice};
  PetscCall(FluidCreate(spec, &b->fluid));
  PetscCall(StokesCreate(b->fluid, &b->stokes));
  PetscCall(BoxGridPlace(b, kernel));
  b->set = (LayerSetting){.markers = b->markers, .nu = spec->nu, .unit = lattice->unit};
  PetscCall(LayerPairsCreate(dipole ? &stresslet : &stokeslet, &b->set, dipole ? lattice->dipole : lattice->stokeslet,
                             dipole ? NULL : lattice->half, &(PairSources){.stencil = b->dipole}, NULL, &b->pairs));
  PetscCall(LayerPairsPlace(b->pairs));
  if (!dipole) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DipoleListCreate(b->fluid->grid, &b->spots));
  PetscCall(DipoleRowsCreate(b->fluid->grid, spec->nu, &b->rows));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode BoxGridDestroy(BoxGrid *b) {
  PetscFunctionBeginUser;
  PetscCall(VecDestroy(&b->F));
  PetscCall(VecDestroy(&b->U));
  PetscCall(DipoleRowsDestroy(&b->rows));
  PetscCall(StencilRowsDestroy(&b->spots));
  PetscCall(PetscFree(b->dipole));
  PetscCall(LayerPairsDestroy(&b->pairs));
  PetscCall(MarkersDestroy(&b->markers));
  PetscCall(LayoutDestroy(&b->layout));
  PetscCall(StokesDestroy(&b->stokes));
  PetscCall(FluidDestroy(&b->fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the lattice has of the parts of place j's source at place i, less what the near field gives of the walls: the
   velocities L; with the exact images where the smooth part itself is wanted. */
static void BoxGridLattice(BoxGrid *b, PetscInt i, PetscInt j, PetscReal L[2][DIPOLE_COUNT]) {
  const PetscReal *X = b->markers->X;
  const PairKernel *k = b->pairs->kernel;
  PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]}, free[PAIR_PARTS], C[PAIR_PARTS] = {0};
  const PetscReal fade = BoxImage(b->axis, d);
  LayerPairLattice(b->pairs, k->reach[NEAR_BOX], i, j, d, free);
  WallImageAdd(b->pairs->image, NULL, i, j, d, free, C);
  if (b->lattice->whole) WallImageAddExact(b->pairs->image, i, j, d, -1, C);
  for (int q = 0; q < k->places.parts; q++) /* as seen from a wall along x */
    L[k->places.response[q]][k->places.source[q]] = fade * (free[k->places.place[1][q]] - C[k->places.place[1][q]]);
}

/* Whether x and y are alike. */
static PetscBool IsSquare(const BoxAxis axis[2]) {
  const PetscReal x = axis[0].high - axis[0].low, y = axis[1].high - axis[1].low;
  return axis[0].wall == axis[1].wall && PetscAbsReal(x - y) < 1e-12 * x;
}

/* Add W of a pair of places and of its mirror images between walls. In a mirror one component of a velocity or of a
   force changes its sign, and xy of a tensor. In a square the pair with x and y exchanged is added too. */
static void AddEntry(const BoxGrid *b, int ci, int cj, const PetscInt a[2], const PetscInt s[2], PetscReal value,
                     PetscReal W[]) {
  const BoxAxis *axis = b->axis;
  const PetscBool dipoles = b->lattice->dipole ? PETSC_TRUE : PETSC_FALSE;
  const int parts = b->pairs->kernel->sources;
  for (int my = 0; my <= (int)axis[1].wall; my++)
    for (int mx = 0; mx <= (int)axis[0].wall; mx++) {
      PetscInt pair[2];
      for (int dir = 0; dir < 2; dir++) {
        const PetscInt n = axis[dir].places, mirror = dir ? my : mx;
        pair[dir] = !axis[dir].wall ? a[dir] : mirror ? (n - 1 - a[dir]) * n + n - 1 - s[dir] : a[dir] * n + s[dir];
      }
      const int turned = (ci ? my : mx) + (dipoles ? (cj == DIPOLE_XY ? mx + my : 0) : cj ? my : mx);
      const PetscReal sign = turned % 2 ? -1 : 1;
      W[((ci * parts + cj) * axis[0].pairs + pair[0]) * axis[1].pairs + pair[1]] += sign * value;
      if (IsSquare(axis) && (!dipoles || cj == DIPOLE_XX)) { /* yy from xx, forces along y from those along x */
        const PetscInt other = dipoles ? (1 - ci) * parts + DIPOLE_YY : 3 - ci * 2 - cj;
        W[(other * axis[0].pairs + pair[1]) * axis[1].pairs + pair[0]] += sign * value;
      }
    }
}

/* U = the velocity at all places by a unit source, part cj, at place j. */
static PetscErrorCode BoxGridRespond(BoxGrid *b, PetscInt j, int cj) {
  const Grid g = b->fluid->grid;
  const PetscReal no_flow[2] = {0, 0};
  PetscReal unit[DIPOLE_COUNT] = {0};
  Stencil spot[DIPOLE_SPOTS];
  PetscFunctionBeginUser;
  unit[cj] = 1;
  PetscCall(VecSet(b->F, 0));
  if (b->rows) {
    DipoleSpots(g, b->fluid->nu, b->markers->X + 2 * j, spot);
    PetscCall(StencilRowsPlace(b->spots, 1, spot));
    PetscCall(DipoleRowsSet(b->rows, b->spots, unit, PETSC_TRUE, NULL, no_flow));
  } else
    PetscCall(VecSetValue(b->F, 2 * j + cj, 1, INSERT_VALUES));
  PetscCall(VecAssemblyBegin(b->F));
  PetscCall(VecAssemblyEnd(b->F));
  PetscCall(MarkersRespond(b->markers, StokesStream(b->stokes), b->rows, 1 / PetscSqr(g->h), b->F, b->U));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All responses to unit sources at place s. */
static PetscErrorCode AddSource(BoxGrid *b, const PetscInt s[2], PetscReal scale, PetscReal W[]) {
  const BoxAxis *x = &b->axis[0], *y = &b->axis[1];
  const PetscInt j = s[1] * x->places + s[0];
  const PetscScalar *U;
  PetscReal(*L)[2][DIPOLE_COUNT];
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(x->places * y->places, &L));
  for (PetscInt i = 0; i < x->places * y->places; i++) BoxGridLattice(b, i, j, L[i]);
  for (int cj = 0; cj < b->pairs->kernel->sources; cj++) {
    if (cj == 1 && IsSquare(b->axis)) continue;
    PetscCall(BoxGridRespond(b, j, cj));
    PetscCall(VecGetArrayRead(b->U, &U));
    for (PetscInt i = 0; i < x->places * y->places; i++) {
      const PetscInt a[2] = {i % x->places, i / x->places};
      for (int ci = 0; ci < 2; ci++) AddEntry(b, ci, cj, a, s, scale * (U[2 * i + ci] - L[i][ci][cj]), W);
    }
    PetscCall(VecRestoreArrayRead(b->U, &U));
  }
  PetscCall(PetscFree(L));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxGridAdd(const FluidSpec *spec, MPI_Comm comm, const char kernel[], const BoxLattice *lattice,
                          const BoxAxis axis[2], PetscReal scale, PetscReal W[]) {
  PetscInt sources[2];
  PetscMPIInt rank, size;
  BoxGrid b;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (int dir = 0; dir < 2; dir++) sources[dir] = axis[dir].wall ? axis[dir].places / 2 : 1;
  PetscCall(BoxGridCreate(spec, kernel, lattice, axis, &b));
  for (PetscInt k = rank; k < sources[0] * sources[1]; k += size) {
    const PetscInt s[2] = {k % sources[0], k / sources[0]};
    PetscCall(AddSource(&b, s, scale, W));
  }
  PetscCall(BoxGridDestroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
