#include "coupling/coarse.h"

#define SPACING 1.2 /* coarse cells between the points of a vesicle, at most */

/* Cells of the run's grid across one of the coarse one, the first of these that fits; 0: none. */
static PetscInt Times(const FluidSpec *spec) {
  const PetscInt times[] = {4, 5, 3, 2};
  for (int k = 0; k < 4; k++) {
    PetscBool fits = PETSC_TRUE;
    for (int d = 0; d < 2; d++)
      if (spec->cells[d] % times[k] || spec->cells[d] < 16 * times[k]) fits = PETSC_FALSE;
    if (fits) return times[k];
  }
  return 0;
}

static PetscErrorCode CreateLayout(Coarse c, Layout fine, const PetscReal length[], PetscReal h) {
  PetscInt *start;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(fine->bodies + 1, &start));
  start[0] = 0;
  for (PetscInt v = 0; v < fine->bodies; v++) /* an odd number, which has no Nyquist mode */
    start[v + 1] = start[v] + 2 * (PetscInt)PetscMax(3, 0.5 * length[v] / (SPACING * h)) + 1;
  PetscCall(LayoutCreateLike(fine, start, &c->layout));
  PetscCall(PetscFree(start));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseCreate(const FluidSpec *run, Layout fine, const PetscReal length[], const char kernel[],
                            Coarse *out) {
  FluidSpec spec = *run;
  PetscReal longest = 0;
  Coarse c;
  PetscFunctionBeginUser;
  *out = NULL;
  const PetscInt times = FluidSpecIsFree(run) ? 0 : Times(run);
  if (!times) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&c));
  *out = c;
  for (int d = 0; d < 2; d++) spec.cells[d] /= times;
  spec.form = FORM_DISTURBANCE;
  PetscCall(PetscStrncpy(spec.helmholtz, "fftw_tridiagonal", sizeof(spec.helmholtz)));
  PetscCall(PetscStrncpy(spec.poisson, "fftw_tridiagonal", sizeof(spec.poisson)));
  PetscCall(FluidCreate(&spec, &c->fluid));
  PetscCall(StokesCreate(c->fluid, &c->stokes));
  PetscCall(CreateLayout(c, fine, length, c->fluid->grid->h));
  PetscCall(MarkersCreate(c->fluid->grid, c->layout, kernel, PETSC_TRUE, &c->markers));
  for (PetscInt v = 0; v < fine->bodies; v++) longest = PetscMax(longest, length[v]);
  PetscCall(MobilityTableCreate(&spec, c->markers->kernel, longest / 2, &c->table));
  PetscCall(MobilityTableSetUp(c->table, c->fluid->alpha));
  PetscCall(LayoutCreateVec(c->layout, 2, &c->X));
  PetscCall(VecDuplicate(c->X, &c->F));
  PetscCall(DMCreateGlobalVector(c->fluid->grid->velocity, &c->r));
  PetscCall(VecDuplicate(c->r, &c->u));
  PetscCall(DMCreateGlobalVector(c->fluid->grid->da[FIELD_P], &c->p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseDestroy(Coarse *coarse) {
  Coarse c = *coarse;
  PetscFunctionBeginUser;
  if (!c) PetscFunctionReturn(PETSC_SUCCESS);
  Vec *vecs[] = {&c->X, &c->F, &c->r, &c->u, &c->p};
  for (int k = 0; k < 5; k++) PetscCall(VecDestroy(vecs[k]));
  PetscCall(MobilityTableDestroy(&c->table));
  PetscCall(MarkersDestroy(&c->markers));
  PetscCall(LayoutDestroy(&c->layout));
  PetscCall(StokesDestroy(&c->stokes));
  PetscCall(FluidDestroy(&c->fluid));
  PetscCall(PetscFree(*coarse));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarsePlace(Coarse c, PetscScalar X[]) {
  const Grid g = c->fluid->grid;
  const PetscReal least = c->markers->least * g->h * (1 + 1e-9);
  PetscScalar *to;
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(c->X, &to));
  for (PetscInt k = 0; k < c->layout->n; k++)
    for (int d = 0; d < 2; d++) {
      const PetscReal x = X[2 * k + d];
      to[2 * k + d] = g->wall[d] ? PetscMax(g->lo[d] + least, PetscMin(g->hi[d] - least, x)) : x;
    }
  PetscCall(VecRestoreArrayWrite(c->X, &to));
  PetscCall(MarkersPlace(c->markers, c->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CoarseApply(Coarse c, PetscScalar F[]) {
  PetscFunctionBeginUser;
  PetscCall(VecPlaceArray(c->F, F));
  PetscCall(MarkersClear(c->markers, c->r, c->dirty));
  PetscCall(MarkersSpread(c->markers, -1 / PetscSqr(c->fluid->grid->h), c->F, c->r));
  PetscCall(StokesSolve(c->stokes, c->r, NULL, c->u, c->p));
  PetscCall(MarkersInterpolate(c->markers, c->u, c->F));
  PetscCall(VecResetArray(c->F));
  PetscFunctionReturn(PETSC_SUCCESS);
}
