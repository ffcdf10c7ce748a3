/* A forcing knows where it is not zero: after a term that is everywhere, one in the markers' window, and one in the
   window of markers that have moved, each after a clear, nothing is left of what was there before. */
#include "facts.h"

/* The largest value outside the window. */
static PetscReal Outside(const Forcing *f) {
  const Grid g = f->grid;
  const PetscInt *rows = f->window.rows, *columns = f->window.columns;
  const PetscScalar *a = TestArray(f->values);
  PetscReal largest = 0;
  for (int c = 0; c < 2; c++)
    for (PetscInt k = 0; k < g->rows[c] * g->columns[c]; k++) {
      const PetscInt i = k % g->columns[c], j = k / g->columns[c];
      if (j < rows[0] || j >= rows[1] || i < columns[0] || i >= columns[1])
        TestWorse(&largest, a[GridRowStart(g, (Field)c, j) + i]);
    }
  return largest;
}

/* Cleared, it is zero, source and all; F spread then is E^T F alone, inside the window. */
static void CheckSpread(TestWorld *t, Vec F, Forcing *f) {
  const Markers m = t->coupling->markers;
  Vec exact;
  TestCall(ForcingClear(f));
  CHECK(TestNorm(NORM_INFINITY, f->values) == 0 && TestNorm(NORM_INFINITY, f->source) == 0 && f->mean[0] == 0 &&
            !f->everywhere,
        "cleared, it is zero");
  TestCall(ForcingSpread(f, m, 2, F));
  CHECK(Outside(f) == 0 && !f->everywhere, "nothing is spread outside the window");
  TestVecs(f->values, &exact, NULL);
  TestCall(MatMultTranspose(m->E, F, exact));
  TestCall(VecAXPY(exact, -0.5, f->values));
  const PetscReal norm = TestNorm(NORM_INFINITY, f->values);
  CheckBelow(TestNorm(NORM_INFINITY, exact) / norm, 1e-15, "what is spread is all that is there");
}

static void CheckCase(const char options[]) {
  ScopedWorld t;
  Forcing f, copy = {0};
  Vec F, term;
  TestAbout("%s", options);
  TestWorldCreate(&t, "-domain_cells 60,60 -vesicle_semi_axes 0.2,0.1 %s", options);
  const Grid g = t.fluid->grid;
  TestCall(ForcingCreate(g, PETSC_TRUE, &f));
  TestVecs(f.values, &term, NULL);
  TestVecs(t.X, &F, NULL);
  TestRandomVecs(8, term, F, NULL);
  TestCall(ForcingAdd(&f, term));
  CHECK(f.everywhere, "a term may be anywhere");
  CheckSpread(&t, F, &f);
  for (int step = 0; step < 2; step++) {
    TestCall(VecShift(t.X, 7.3 * g->h));
    TestCall(CouplingPlaceMarkers(t.coupling, t.X));
    CheckSpread(&t, F, &f);
  }
  TestCall(ForcingSpread(&f, t.coupling->markers, 1, F)); /* in two windows at once */
  TestCall(VecShift(t.X, -7.3 * g->h));
  TestCall(CouplingPlaceMarkers(t.coupling, t.X));
  TestCall(ForcingSpread(&f, t.coupling->markers, 1, F));
  TestCall(ForcingCopy(&f, &copy));
  CheckSpread(&t, F, &copy);
  CheckSpread(&t, F, &f);
  if (!g->wall[0] && !g->wall[1]) TestCall(ForcingRemoveMean(&f, t.fluid));
  CheckSpread(&t, F, &f);
  TestCall(ForcingDestroy(&f));
  TestCall(ForcingDestroy(&copy));
}

void Facts(void) {
  CheckCase("-vesicle_center -0.3,-0.3");
  CheckCase(PERIODIC "-vesicle_center 0.6,-0.9");
}
