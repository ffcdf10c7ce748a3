/* The near field next to walls: markers' velocity against a finer grid, mobility positive down to a quarter of a cell,
   the same at all four walls. */
#include "facts.h"
#include "numerics/blas.h"

#define H (8. / 48)
#define SCENE EXACT "-scheme_type coupled -delta_type cbs54 -fluid_viscosity 1 -domain_box -4,4,-4,4 "

/* An ellipse .8 x .4 with its flat side `gap` cells of the 48^2 grid from a wall; side: y_min, y_max, x_min, x_max. */
static void CreateAtWall(PetscInt cells, PetscInt markers, PetscReal gap, int side, const char more[], TestWorld *w) {
  const PetscReal from = (side % 2 ? -1 : 1) * (0.4 + gap * H - 4), across = side / 2 ? 0 : 0.03;
  TestWorldCreate(w,
                  SCENE "-domain_cells %d,%d -vesicle_markers %d -vesicle_center %.16g,%.16g "
                        "-vesicle_semi_axes %s %s",
                  (int)cells, (int)cells, (int)markers, (side / 2 ? from : across), (side / 2 ? 0.03 : from),
                  side / 2 ? "0.4,0.8" : "0.8,0.4", more);
}

/* The velocity, [2 markers] on every rank, of a smooth force in a channel of cells^2. */
static void SmoothVelocity(PetscInt cells, PetscInt markers, PetscReal gap, PetscReal U[]) {
  ScopedWorld t;
  Vec F, velocity;
  CreateAtWall(cells, markers, gap, 0, "-domain_bc_x periodic -fluid_inertia none", &t);
  TestVecs(t.X, &F, &velocity, NULL);
  PetscScalar *f = TestArray(F);
  for (PetscInt k = 0; k < t.layout->n; k++) {
    const PetscReal a = 2 * PETSC_PI * k / markers;
    f[2 * k] = (PetscCosReal(2 * a) + 0.3 * PetscSinReal(3 * a) - 0.4 * PetscSinReal(a)) / markers;
    f[2 * k + 1] = (0.7 * PetscSinReal(2 * a) + 0.5 * PetscCosReal(3 * a) + 0.2 * PetscCosReal(a)) / markers;
  }
  TestWorldRespond(&t, PETSC_TRUE, F, velocity);
  TestCall(LayoutGatherVec(t.layout, velocity, U));
}

/* 48^2 against 192^2, where every gap is four times as many cells: what is left is the grid's own error, of second
   order, and the closed form's from 14 cells on. */
static void CheckVelocity(void) {
  static const PetscReal gaps[] = {8, 4, 3, 2, 1, 0.5, 0.25};
  enum { M = 67 };
  PetscReal coarse[2 * M], fine[2 * M];
  for (int k = 0; k < 7; k++) {
    PetscReal error = 0;
    SmoothVelocity(48, M, gaps[k], coarse);
    SmoothVelocity(192, M, gaps[k], fine);
    for (int i = 0; i < 2 * M; i++) error += PetscSqr(coarse[i] - fine[i]);
    CheckBelow(PetscSqrtReal(error / TestProduct(2 * M, fine, fine)), 2e-4,
               "gap %g cells: velocity on a grid four times as fine", gaps[k]);
  }
}

/* The least eigenvalue of mobility + .05 times the projection on the normals. */
static PetscReal LeastEigenvalue(TestWorld *t, PetscReal Mob[]) {
  const PetscInt M = t->layout->M, N = 2 * M;
  const PetscReal *X = t->coupling->markers->X;
  PetscReal *normal = TestReals(N), *eigenvalue = TestReals(N);
  for (PetscInt k = 0; k < M; k++) {
    const PetscInt a = (k + 1) % M, b = (k + M - 1) % M;
    normal[2 * k] = X[2 * a + 1] - X[2 * b + 1];
    normal[2 * k + 1] = X[2 * b] - X[2 * a];
  }
  const PetscReal norm = TestProduct(N, normal, normal);
  for (PetscInt k = 0; k < N * N; k++) Mob[k] += 0.05 * normal[k % N] * normal[k / N] / norm;
  TestCall(DenseEigen(N, Mob, eigenvalue));
  return eigenvalue[0];
}

/* a0 h^2/nu, markers on the ellipse of 23 h, gap. The mobility, .3 at most, is symmetric, and positive but for the
   leak along the normals: what takes that off, .05 along them, leaves no other negative direction. */
static void CheckPositive(PetscReal coefficient, PetscInt markers, PetscReal gap) {
  const PetscInt N = 2 * markers;
  ScopedWorld t;
  Vec F, U;
  PetscReal *Mob = TestReals(N * N);
  const char *inertia = coefficient > 0 ? "unsteady" : "none";
  CreateAtWall(48, markers, gap, 1, TestText(CHANNEL "-fluid_inertia %s", inertia), &t);
  if (coefficient > 0) TestCall(FluidSetTimeCoefficient(t.fluid, coefficient / (H * H)));
  TestVecs(t.X, &F, &U, NULL);
  for (PetscInt j = 0; j < N; j++) {
    TestUnit(j, F);
    TestWorldRespond(&t, PETSC_TRUE, F, U);
    TestCall(LayoutGatherVec(t.layout, U, Mob + j * N));
  }
  TestAbout("a0 h^2/nu = %g, %d markers %g cells from a wall", coefficient, (int)markers, gap);
  CheckBelow(TestAsymmetry(N, Mob) / TestFar(N * N, Mob, NULL), 1e-12, "mobility is symmetric");
  CHECK(LeastEigenvalue(&t, Mob) > 0, "and positive");
}

/* (C F)_k of marker forces that turn and mirror with the wall: component d of all markers along (0) and away from it
 * (1). */
static void NearVelocity(int side, PetscReal shift, PetscReal U[][2]) {
  enum { M = 48 }; /* a multiple of 4: the markers turn and mirror into markers */
  ScopedWorld t;
  PetscReal all[2 * M];
  CreateAtWall(48, M, 0.5, side, "-fluid_inertia none", &t);
  const int normal = side / 2 ? 0 : 1, sign = side % 2 ? -1 : 1;
  PetscReal *F = TestReals(2 * t.layout->n), *V = TestReals(2 * t.layout->n);
  for (PetscInt k = 0; k < t.layout->n; k++) {
    const PetscReal *X = t.coupling->markers->X + 2 * (t.layout->first + k);
    const PetscReal x = X[1 - normal] - shift, y = sign * X[normal] + 4;
    F[2 * k + 1 - normal] = PetscSinReal(3 * x + y) + x;
    F[2 * k + normal] = sign * (PetscCosReal(2 * x - 5 * y) + x * y);
  }
  TestCall(NearFieldApply(t.coupling->mobility->near, 1, F, V));
  TestCall(LayoutGather(t.layout, 2, V, all));
  for (int k = 0; k < M; k++) {
    U[k][0] = all[2 * k + 1 - normal];
    U[k][1] = sign * all[2 * k + normal];
  }
}

/* Sums of squares do not depend on which marker is the first one. */
static void CheckSides(void) {
  PetscReal U[4][48][2], sum[4][2] = {{0}}, worst = 0;
  for (int side = 0; side < 4; side++) {
    NearVelocity(side, 0.03, U[side]);
    for (int k = 0; k < 48; k++)
      for (int d = 0; d < 2; d++) sum[side][d] += PetscSqr(U[side][k][d]);
    for (int d = 0; d < 2; d++) TestWorse(&worst, sum[side][d] / sum[0][d] - 1);
  }
  CHECK(worst < 1e-12 && sum[0][0] > 0 && sum[0][1] > 0, "the near field at four walls is one, apart by %.1e", worst);
}

void Facts(void) {
  static const PetscReal coefficients[] = {0, 0.1, 1, 10}, gaps[] = {3, 2, 0.5, 0.25};
  CheckSides();
  CheckVelocity();
  for (int a = 0; a < 4; a++)
    for (int k = 0; k < 4; k++) {
      CheckPositive(coefficients[a], 18, gaps[k]);
      if (a % 3 == 0) CheckPositive(coefficients[a], 45, gaps[k]);
    }
}
