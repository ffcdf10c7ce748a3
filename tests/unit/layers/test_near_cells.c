/* Fields next to a membrane: the lattice's pressure, and a circle under tension, inside of which nothing moves and the
   pressure is higher by tension over radius. */
#include "facts.h"
#include "base/lanes.h"
#include "layers/latticegreen.h"
#include "layers/layercells.h"
#include "layers/stencilsums.h"

#define RADIUS 0.5

/* Its Laplacian is the divergence of the force, and far away it is x/(2 pi r^2). */
static void CheckTable(const OffsetTable *t) {
  PetscReal worst = 0, far = 0;
  for (PetscInt j = -19; j <= 19; j++)
    for (PetscInt i = -19; i <= 19; i++) {
      const PetscReal laplacian = OffsetAt(t, OFFSET_UU, i + 1, j) + OffsetAt(t, OFFSET_UU, i - 1, j) +
                                  OffsetAt(t, OFFSET_UU, i, j + 1) + OffsetAt(t, OFFSET_UU, i, j - 1) -
                                  4 * OffsetAt(t, OFFSET_UU, i, j);
      const PetscReal divergence = j ? 0 : (i == 0) - (i == 1); /* the face lies between cells 0 and 1 */
      const PetscReal x = i - 0.5, r2 = x * x + j * j;
      TestWorse(&worst, laplacian - divergence);
      TestWorse(&worst, OffsetAt(t, OFFSET_VV, j, i) - OffsetAt(t, OFFSET_UU, i, j));
      if (r2 > 100) TestWorse(&far, (OffsetAt(t, OFFSET_UU, i, j) - x / (2 * PETSC_PI * r2)) * r2 * PetscSqrtReal(r2));
    }
  CheckBelow(worst, 1e-13, "the pressure's Laplacian is the force's divergence");
  CheckBelow(far, 0.1, "far away it is x/(2 pi r^2), times r^3");
}

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
static void JumpError(Grid g, const PetscReal center[2], const PetscReal p[], PetscReal *error) {
  PetscReal sum[2] = {0, 0}, X[2];
  *error = 0;
  for (int round = 0; round < 2; round++) {
    for (PetscInt k = 0; k < g->n[0] * g->rows[FIELD_P]; k++) {
      GridPosition(g, FIELD_P, k % g->n[0], k / g->n[0] + g->first, X);
      const PetscReal r = PetscSqrtReal(PetscSqr(X[0] - center[0]) + PetscSqr(X[1] - center[1]));
      if (round)
        *error = PetscMax(*error, PetscAbsReal(p[k] - sum[0] / sum[1] - (r < RADIUS ? 1 / RADIUS : 0)));
      else if (r > RADIUS + 0.3) {
        sum[0] += p[k];
        sum[1]++;
      }
    }
    TestSum(round ? 0 : 2, sum);
  }
  TestMost(1, error);
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
  PetscReal before, after, speed[2] = {0, 0};
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
  const PetscScalar *a = TestArray(p);
  JumpError(g, center, a, &before);
  TestCall(PetscArraycpy(cells[0], a, n));
  FaceMeans(g, u, cells[1]);
  speed[0] = TestFar(n, cells[1], NULL);
  TestCall(CouplingForces(w.coupling, (Instant){0}, sigma, w.X, F));
  TestCall(SingleCellsCorrect(&w.coupling->mobility->near->set, &w.coupling->mobility->near->lattice, w.layout, F, w.X,
                              (PetscReal *[]){cells[1], NULL, cells[0]}));
  JumpError(g, center, cells[0], &after);
  speed[1] = TestFar(n, cells[1], NULL);
  TestAbout("%s: circle under tension, a0 = %g", w.scene->coupling.kernel, a0);
  CHECK(before * RADIUS > 0.1, "the pressure is off by %.2g of the jump", before * RADIUS);
  CheckBelow(after * RADIUS, 0.01, "corrected");
  CheckBelow(speed[1], 3e-4, "where nothing moves: velocity %.1e of tension over viscosity, corrected", speed[0]);
}

#define CIRCLE                                                                                                         \
  EXACT PERIODIC "-scheme_type coupled -scheme_order 2 -domain_box -1.5,1.5,-1.5,1.5 "                                 \
                 "-vesicle_semi_axes .5,.5 -vesicle_center .013,-.021 -vesicle_bending 0 "

void Facts(void) {
  static const char *const kernels[] = {"cbs54", "ib6"};
  static const char *const grids[] = {"-domain_cells 32,32 -fluid_inertia none -vesicle_markers 35",
                                      "-domain_cells 64,64 -fluid_inertia none -vesicle_markers 45"};
  OffsetTable pressure;
  TestCall(LatticePressure(20, &pressure));
  CheckLogarithm();
  CheckTable(&pressure);
  TestCall(OffsetTableDestroy(&pressure));
  for (int k = 0; k < 4; k++) CheckCircle(TestText(CIRCLE "-delta_type %s %s", kernels[k / 2], grids[k % 2]), 0);
  CheckCircle(CIRCLE "-delta_type cbs54 -domain_cells 64,64 -fluid_inertia unsteady -vesicle_markers 45", 100);
}
