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
static PetscErrorCode Fill(Grid g, Exact exact, PetscReal t, void *ctx, PetscBool pressure, Vec x) {
  const Filling q = {g, exact, t, ctx};
  PetscFunctionBeginUser;
  PetscCall(TestFill(g, pressure ? FIELD_P : FIELD_U, pressure ? FIELD_P : FIELD_V, FillingValue, &q, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* sqrt(h^2 SUM (x - y)^2), for pressures without their means. */
static PetscErrorCode Distance(Grid g, Vec x, Vec y, PetscBool pressure, PetscReal *distance) {
  Vec d;
  PetscFunctionBeginUser;
  PetscCall(TestVecs(x, &d, NULL));
  PetscCall(VecWAXPY(d, -1, x, y));
  if (pressure) PetscCall(TestRemoveMean(d));
  PetscCall(VecNorm(d, NORM_2, distance));
  *distance *= g->h;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First mode of a channel, and a Taylor-Green vortex in a periodic box: exactly divergence free on the grid too. */
static PetscReal ShearMode(Field f, const PetscReal X[2], PetscReal t, void *ctx) {
  return f == FIELD_U ? PetscSinReal(PETSC_PI * X[1]) : 0;
}
static PetscReal Vortex(Field f, const PetscReal X[2], PetscReal t, void *ctx) {
  const PetscReal x = 2 * PETSC_PI * X[0], y = 2 * PETSC_PI * X[1];
  return f == FIELD_U ? PetscCosReal(x) * PetscSinReal(y) : -PetscSinReal(x) * PetscCosReal(y);
}

static PetscErrorCode CheckDecay(const char name[], const char bc[], Exact exact, PetscReal wave, PetscInt directions) {
  const PetscInt steps = 8;
  const PetscReal dt = 0.03, nu = 0.4, h = 1.0 / 24;
  const PetscReal lambda = directions * 4 / (h * h) * PetscSqr(PetscSinReal(wave * h / 2));
  char options[512];
  TestWorld f;
  Vec want;
  PetscReal error, pressure;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(
      options, sizeof(options),
      "-domain_box 0,1,0,1 -domain_cells 24,24 %s -scheme_type split -vesicle_shape none -fluid_viscosity 0.4 "
      "-time_step 0.03",
      bc));
  PetscCall(TestRunCreate(options, &f));
  PetscCall(TestVecs(f.scheme->state.w, &want, NULL));
  PetscCall(Fill(f.fluid->grid, exact, 0, NULL, PETSC_FALSE, f.scheme->state.w));
  PetscCall(VecCopy(f.scheme->state.w, want));
  for (PetscInt k = 0; k < steps; k++) PetscCall(SchemeStep(f.scheme, PETSC_MAX_REAL));
  PetscCall(VecScale(want, PetscPowRealInt(1 + dt * nu * lambda, (int)-steps)));
  PetscCall(TestApart(NORM_2, want, f.scheme->state.w, &error));
  PetscCall(VecNorm(f.scheme->state.p, NORM_INFINITY, &pressure));
  CHECK(error < 1e-12, "%s decays as backward Euler says, error %.1e", name, error);
  CHECK(pressure < 1e-12, "%s makes no pressure, %.1e", name, pressure);
  CHECK(f.scheme->report.solves == 3, "%s: 3 scalar solves a step", name);
  PetscCall(TestWorldDestroy(&f));
  PetscFunctionReturn(PETSC_SUCCESS);
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

/* Run to t = 0.2 from the exact start; velocity and pressure at the end, the caller destroys them and the flow. */
static PetscErrorCode RunManufactured(PetscInt n, PetscInt steps, Manufactured *m, TestWorld *f, PetscReal *div) {
  char options[512];
  const PetscReal dt = 0.2 / steps;
  Grid g;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(
      options, sizeof(options),
      "-domain_box 0,1,0,0.75 -domain_cells %d,%d -domain_bc_x %s -domain_bc_y %s -scheme_type split -vesicle_shape "
      "none -fluid_viscosity %.17g -time_step %.17g",
      (int)n, (int)(3 * n / 4), m->wall[0] ? "wall" : "periodic", m->wall[1] ? "wall" : "periodic", (double)m->nu,
      (double)dt));
  PetscCall(TestRunCreate(options, f));
  g = f->fluid->grid;
  PetscCall(VecDuplicate(f->scheme->state.w, &f->fluid->bc1)); /* the fluid destroys it */
  m->forcing = PETSC_FALSE;
  PetscCall(Fill(g, ManufacturedField, 0, m, PETSC_FALSE, f->scheme->state.w));
  PetscCall(Fill(g, ManufacturedField, 0, m, PETSC_TRUE, f->scheme->state.p));
  m->forcing = PETSC_TRUE;
  *div = 0;
  for (PetscInt k = 1; k <= steps; k++) {
    PetscCall(Fill(g, ManufacturedField, k * dt, m, PETSC_FALSE, f->fluid->bc1));
    PetscCall(SchemeStep(f->scheme, PETSC_MAX_REAL));
    *div = PetscMax(*div, f->scheme->report.div_max);
  }
  m->forcing = PETSC_FALSE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* dt = 0.8 h^2, so that both errors fall with h^2. */
static PetscErrorCode CheckSpaceOrder(const char name[], Manufactured *m) {
  PetscReal error[3][2], div;
  PetscFunctionBeginUser;
  for (int level = 0; level < 3; level++) {
    const PetscInt n = 16 << level;
    TestWorld f;
    Vec w, p;
    PetscCall(RunManufactured(n, n * n / 4, m, &f, &div));
    PetscCall(TestVecs(f.scheme->state.w, &w, NULL));
    PetscCall(TestVecs(f.scheme->state.p, &p, NULL));
    PetscCall(Fill(f.fluid->grid, ManufacturedField, 0.2, m, PETSC_FALSE, w));
    PetscCall(Fill(f.fluid->grid, ManufacturedField, 0.2, m, PETSC_TRUE, p));
    PetscCall(Distance(f.fluid->grid, f.scheme->state.w, w, PETSC_FALSE, &error[level][0]));
    PetscCall(Distance(f.fluid->grid, f.scheme->state.p, p, PETSC_TRUE, &error[level][1]));
    CHECK(div < 1e-11, "%s, %d cells: max |div u| %.1e", name, (int)n, div);
    PetscCall(TestWorldDestroy(&f));
  }
  for (int level = 1; level < 3; level++)
    for (int k = 0; k < 2; k++) {
      const PetscReal order = PetscLog2Real(error[level - 1][k] / error[level][k]);
      CHECK(order > (k ? 1.5 : 1.8), "%s: %s of order %.2f in h, error %.2e", name, k ? "pressure" : "velocity", order,
            error[level][k]);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* On one grid, against a small step. */
static PetscErrorCode CheckTimeOrder(const char name[], Manufactured *m) {
  TestWorld fine;
  PetscReal last[2] = {0, 0}, div;
  PetscFunctionBeginUser;
  PetscCall(RunManufactured(32, 1280, m, &fine, &div));
  for (int level = 0; level < 3; level++) {
    const PetscInt steps = 20 << level;
    TestWorld f;
    PetscReal error[2];
    PetscCall(RunManufactured(32, steps, m, &f, &div));
    PetscCall(Distance(f.fluid->grid, f.scheme->state.w, fine.scheme->state.w, PETSC_FALSE, &error[0]));
    PetscCall(Distance(f.fluid->grid, f.scheme->state.p, fine.scheme->state.p, PETSC_TRUE, &error[1]));
    PetscCall(TestWorldDestroy(&f));
    for (int k = 0; k < 2; k++) {
      const PetscReal order = level ? PetscLog2Real(last[k] / error[k]) : 1;
      last[k] = error[k];
      CHECK(order > 0.9, "%s, %d steps: %s of order %.2f in dt, error %.2e", name, (int)steps,
            k ? "pressure" : "velocity", order, error[k]);
    }
  }
  PetscCall(TestWorldDestroy(&fine));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  Manufactured walls = {{PETSC_TRUE, PETSC_TRUE}, 0.3, PETSC_FALSE};
  Manufactured channel = {{PETSC_FALSE, PETSC_TRUE}, 0.3, PETSC_FALSE};
  PetscFunctionBeginUser;
  PetscCall(CheckDecay("shear mode in a channel", "-domain_bc_x periodic", ShearMode, PETSC_PI, 1));
  PetscCall(
      CheckDecay("vortex in a periodic box", "-domain_bc_x periodic -domain_bc_y periodic", Vortex, 2 * PETSC_PI, 2));
  PetscCall(CheckSpaceOrder("four walls", &walls));
  PetscCall(CheckSpaceOrder("channel along x", &channel));
  PetscCall(CheckTimeOrder("four walls", &walls));
  PetscCall(CheckTimeOrder("channel along x", &channel));
  PetscFunctionReturn(PETSC_SUCCESS);
}
