/* Fields next to a membrane: a circle under tension, inside of which nothing moves and the pressure is higher by
   tension over radius; and the logarithms that they take. */
#include "facts.h"
#include "base/lanes.h"
#include "layers/layercells.h"

#define RADIUS 0.5

/* Against the library's, over many powers of two and next to 1. */
static void CheckLogarithm(void) {
  PetscReal worst = 0;
  for (int k = 0; k < 4000; k++) {
    const PetscReal wide = PetscPowReal(10, -300 + 0.1503 * k), x = k % 2 ? wide : 1 + (k - 2000) * 1e-4;
    const PetscReal exact = PetscLogReal(x);
    TestWorse(&worst, (LanesLog((Lanes){x, 1, x, x})[2] - exact) / PetscMax(PetscAbsReal(exact), 1e-3));
  }
  CheckBelow(worst, 1e-15, "logarithms of four numbers at once, of themselves");
}

/* Largest difference of the pressure from 1/RADIUS inside and from zero outside, its mean outside taken off. */
static PetscReal JumpError(Grid g, const PetscReal center[2], const PetscReal p[]) {
  PetscReal sum[2] = {0, 0}, error = 0, X[2];
  for (int round = 0; round < 2; round++) {
    for (PetscInt k = 0; k < g->n[0] * g->rows[FIELD_P]; k++) {
      GridPosition(g, FIELD_P, k % g->n[0], k / g->n[0] + g->first, X);
      const PetscReal r = PetscHypotReal(X[0] - center[0], X[1] - center[1]);
      if (round)
        TestWorse(&error, p[k] - sum[0] / sum[1] - (r < RADIUS ? 1 / RADIUS : 0));
      else if (r > RADIUS + 0.3) {
        sum[0] += p[k];
        sum[1]++;
      }
    }
    TestSum(round ? 0 : 2, sum);
  }
  TestMost(1, &error);
  return error;
}

/* u at cell centres of a periodic grid. */
static void FaceMeans(Grid g, Vec w, PetscReal u[]) {
  const PetscScalar *a = TestArray(w);
  for (PetscInt k = 0; k < g->n[0] * g->rows[FIELD_P]; k++)
    u[k] = 0.5 * (a[k] + a[k % g->n[0] ? k - 1 : k - 1 + g->n[0]]);
}

/* The circle with tension 1, at the time coefficient a0 (0: any, quasi-steady). */
static void CheckCircle(const char options[], PetscReal a0) {
  const PetscReal center[2] = {0.013, -0.021};
  ScopedWorld w;
  Vec f, u, p, sigma, F;
  TestWorldCreate(&w, "%s", options);
  if (a0 > 0) TestWorldPlace(a0, &w);
  const Grid g = w.fluid->grid;
  const PetscInt n = g->n[0] * g->rows[FIELD_P];
  PetscReal *cells[2] = {TestReals(n), TestReals(n)};
  TestFieldVecs(g->velocity, &f, &u, NULL);
  TestFieldVecs(g->da[FIELD_P], &p, NULL);
  TestMarkerVecs(w.layout, 1, &sigma, NULL);
  TestVecs(w.X, &F, NULL);
  TestCall(VecSet(sigma, 1));
  TestCall(CouplingSpreadTension(w.coupling, -1, sigma, f));
  TestCall(StokesSolve(TestWorldStokes(&w), f, NULL, u, p));
  TestCall(PetscArraycpy(cells[0], TestArray(p), n));
  FaceMeans(g, u, cells[1]);
  const PetscReal before = JumpError(g, center, cells[0]), speed = TestFar(n, cells[1], NULL);
  TestCall(CouplingForces(w.coupling, (Instant){0}, sigma, w.X, F));
  TestCall(SingleCellsCorrect(&w.coupling->mobility->near->set, &w.coupling->mobility->near->lattice, w.layout, F, w.X,
                              (PetscReal *[]){cells[1], NULL, cells[0]}));
  const PetscReal after = JumpError(g, center, cells[0]);
  TestAbout("%s: circle under tension, a0 = %g", w.scene->coupling.kernel, a0);
  CHECK(before * RADIUS > 0.1, "the pressure is off by %.2g of the jump", before * RADIUS);
  CheckBelow(after * RADIUS, 0.01, "corrected");
  CheckBelow(TestFar(n, cells[1], NULL), 3e-4, "velocity, %.1e of tension over viscosity, corrected", speed);
}

#define CIRCLE                                                                                                         \
  EXACT PERIODIC "-scheme_type coupled -scheme_order 2 -domain_box -1.5,1.5,-1.5,1.5 "                                 \
                 "-vesicle_semi_axes .5,.5 -vesicle_center .013,-.021 -vesicle_bending 0 "

void Facts(void) {
  static const char *const kernels[] = {"cbs54", "ib6"};
  static const char *const grids[] = {"-domain_cells 32,32 -fluid_inertia none -vesicle_markers 35",
                                      "-domain_cells 64,64 -fluid_inertia none -vesicle_markers 45"};
  CheckLogarithm();
  for (int k = 0; k < 4; k++) CheckCircle(TestText(CIRCLE "-delta_type %s %s", kernels[k / 2], grids[k % 2]), 0);
  CheckCircle(CIRCLE "-delta_type cbs54 -domain_cells 64,64 -fluid_inertia unsteady -vesicle_markers 45", 100);
}
