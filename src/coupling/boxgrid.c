#include "coupling/boxgrid.h"
#include "coupling/nearblock.h"
#include "fluid/walls.h"

#define WALL_ROUNDS 12
#define WALL_TOLERANCE 1e-5 /* of the wall forces: what it leaves in W is a thousandth of the error looked for */

typedef struct {
  Fluid fluid;
  Stokes stokes;
  Walls walls;
  Layout layout; /* one body: the places, x fastest */
  Markers markers;
  PaddedStencil *stencil;   /* [2 places] */
  struct _p_NearField near; /* of it only what the lattice's mobility needs */
  NearImage image;          /* what the near field has of the walls */
  Vec force, r, u, p;       /* on the grid */
  Vec F, U;                 /* at the places */
  PetscScalar *d, *slip;    /* wall forces and what is left of them */
  const BoxAxis *axis;
} BoxGrid;

static PetscErrorCode PlaceMarkers(BoxGrid *b, const char kernel[]) {
  const BoxAxis *x = &b->axis[0], *y = &b->axis[1];
  const PetscInt start[2] = {0, x->places * y->places};
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(LayoutCreate(PETSC_COMM_SELF, 1, start, &b->layout));
  PetscCall(MarkersCreate(b->fluid->grid, b->layout, kernel, PETSC_TRUE, &b->markers));
  PetscCall(LayoutCreateVec(b->layout, 2, &b->F));
  PetscCall(VecDuplicate(b->F, &b->U));
  PetscCall(VecGetArray(b->U, &a));
  for (PetscInt k = 0; k < start[1]; k++) {
    a[2 * k] = x->place[k % x->places];
    a[2 * k + 1] = y->place[k / x->places];
  }
  PetscCall(VecRestoreArray(b->U, &a));
  PetscCall(MarkersPlace(b->markers, b->U));
  PetscCall(PetscMalloc1(2 * start[1], &b->stencil));
  for (PetscInt k = 0; k < 2 * start[1]; k++) StencilPad(&b->markers->plain[k], &b->stencil[k]);
  for (PetscInt k = 0; k < start[1]; k++) StencilUnwrap(b->fluid->grid, b->markers->X + 2 * k, &b->stencil[2 * k]);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(const FluidSpec *spec, const char kernel[], const OffsetTable *lattice,
                             const BoxAxis axis[2], BoxGrid *b) {
  PetscFunctionBeginUser;
  b->axis = axis;
  PetscCall(FluidCreate(spec, &b->fluid));
  PetscCall(StokesCreate(b->fluid, &b->stokes));
  PetscCall(WallsCreate(b->fluid, &b->walls));
  PetscCall(PlaceMarkers(b, kernel));
  b->near = (struct _p_NearField){.markers = b->markers, .nu = spec->nu, .lattice = *lattice, .stencil = b->stencil};
  NearFarMake(b->markers->kernel, PETSC_FALSE, b->near.far);
  PetscCall(NearImageCreate(b->markers, spec->nu, lattice, &b->image));
  PetscCall(NearImagePlace(b->image, b->stencil));
  PetscCall(DMCreateGlobalVector(b->fluid->grid->velocity, &b->force));
  PetscCall(VecDuplicate(b->force, &b->r));
  PetscCall(VecDuplicate(b->force, &b->u));
  PetscCall(DMCreateGlobalVector(b->fluid->grid->da[FIELD_P], &b->p));
  PetscCall(PetscMalloc2(b->walls->n, &b->d, b->walls->n, &b->slip));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(BoxGrid *b) {
  Vec *all[] = {&b->force, &b->r, &b->u, &b->p, &b->F, &b->U};
  PetscFunctionBeginUser;
  for (int k = 0; k < 6; k++) PetscCall(VecDestroy(all[k]));
  PetscCall(PetscFree2(b->d, b->slip));
  PetscCall(PetscFree(b->stencil));
  PetscCall(NearImageDestroy(&b->image));
  PetscCall(MarkersDestroy(&b->markers));
  PetscCall(LayoutDestroy(&b->layout));
  PetscCall(WallsDestroy(&b->walls));
  PetscCall(StokesDestroy(&b->stokes));
  PetscCall(FluidDestroy(&b->fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u of the force on the grid; where the Stokes solve is a projection, with the wall forces that make it exact, found by
   Richardson's iteration. */
static PetscErrorCode Solve(BoxGrid *b) {
  const PetscInt n = b->walls->n;
  PetscReal first = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(b->d, n));
  for (int round = 0; round < WALL_ROUNDS; round++) {
    PetscReal rest = 0;
    PetscCall(VecCopy(b->force, b->r));
    PetscCall(WallsAdd(b->walls, b->d, b->r));
    PetscCall(StokesSolve(b->stokes, b->r, NULL, b->u, b->p));
    if (!n) break;
    PetscCall(WallsSlip(b->walls, StokesPotential(b->stokes), b->slip));
    for (PetscInt k = 0; k < n; k++) {
      b->slip[k] += b->d[k];
      rest = PetscMax(rest, PetscAbsReal(b->slip[k]));
    }
    if (!round) first = rest;
    if (rest <= WALL_TOLERANCE * first) break;
    PetscCall(WallsPrecondition(b->walls, b->slip));
    for (PetscInt k = 0; k < n; k++) b->d[k] -= b->slip[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What the lattice has of places i and j, less what the near field gives of the walls: xx, yy, xy, yx. */
static void Lattice(BoxGrid *b, PetscInt i, PetscInt j, PetscReal L[4]) {
  const PetscReal *X = b->markers->X;
  PetscReal d[2] = {X[2 * i] - X[2 * j], X[2 * i + 1] - X[2 * j + 1]};
  PetscReal C[4] = {0, 0, 0, 0};
  const PetscReal part = BoxImage(b->axis, d);
  NearLatticePair(&b->near, i, j, d, L);
  NearImageAdd(b->image, i, j, d, L, C);
  for (int c = 0; c < 4; c++) L[c] = part * (L[c] - C[c]);
}

/* Whether x and y are alike. */
static PetscBool IsSquare(const BoxAxis axis[2]) {
  const PetscReal x = axis[0].high - axis[0].low, y = axis[1].high - axis[1].low;
  return axis[0].wall == axis[1].wall && PetscAbsReal(x - y) < 1e-12 * x ? PETSC_TRUE : PETSC_FALSE;
}

/* W of the pair and of its mirror images between walls: a mirrored velocity or force changes its sign. In a square also
   of that with x and y exchanged. */
static void AddEntry(const BoxAxis axis[2], int ci, int cj, const PetscInt a[2], const PetscInt s[2], PetscReal value,
                     PetscReal W[]) {
  for (int my = 0; my <= (int)axis[1].wall; my++)
    for (int mx = 0; mx <= (int)axis[0].wall; mx++) {
      PetscInt pair[2];
      for (int dir = 0; dir < 2; dir++) {
        const PetscInt n = axis[dir].places, mirror = dir ? my : mx;
        pair[dir] = !axis[dir].wall ? a[dir] : mirror ? (n - 1 - a[dir]) * n + n - 1 - s[dir] : a[dir] * n + s[dir];
      }
      const PetscReal sign = ci != cj && mx != my ? -1 : 1; /* xx, yy keep theirs; xy, yx change it with one mirror */
      W[((ci * 2 + cj) * axis[0].pairs + pair[0]) * axis[1].pairs + pair[1]] += sign * value;
      if (IsSquare(axis)) W[((3 - ci * 2 - cj) * axis[0].pairs + pair[1]) * axis[1].pairs + pair[0]] += sign * value;
    }
}

/* All responses to unit forces at place s. */
static PetscErrorCode AddSource(BoxGrid *b, const PetscInt s[2], PetscReal scale, PetscReal W[]) {
  const BoxAxis *x = &b->axis[0], *y = &b->axis[1];
  const PetscInt j = s[1] * x->places + s[0];
  const PetscScalar *U;
  PetscReal L[4];
  PetscFunctionBeginUser;
  for (int cj = 0; cj < (IsSquare(b->axis) ? 1 : 2); cj++) {
    PetscCall(VecSet(b->F, 0));
    PetscCall(VecSetValue(b->F, 2 * j + cj, 1, INSERT_VALUES));
    PetscCall(VecAssemblyBegin(b->F));
    PetscCall(VecAssemblyEnd(b->F));
    PetscCall(VecSet(b->force, 0));
    PetscCall(MarkersSpread(b->markers, 1 / PetscSqr(b->fluid->grid->h), b->F, b->force));
    PetscCall(Solve(b));
    PetscCall(MarkersInterpolate(b->markers, b->u, b->U));
    PetscCall(VecGetArrayRead(b->U, &U));
    for (PetscInt i = 0; i < x->places * y->places; i++) {
      const PetscInt a[2] = {i % x->places, i / x->places};
      Lattice(b, i, j, L);
      for (int ci = 0; ci < 2; ci++)
        AddEntry(b->axis, ci, cj, a, s, scale * (U[2 * i + ci] - L[ci == cj ? ci : 2 + ci]), W);
    }
    PetscCall(VecRestoreArrayRead(b->U, &U));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BoxGridAdd(const FluidSpec *spec, MPI_Comm comm, const char kernel[], const OffsetTable *lattice,
                          const BoxAxis axis[2], PetscReal scale, PetscReal W[]) {
  PetscInt sources[2];
  PetscMPIInt rank, size;
  BoxGrid b;
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCallMPI(MPI_Comm_size(comm, &size));
  for (int dir = 0; dir < 2; dir++) sources[dir] = axis[dir].wall ? axis[dir].places / 2 : 1;
  PetscCall(Create(spec, kernel, lattice, axis, &b));
  for (PetscInt k = rank; k < sources[0] * sources[1]; k += size) {
    const PetscInt s[2] = {k % sources[0], k / sources[0]};
    PetscCall(AddSource(&b, s, scale, W));
  }
  PetscCall(Destroy(&b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
