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
static PetscReal HelmholtzFieldError(Grid g, Field f, PetscReal a0, PetscReal nu, Vec w, Vec Hw) {
  const PetscInt n = g->columns[f] * g->rows[f];
  Mat A;
  Vec x, y, Ax;
  TestCall(GridAssemble(g, f, a0, nu, &A));
  TestFieldVecs(g->da[f], &x, &y, &Ax, NULL);
  for (int k = 0; k < 2; k++) {
    const PetscScalar *wa = TestArray(k ? Hw : w);
    PetscScalar *xa = TestArray(k ? y : x);
    TestCall(PetscArraycpy(xa, wa + GridRowStart(g, f, 0), n));
  }
  TestCall(MatMult(A, x, Ax));
  TestCall(MatDestroy(&A));
  return TestApart(NORM_2, Ax, y);
}

static void CheckFluid(const char name[], Fluid f) {
  const Grid g = f->grid;
  Vec w, Hw, p;
  Mat A;
  TestFieldVecs(g->velocity, &w, &Hw, NULL);
  TestFieldVecs(g->da[FIELD_P], &p, NULL);
  TestRandomVec(1, w);
  TestRandomVec(2, p);
  PetscReal error = TestTransposed(f->G, p, w);
  CHECK(error < TOLERANCE, "%s: G and G^T adjoint, error %.1e", name, error);
  error = TestTransposed(f->D, w, p);
  CHECK(error < TOLERANCE, "%s: D and D^T adjoint, error %.1e", name, error);
  TestCall(GridAssemble(g, FIELD_P, 0, -1, &A));
  error = Difference(f->L, A, p);
  CHECK(error < TOLERANCE, "%s: L = -G^T G is the assembled Laplacian, error %.1e", name, error);
  TestCall(MatDestroy(&A));
  TestCall(MatMult(f->H, w, Hw));
  for (int c = 0; c < 2; c++) {
    error = HelmholtzFieldError(g, (Field)c, f->a0, f->nu, w, Hw);
    CHECK(error < TOLERANCE, "%s: H is the assembled Helmholtz operator of %c, error %.1e", name, c ? 'v' : 'u', error);
  }
}

static void CheckCoupling(const char name[], TestWorld *t) {
  const Coupling c = t->coupling;
  Vec w, x, sigma;
  TestFieldVecs(t->fluid->grid->velocity, &w, NULL);
  TestMarkerVecs(t->layout, 2, &x, NULL);
  TestMarkerVecs(t->layout, 1, &sigma, NULL);
  TestRandomVec(3, w);
  TestRandomVec(4, x);
  TestRandomVec(5, sigma);
  const struct {
    const char *name;
    Mat A;
    Vec from, to;
  } pairs[] = {{"E", c->markers->E, w, x}, {"S", c->S, sigma, w}, {"B", c->B, x, w}};
  for (int k = 0; k < 3; k++) {
    const PetscReal error = TestTransposed(pairs[k].A, pairs[k].from, pairs[k].to);
    CHECK(error < TOLERANCE, "%s: %s and its transpose are adjoint, error %.1e", name, pairs[k].name, error);
  }
}

/* A constant velocity is interpolated as it is (the weights sum to 1), and a spread force keeps its sum: h^2 E^T F/h^2.
   Walls: w = 1 on the faces next to a marker is all that matters. */
static void CheckSums(const char name[], TestWorld *t) {
  Vec w, x;
  PetscReal error = 0;
  TestFieldVecs(t->fluid->grid->velocity, &w, NULL);
  TestMarkerVecs(t->layout, 2, &x, NULL);
  TestCall(VecSet(w, 1));
  TestCall(MarkersInterpolate(t->coupling->markers, w, x));
  const PetscScalar *a = TestArray(x);
  for (PetscInt k = 0; k < 2 * t->layout->n; k++) error = PetscMax(error, PetscAbsReal(a[k] - 1));
  CHECK(error < 1e-13, "%s: a constant velocity is interpolated exactly, error %.1e", name, error);
  TestRandomVec(6, x);
  const PetscReal want = TestTotal(x);
  TestCall(VecSet(w, 0));
  TestCall(MarkersSpread(t->coupling->markers, 2, x, w));
  error = PetscAbsReal(TestTotal(w) - 2 * want) / t->layout->M;
  CHECK(error < TOLERANCE, "%s: spreading keeps the sum of the force, error %.1e", name, error);
}

static void CheckCase(const char grid[], const char bc[], const char vesicle[], const char delta[]) {
  ScopedWorld t;
  const char *name = TestText("%s %s %s", strstr(grid, "-domain_cells") + 14, bc, delta);
  TestWorldCreate(&t, "%s %s %s -delta_type %s", grid, bc, vesicle, delta);
  CheckFluid(name, t.fluid);
  CheckCoupling(name, &t);
  CheckSums(name, &t);
}

void Facts(void) {
  static const char *const bc[] = {"-domain_bc_x wall -domain_bc_y wall", "-domain_bc_x periodic -domain_bc_y wall",
                                   "-domain_bc_x periodic -domain_bc_y periodic"};
  /* the vesicle is tall enough to cross every slab border of 8 ranks, and lies across a seam where there is one */
  static const char *const vesicle[] = {"-vesicle_center 0.1,0", "-vesicle_center 0.95,0.05",
                                        "-vesicle_center -0.97,0.93"};
  static const char *const grids[] = {"-domain_box -1,1,-1,1 -domain_cells 48,48",
                                      "-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47",
                                      "-domain_box -1,1,-1,0.95918367346938771 -domain_cells 49,48"};
  static const char *const kernels[] = {"ib6", "cbs54"};
  for (int b = 0; b < 3; b++)
    for (int g = 0; g < 3; g++) CheckCase(grids[g], bc[b], vesicle[b], kernels[(b + g) % 2]);
}
