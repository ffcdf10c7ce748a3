/* A forcing knows where it is not zero: after a term that is everywhere, one in the markers' window, and one in the
   window of markers that have moved, each after a clear, nothing is left of what was there before. */
#include "facts.h"

static PetscBool Within(const PetscInt range[2], PetscInt k) {
  return k >= range[0] && k < range[1] ? PETSC_TRUE : PETSC_FALSE;
}

/* The largest value outside the window. */
static PetscErrorCode Outside(const Forcing *f, PetscReal *largest) {
  const Grid g = f->grid;
  const PetscScalar *a;
  PetscFunctionBeginUser;
  *largest = 0;
  PetscCall(VecGetArrayRead(f->values, &a));
  for (int c = 0; c < 2; c++)
    for (PetscInt j = 0; j < g->rows[c]; j++)
      for (PetscInt i = 0; i < g->columns[c]; i++)
        if (!Within(f->window.rows, j) || !Within(f->window.columns, i))
          *largest = PetscMax(*largest, PetscAbsReal(a[GridRowStart(g, (Field)c, j) + i]));
  PetscCall(VecRestoreArrayRead(f->values, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Cleared, it is zero, source and all; F spread then is E^T F alone, inside the window. */
static PetscErrorCode CheckSpread(const char name[], TestWorld *t, Vec F, Forcing *f) {
  const Markers m = t->coupling->markers;
  PetscReal norm[2], outside, error;
  Vec exact;
  PetscFunctionBeginUser;
  PetscCall(ForcingClear(f));
  PetscCall(VecNorm(f->values, NORM_INFINITY, &norm[0]));
  PetscCall(VecNorm(f->source, NORM_INFINITY, &norm[1]));
  CHECK(norm[0] == 0 && norm[1] == 0 && f->mean[0] == 0 && !f->everywhere, "%s: cleared, it is zero", name);
  PetscCall(ForcingSpread(f, m, 2, F));
  PetscCall(Outside(f, &outside));
  CHECK(outside == 0 && !f->everywhere, "%s: nothing is spread outside the window", name);
  PetscCall(TestVecs(f->values, &exact, NULL));
  PetscCall(MatMultTranspose(m->E, F, exact));
  PetscCall(VecAXPY(exact, -0.5, f->values));
  PetscCall(VecNorm(exact, NORM_INFINITY, &error));
  PetscCall(VecNorm(f->values, NORM_INFINITY, &norm[0]));
  CHECK(error <= 1e-15 * norm[0] && norm[0] > 0, "%s: what is spread is all that is there, error %.1e", name, error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckCase(const char name[], const char options[]) {
  TestWorld t;
  Forcing f, copy = {0};
  Vec F, term;
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, &t));
  const Grid g = t.fluid->grid;
  PetscCall(ForcingCreate(g, PETSC_TRUE, &f));
  PetscCall(TestVecs(f.values, &term, NULL));
  PetscCall(TestVecs(t.X, &F, NULL));
  PetscCall(TestRandomVec(8, term));
  PetscCall(TestRandomVec(9, F));
  PetscCall(ForcingAdd(&f, term));
  CHECK(f.everywhere, "%s: a term may be anywhere", name);
  PetscCall(CheckSpread(name, &t, F, &f));
  for (int step = 0; step < 2; step++) {
    PetscCall(VecShift(t.X, 7.3 * g->h));
    PetscCall(CouplingPlaceMarkers(t.coupling, t.X));
    PetscCall(CheckSpread(name, &t, F, &f));
  }
  PetscCall(ForcingSpread(&f, t.coupling->markers, 1, F)); /* in two windows at once */
  PetscCall(VecShift(t.X, -7.3 * g->h));
  PetscCall(CouplingPlaceMarkers(t.coupling, t.X));
  PetscCall(ForcingSpread(&f, t.coupling->markers, 1, F));
  PetscCall(ForcingCopy(&f, &copy));
  PetscCall(CheckSpread(name, &t, F, &copy));
  PetscCall(CheckSpread(name, &t, F, &f));
  if (!g->wall[0] && !g->wall[1]) PetscCall(ForcingRemoveMean(&f, t.fluid));
  PetscCall(CheckSpread(name, &t, F, &f));
  PetscCall(ForcingDestroy(&f));
  PetscCall(ForcingDestroy(&copy));
  PetscCall(TestWorldDestroy(&t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  PetscFunctionBeginUser;
  PetscCall(CheckCase("walls", "-domain_cells 60,60 -vesicle_center -0.3,-0.3 -vesicle_semi_axes 0.2,0.1"));
  PetscCall(CheckCase("periodic", "-domain_cells 60,60 -domain_bc_x periodic -domain_bc_y periodic "
                                  "-vesicle_center 0.6,-0.9 -vesicle_semi_axes 0.2,0.1"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
