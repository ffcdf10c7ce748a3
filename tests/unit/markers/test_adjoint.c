/* Operator pairs are exact transposes, on random data, for every boundary pair, with markers across periodic seams and
   slab borders; shells equal the assembled operators. */
#include "facts.h"

#define TOLERANCE 1e-13 /* relative: round-off of sums of some thousand terms */

/* |A x - B x| / |B x| on a vector of the shell's domain. */
static PetscReal Difference(Mat A, Mat B, Vec x) {
  Vec a, b;
  TestVecs(x, &a, &b, NULL);
  TestCall(MatMult(A, x, a));
  TestCall(MatMult(B, x, b));
  return TestApart(NORM_2, a, b);
}

/* One component's part of a velocity as a vector of its own DMDA, for the assembled operator. */
static PetscReal HelmholtzFieldError(Fluid fluid, Field f, Vec w, Vec Hw) {
  const Grid g = fluid->grid;
  Scoped(Mat) A;
  Vec x, y, Ax;
  TestCall(GridAssemble(g, f, fluid->a0, fluid->nu, &A));
  TestFieldVecs(g->da[f], &x, &y, &Ax, NULL);
  TestCall(PetscArraycpy(TestArray(x), TestArray(w) + GridRowStart(g, f, 0), g->columns[f] * g->rows[f]));
  TestCall(PetscArraycpy(TestArray(y), TestArray(Hw) + GridRowStart(g, f, 0), g->columns[f] * g->rows[f]));
  TestCall(MatMult(A, x, Ax));
  return TestApart(NORM_2, Ax, y);
}

static void CheckFluid(Fluid f) {
  const Grid g = f->grid;
  Vec w, Hw, p;
  Scoped(Mat) A;
  TestFieldVecs(g->velocity, &w, &Hw, NULL);
  TestFieldVecs(g->da[FIELD_P], &p, NULL);
  TestRandomVecs(1, w, p, NULL);
  CheckBelow(TestTransposed(f->G, p, w), TOLERANCE, "G and G^T adjoint");
  CheckBelow(TestTransposed(f->D, w, p), TOLERANCE, "D and D^T adjoint");
  TestCall(GridAssemble(g, FIELD_P, 0, -1, &A));
  CheckBelow(Difference(f->L, A, p), TOLERANCE, "L = -G^T G is the assembled Laplacian");
  TestCall(MatMult(f->H, w, Hw));
  for (int c = 0; c < 2; c++)
    CheckBelow(HelmholtzFieldError(f, (Field)c, w, Hw), TOLERANCE, "H is the assembled Helmholtz operator of %c",
               c ? 'v' : 'u');
}

/* A constant velocity is interpolated as it is (the weights sum to 1), and a spread force keeps its sum: h^2 E^T F/h^2.
   Walls: w = 1 on the faces next to a marker is all that matters. */
static void CheckCoupling(TestWorld *t) {
  const Coupling c = t->coupling;
  Vec w, x, sigma;
  TestFieldVecs(t->fluid->grid->velocity, &w, NULL);
  TestMarkerVecs(t->layout, 2, &x, NULL);
  TestMarkerVecs(t->layout, 1, &sigma, NULL);
  TestRandomVecs(3, w, x, sigma, NULL);
  CheckBelow(TestTransposed(c->markers->E, w, x), TOLERANCE, "E and its transpose are adjoint");
  CheckBelow(TestTransposed(c->S, sigma, w), TOLERANCE, "S and its transpose are adjoint");
  CheckBelow(TestTransposed(c->B, x, w), TOLERANCE, "B and its transpose are adjoint");
  const PetscReal want = TestTotal(x);
  TestCall(VecSet(w, 0));
  TestCall(MarkersSpread(c->markers, 2, x, w));
  CheckBelow((TestTotal(w) - 2 * want) / t->layout->M, TOLERANCE, "spreading keeps the sum of the force");
  TestCall(VecSet(w, 1));
  TestCall(MarkersInterpolate(c->markers, w, x));
  TestCall(VecShift(x, -1));
  CheckBelow(TestNorm(NORM_INFINITY, x), 1e-13, "a constant velocity is interpolated exactly");
}

void Facts(void) {
  /* the vesicle is tall enough to cross every slab border of 8 ranks, and lies across a seam where there is one */
  static const char *const boxes[] = {"-vesicle_center 0.1,0", CHANNEL "-vesicle_center 0.95,0.05",
                                      PERIODIC "-vesicle_center -0.97,0.93"};
  static const char *const grids[] = {SQUARE, OBLONG, "-domain_box -1,1,-1,0.95918367346938771 -domain_cells 49,48 "};
  for (int b = 0; b < 3; b++)
    for (int g = 0; g < 3; g++) {
      const char *options = TestText("%s%s -delta_type %s", grids[g], boxes[b], (b + g) % 2 ? "cbs54" : "ib6");
      ScopedWorld t;
      TestWorldCreate(&t, "%s", options);
      TestAbout("%s", options);
      CheckFluid(t.fluid);
      CheckCoupling(&t);
    }
}
