#include "precondition/coarsegrid.h"
#include "markers/streamresponse.h"

#define SPACING 1.2 /* coarse cells between the points of a body, at most */

/* Cells of the run's grid across one of the coarse one, the first of these that fits; 0: none. */
static PetscInt CoarseTimes(const FluidSpec *spec) {
  const PetscInt times[] = {4, 5, 3, 2};
  for (int k = 0; k < 4; k++) {
    PetscBool fits = PETSC_TRUE;
    for (int d = 0; d < 2; d++)
      if (spec->cells[d] % times[k] || spec->cells[d] < 16 * times[k]) fits = PETSC_FALSE;
    if (fits) return times[k];
  }
  return 0;
}

static PetscErrorCode CreatePointLayout(CoarseGrid c, Bodies bodies) {
  const Layout fine = bodies->layout;
  PetscInt *start;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fine->bodies + 1, &start));
  start[0] = 0;
  for (PetscInt v = 0; v < fine->bodies; v++) { /* an odd number, which has no Nyquist mode */
    const PetscReal length = bodies->ds[v] * (PetscReal)LayoutCount(fine, v);
    start[v + 1] = start[v] + 2 * (PetscInt)PetscMax(3, 0.5 * length / (SPACING * c->fluid->grid->h)) + 1;
  }
  PetscCall(LayoutCreate(fine->comm, fine->bodies, start, fine->body, &c->layout));
  if (c->fluid->grid->size < fine->size) PetscCall(LayoutCreate(PETSC_COMM_SELF, fine->bodies, start, NULL, &c->all));
  PetscCall(PetscFree(start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseGridCreate(const FluidSpec *run, Bodies bodies, const char kernel[], CoarseGrid *out) {
  FluidSpec spec = BoxGridSpec(run);
  PetscReal longest = 0;
  CoarseGrid c;
  PetscFunctionBeginUser;
  *out = NULL;
  const PetscInt times = FluidSpecIsFree(run) ? 0 : CoarseTimes(run);
  if (!times) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&c));
  *out = c;
  for (int d = 0; d < 2; d++) spec.cells[d] /= times;
  if (!GridFits(spec.cells[1], bodies->layout->size)) spec.comm = PETSC_COMM_SELF;
  PetscCall(FluidCreate(&spec, &c->fluid));
  PetscCall(StokesCreate(c->fluid, &c->stokes));
  PetscCall(CreatePointLayout(c, bodies));
  const Layout points = c->all ? c->all : c->layout;
  PetscCall(MarkersCreate(c->fluid->grid, points, kernel, PETSC_TRUE, 0, NULL, &c->markers));
  for (PetscInt v = 0; v < bodies->vesicles; v++) longest = PetscMax(longest, bodies->membrane->L0[v]);
  PetscCall(MobilityTableCreate(&spec, c->markers->kernel, longest / 2, &c->table));
  PetscCall(MobilityTableSetUp(c->table, c->fluid->alpha));
  PetscCall(LayoutCreateVec(points, 2, &c->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseGridDestroy(CoarseGrid *coarse) {
  CoarseGrid c = *coarse;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecDestroy(&c->work));
  PetscCall(MobilityTableDestroy(&c->table));
  PetscCall(MarkersDestroy(&c->markers));
  PetscCall(LayoutDestroy(&c->layout));
  if (c->all) PetscCall(LayoutDestroy(&c->all));
  PetscCall(StokesDestroy(&c->stokes));
  PetscCall(FluidDestroy(&c->fluid));
  PetscCall(PetscFree(*coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* c->work = the own parts from[2n] of all ranks, or this rank's where the grid is shared out. */
static PetscErrorCode GatherPoints(CoarseGrid c, const PetscScalar from[]) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(c->work, &a));
  if (c->all)
    PetscCall(LayoutGather(c->layout, 2, from, a));
  else
    PetscCall(PetscArraycpy(a, from, 2 * c->layout->n));
  PetscCall(VecRestoreArrayWrite(c->work, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseGridPlace(CoarseGrid c, PetscScalar X[]) {
  const Grid g = c->fluid->grid;
  const PetscReal least = c->markers->least * g->h * (1 + 1e-9);
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < 2 * c->layout->n; k++) {
    const int d = (int)(k % 2);
    if (g->wall[d]) X[k] = PetscMax(g->lo[d] + least, PetscMin(g->hi[d] - least, X[k]));
  }
  PetscCall(GatherPoints(c, X));
  PetscCall(MarkersPlace(c->markers, c->work));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseGridApply(CoarseGrid c, PetscScalar F[]) {
  const PetscReal alpha = -1 / PetscSqr(c->fluid->grid->h);
  const PetscScalar *U;
  PetscFunctionBeginUser;
  PetscCall(GatherPoints(c, F));
  PetscCall(MarkersRespond(c->markers, StokesStream(c->stokes), NULL, alpha, c->work, c->work));
  PetscCall(VecGetArrayRead(c->work, &U));
  PetscCall(PetscArraycpy(F, U + (c->all ? 2 * c->layout->first : 0), 2 * c->layout->n));
  PetscCall(VecRestoreArrayRead(c->work, &U));
  PetscFunctionReturn(PETSC_SUCCESS);
}
