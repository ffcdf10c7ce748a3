/* Unsteady Stokes flow without a vesicle: the split step against exact solutions.

   - Decaying modes that are eigenvectors of the discrete operators: the step must follow backward Euler to round-off.
   - A manufactured flow with walls on all four sides or in a channel, both components and a pressure with slope at the
     walls, driven through Fluid->bc1, which the step adds to the momentum's right-hand side: second order in h, first
     in dt. */
#include "facts.h"

/* Value of one field at a point and a time. */
typedef PetscReal (*Exact)(Field field, const PetscReal X[2], PetscReal t, void *ctx);

typedef struct {
  Grid grid;
  Exact exact;
  PetscReal t;
  void *ctx;
} Filling;

static PetscReal FillingValue(const void *ctx, Field f, PetscInt i, PetscInt j) {
  const Filling *q = (const Filling *)ctx;
  PetscReal X[2];
  GridPosition(q->grid, f, i, j, X);
  return q->exact(f, X, q->t, q->ctx);
}

/* Fill a velocity (or a pressure) with an exact field. */
static void Fill(Grid g, Exact exact, PetscReal t, void *ctx, PetscBool pressure, Vec x) {
  const Filling q = {g, exact, t, ctx};
  TestFill(g, pressure ? FIELD_P : FIELD_U, pressure ? FIELD_P : FIELD_V, FillingValue, &q, x);
}

/* sqrt(h^2 SUM (x - y)^2), for pressures without their means. */
static PetscReal Distance(Grid g, Vec x, Vec y, PetscBool pressure) {
  Vec d;
  TestVecs(x, &d, NULL);
  TestCall(VecWAXPY(d, -1, x, y));
  if (pressure) TestRemoveMean(d);
  return TestNorm(NORM_2, d) * g->h;
}

/* First mode of a channel, and a Taylor-Green vortex in a periodic box: exactly divergence free on the grid too. */
static PetscReal ShearMode(Field f, const PetscReal X[2], PetscReal t, void *ctx) {
  return f == FIELD_U ? PetscSinReal(PETSC_PI * X[1]) : 0;
}
static PetscReal Vortex(Field f, const PetscReal X[2], PetscReal t, void *ctx) {
  const PetscReal x = 2 * PETSC_PI * X[0], y = 2 * PETSC_PI * X[1];
  return f == FIELD_U ? PetscCosReal(x) * PetscSinReal(y) : -PetscSinReal(x) * PetscCosReal(y);
}

static void CheckDecay(const char name[], const char bc[], Exact exact, PetscReal wave, PetscInt directions) {
  const PetscInt steps = 8;
  const PetscReal dt = 0.03, nu = 0.4, h = 1.0 / 24;
  const PetscReal lambda = directions * 4 / (h * h) * PetscSqr(PetscSinReal(wave * h / 2));
  ScopedWorld f;
  Vec want;
  TestRunCreate(
      &f,
      "-domain_box 0,1,0,1 -domain_cells 24,24 %s -scheme_type split -vesicle_shape none -fluid_viscosity 0.4 "
      "-time_step 0.03",
      bc);
  TestVecs(f.scheme->state.w, &want, NULL);
  Fill(f.fluid->grid, exact, 0, NULL, PETSC_FALSE, f.scheme->state.w);
  TestCall(VecCopy(f.scheme->state.w, want));
  for (PetscInt k = 0; k < steps; k++) TestCall(SchemeStep(f.scheme, PETSC_MAX_REAL));
  TestCall(VecScale(want, PetscPowRealInt(1 + dt * nu * lambda, (int)-steps)));
  const PetscReal error = TestApart(NORM_2, want, f.scheme->state.w);
  const PetscReal pressure = TestNorm(NORM_INFINITY, f.scheme->state.p);
  CHECK(error < 1e-12, "%s decays as backward Euler says, error %.1e", name, error);
  CHECK(pressure < 1e-12, "%s makes no pressure, %.1e", name, pressure);
  CHECK(f.scheme->report.solves == 3, "%s: 3 scalar solves a step", name);
}

/* The manufactured flow on [0, 1] x [0, 3/4]: stream function g(t) P(x) P(y), pressure q(t) Q(x) Q(y). */
typedef struct {
  PetscBool wall[2];
  PetscReal nu;
  PetscBool forcing; /* the forcing instead of the solution */
} Manufactured;

static const PetscReal extent[2] = {1, 0.75};

/* Derivative number k of the stream function's factor: (1 - cos)/2, flat at walls, or a cosine where periodic. */
static PetscReal P(const Manufactured *m, int dir, PetscReal x, int k) {
  const PetscReal wave = 2 * PETSC_PI / extent[dir], half = 0.5 * PETSC_PI;
  const PetscReal phase = wave * x + k * half, scale = PetscPowRealInt(wave, k);
  return m->wall[dir] ? 0.5 * (k == 0) - 0.5 * scale * PetscCosReal(phase) : scale * PetscCosReal(phase + 1);
}

/* The same for the pressure; its slope at walls is not zero. */
static PetscReal Q(const Manufactured *m, int dir, PetscReal x, int k) {
  const PetscReal wave = m->wall[dir] ? 1.3 : 2 * PETSC_PI / extent[dir];
  return PetscPowRealInt(wave, k) * PetscSinReal(wave * x + 0.4 + 0.5 * PETSC_PI * k);
}

static PetscReal ManufacturedField(Field f, const PetscReal X[2], PetscReal t, void *ctx) {
  const Manufactured *m = (const Manufactured *)ctx;
  const PetscReal g = 1 + PetscSinReal(5 * t), gt = 5 * PetscCosReal(5 * t), q = 1 + PetscCosReal(4 * t);
  const PetscReal x = X[0], y = X[1];
  if (f == FIELD_P) return q * Q(m, 0, x, 0) * Q(m, 1, y, 0);
  /* u = psi_y, v = -psi_x: a, b derivatives in x, y */
  const int a = f == FIELD_V, b = f == FIELD_U;
  const PetscReal sign = f == FIELD_U ? 1 : -1, u = sign * P(m, 0, x, a) * P(m, 1, y, b);
  const PetscReal laplacian = sign * (P(m, 0, x, a + 2) * P(m, 1, y, b) + P(m, 0, x, a) * P(m, 1, y, b + 2));
  if (!m->forcing) return g * u;
  return gt * u - m->nu * g * laplacian + q * Q(m, 0, x, f == FIELD_U) * Q(m, 1, y, f == FIELD_V);
}

/* Run to t = 0.2 from the exact start, which the caller destroys; the largest divergence. */
static PetscReal RunManufactured(PetscInt n, PetscInt steps, Manufactured *m, TestWorld *f) {
  const PetscReal dt = 0.2 / steps;
  PetscReal div = 0;
  TestRunCreate(
      f,
      "-domain_box 0,1,0,0.75 -domain_cells %d,%d -domain_bc_x %s -domain_bc_y %s -scheme_type split -vesicle_shape "
      "none -fluid_viscosity %.17g -time_step %.17g",
      (int)n, (int)(3 * n / 4), m->wall[0] ? "wall" : "periodic", m->wall[1] ? "wall" : "periodic", m->nu, dt);
  const Grid g = f->fluid->grid;
  TestCall(VecDuplicate(f->scheme->state.w, &f->fluid->bc1)); /* the fluid destroys it */
  m->forcing = PETSC_FALSE;
  Fill(g, ManufacturedField, 0, m, PETSC_FALSE, f->scheme->state.w);
  Fill(g, ManufacturedField, 0, m, PETSC_TRUE, f->scheme->state.p);
  m->forcing = PETSC_TRUE;
  for (PetscInt k = 1; k <= steps; k++) {
    Fill(g, ManufacturedField, k * dt, m, PETSC_FALSE, f->fluid->bc1);
    TestCall(SchemeStep(f->scheme, PETSC_MAX_REAL));
    div = PetscMax(div, f->scheme->report.div_max);
  }
  m->forcing = PETSC_FALSE;
  return div;
}

/* dt = 0.8 h^2, so that both errors fall with h^2. */
static void CheckSpaceOrder(const char name[], Manufactured *m) {
  PetscReal error[3][2];
  for (int level = 0; level < 3; level++) {
    const PetscInt n = 16 << level;
    ScopedWorld f;
    Vec w, p;
    const PetscReal div = RunManufactured(n, n * n / 4, m, &f);
    TestVecs(f.scheme->state.w, &w, NULL);
    TestVecs(f.scheme->state.p, &p, NULL);
    Fill(f.fluid->grid, ManufacturedField, 0.2, m, PETSC_FALSE, w);
    Fill(f.fluid->grid, ManufacturedField, 0.2, m, PETSC_TRUE, p);
    error[level][0] = Distance(f.fluid->grid, f.scheme->state.w, w, PETSC_FALSE);
    error[level][1] = Distance(f.fluid->grid, f.scheme->state.p, p, PETSC_TRUE);
    CHECK(div < 1e-11, "%s, %d cells: max |div u| %.1e", name, (int)n, div);
  }
  for (int level = 1; level < 3; level++)
    for (int k = 0; k < 2; k++) {
      const PetscReal order = PetscLog2Real(error[level - 1][k] / error[level][k]);
      CHECK(order > (k ? 1.5 : 1.8), "%s: %s of order %.2f in h, error %.2e", name, k ? "pressure" : "velocity", order,
            error[level][k]);
    }
}

/* On one grid, against a small step. */
static void CheckTimeOrder(const char name[], Manufactured *m) {
  ScopedWorld fine;
  PetscReal last[2] = {0, 0};
  (void)RunManufactured(32, 1280, m, &fine);
  for (int level = 0; level < 3; level++) {
    const PetscInt steps = 20 << level;
    ScopedWorld f;
    (void)RunManufactured(32, steps, m, &f);
    const PetscReal error[2] = {Distance(f.fluid->grid, f.scheme->state.w, fine.scheme->state.w, PETSC_FALSE),
                                Distance(f.fluid->grid, f.scheme->state.p, fine.scheme->state.p, PETSC_TRUE)};
    for (int k = 0; k < 2; k++) {
      const PetscReal order = level ? PetscLog2Real(last[k] / error[k]) : 1;
      last[k] = error[k];
      CHECK(order > 0.9, "%s, %d steps: %s of order %.2f in dt, error %.2e", name, (int)steps,
            k ? "pressure" : "velocity", order, error[k]);
    }
  }
}

void Facts(void) {
  Manufactured walls = {{PETSC_TRUE, PETSC_TRUE}, 0.3, PETSC_FALSE};
  Manufactured channel = {{PETSC_FALSE, PETSC_TRUE}, 0.3, PETSC_FALSE};
  CheckDecay("shear mode in a channel", "-domain_bc_x periodic", ShearMode, PETSC_PI, 1);
  CheckDecay("vortex in a periodic box", "-domain_bc_x periodic -domain_bc_y periodic", Vortex, 2 * PETSC_PI, 2);
  CheckSpaceOrder("four walls", &walls);
  CheckSpaceOrder("channel along x", &channel);
  CheckTimeOrder("four walls", &walls);
  CheckTimeOrder("channel along x", &channel);
}
