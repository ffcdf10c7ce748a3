/* A forcing knows where it is not zero: after a term that is everywhere, one in the markers' window, and one in the
   window of markers that have moved, each after a clear, nothing is left of what was there before. */
#include "facts.h"

static PetscBool Within(const PetscInt range[2], PetscInt k) {
  return k >= range[0] && k < range[1] ? PETSC_TRUE : PETSC_FALSE;
}

/* The largest value outside the window. */
static PetscReal Outside(const Forcing *f) {
  const Grid g = f->grid;
  PetscReal largest = 0;
  const PetscScalar *a = TestArray(f->values);
  for (int c = 0; c < 2; c++)
    for (PetscInt j = 0; j < g->rows[c]; j++)
      for (PetscInt i = 0; i < g->columns[c]; i++)
        if (!Within(f->window.rows, j) || !Within(f->window.columns, i))
          largest = PetscMax(largest, PetscAbsReal(a[GridRowStart(g, (Field)c, j) + i]));
  return largest;
}

/* Cleared, it is zero, source and all; F spread then is E^T F alone, inside the window. */
static void CheckSpread(const char name[], TestWorld *t, Vec F, Forcing *f) {
  const Markers m = t->coupling->markers;
  Vec exact;
  TestCall(ForcingClear(f));
  CHECK(TestNorm(NORM_INFINITY, f->values) == 0 && TestNorm(NORM_INFINITY, f->source) == 0 && f->mean[0] == 0 &&
            !f->everywhere,
        "%s: cleared, it is zero", name);
  TestCall(ForcingSpread(f, m, 2, F));
  CHECK(Outside(f) == 0 && !f->everywhere, "%s: nothing is spread outside the window", name);
  TestVecs(f->values, &exact, NULL);
  TestCall(MatMultTranspose(m->E, F, exact));
  TestCall(VecAXPY(exact, -0.5, f->values));
  const PetscReal error = TestNorm(NORM_INFINITY, exact), norm = TestNorm(NORM_INFINITY, f->values);
  CHECK(error <= 1e-15 * norm && norm > 0, "%s: what is spread is all that is there, error %.1e", name, error);
}

static void CheckCase(const char name[], const char options[]) {
  ScopedWorld t;
  Forcing f, copy = {0};
  Vec F, term;
  TestWorldCreate(&t, "%s", options);
  const Grid g = t.fluid->grid;
  TestCall(ForcingCreate(g, PETSC_TRUE, &f));
  TestVecs(f.values, &term, NULL);
  TestVecs(t.X, &F, NULL);
  TestRandomVec(8, term);
  TestRandomVec(9, F);
  TestCall(ForcingAdd(&f, term));
  CHECK(f.everywhere, "%s: a term may be anywhere", name);
  CheckSpread(name, &t, F, &f);
  for (int step = 0; step < 2; step++) {
    TestCall(VecShift(t.X, 7.3 * g->h));
    TestCall(CouplingPlaceMarkers(t.coupling, t.X));
    CheckSpread(name, &t, F, &f);
  }
  TestCall(ForcingSpread(&f, t.coupling->markers, 1, F)); /* in two windows at once */
  TestCall(VecShift(t.X, -7.3 * g->h));
  TestCall(CouplingPlaceMarkers(t.coupling, t.X));
  TestCall(ForcingSpread(&f, t.coupling->markers, 1, F));
  TestCall(ForcingCopy(&f, &copy));
  CheckSpread(name, &t, F, &copy);
  CheckSpread(name, &t, F, &f);
  if (!g->wall[0] && !g->wall[1]) TestCall(ForcingRemoveMean(&f, t.fluid));
  CheckSpread(name, &t, F, &f);
  TestCall(ForcingDestroy(&f));
  TestCall(ForcingDestroy(&copy));
}

void Facts(void) {
  CheckCase("walls", "-domain_cells 60,60 -vesicle_center -0.3,-0.3 -vesicle_semi_axes 0.2,0.1");
  CheckCase("periodic", "-domain_cells 60,60 -domain_bc_x periodic -domain_bc_y periodic "
                        "-vesicle_center 0.6,-0.9 -vesicle_semi_axes 0.2,0.1");
}
