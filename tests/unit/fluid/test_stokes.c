/* Unsteady Stokes flow without a vesicle: the split step against exact solutions.

   - Decaying modes that are eigenvectors of the discrete operators: the step must follow backward Euler to round-off.
   - A manufactured flow with walls on all four sides or in a channel, both components and a pressure with slope at the
     walls, driven through Fluid->bc1, which the step adds to the momentum's right-hand side: second order in h, first
     in dt. */
#include "facts.h"

typedef PetscReal Exact(Field field, const PetscReal X[2], PetscReal t, const void *ctx);

typedef struct {
  Exact *exact;
  PetscReal t;
  const void *ctx;
} Filling;

static PetscReal FillingValue(const void *ctx, Field f, const PetscReal X[2]) {
  const Filling *q = (const Filling *)ctx;
  return q->exact(f, X, q->t, q->ctx);
}

/* Fill a velocity, and a pressure where it is given, with an exact field. */
static void Fill(Grid g, Exact *exact, PetscReal t, const void *ctx, Vec w, Vec p) {
  const Filling q = {exact, t, ctx};
  TestFill(g, FIELD_U, FIELD_V, FillingValue, &q, w);
  if (p) TestFill(g, FIELD_P, FIELD_P, FillingValue, &q, p);
}

/* sqrt(h^2 SUM (x - y)^2) of velocities, and of pressures without their means; x and p are overwritten. */
static void Distances(Grid g, Vec x, Vec p, const State *y, PetscReal off[2]) {
  TestCall(VecAXPY(x, -1, y->w));
  TestCall(VecAXPY(p, -1, y->p));
  TestRemoveMean(p);
  off[0] = TestNorm(NORM_2, x) * g->h;
  off[1] = TestNorm(NORM_2, p) * g->h;
}

/* First mode of a channel, and a Taylor-Green vortex in a periodic box: exactly divergence free on the grid too. */
static PetscReal ShearMode(Field f, const PetscReal X[2], PetscReal t, const void *ctx) {
  return f == FIELD_U ? PetscSinReal(PETSC_PI * X[1]) : 0;
}
static PetscReal Vortex(Field f, const PetscReal X[2], PetscReal t, const void *ctx) {
  const PetscReal x = 2 * PETSC_PI * X[0], y = 2 * PETSC_PI * X[1];
  return f == FIELD_U ? PetscCosReal(x) * PetscSinReal(y) : -PetscSinReal(x) * PetscCosReal(y);
}

#define SPLIT "-scheme_type split -vesicle_shape none "

static void CheckDecay(const char name[], const char bc[], Exact *exact, PetscReal wave, PetscInt directions) {
  const PetscReal dt = 0.03, nu = 0.4, h = 1.0 / 24;
  const PetscReal lambda = directions * 4 / (h * h) * PetscSqr(PetscSinReal(wave * h / 2));
  ScopedWorld f;
  Vec want;
  TestRunCreate(&f, SPLIT "-domain_box 0,1,0,1 -domain_cells 24,24 -fluid_viscosity 0.4 -time_step 0.03 %s", bc);
  TestVecs(f.scheme->state.w, &want, NULL);
  Fill(f.fluid->grid, exact, 0, NULL, f.scheme->state.w, NULL);
  TestCall(VecCopy(f.scheme->state.w, want));
  for (PetscInt k = 0; k < 8; k++) TestCall(SchemeStep(f.scheme, PETSC_MAX_REAL));
  TestCall(VecScale(want, PetscPowRealInt(1 + dt * nu * lambda, -8)));
  TestAbout("%s", name);
  CheckBelow(TestApart(NORM_2, want, f.scheme->state.w), 1e-12, "it decays as backward Euler says");
  CheckBelow(TestNorm(NORM_INFINITY, f.scheme->state.p), 1e-12, "it makes no pressure");
  CHECK(f.scheme->report.solves == 3, "3 scalar solves a step");
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

static PetscReal ManufacturedField(Field f, const PetscReal X[2], PetscReal t, const void *ctx) {
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
static PetscReal RunManufactured(PetscInt n, PetscInt steps, const Manufactured *m, TestWorld *f) {
  const PetscReal dt = 0.2 / steps;
  const Manufactured forcing = {{m->wall[0], m->wall[1]}, m->nu, PETSC_TRUE};
  PetscReal div = 0;
  TestRunCreate(f,
                SPLIT "-domain_box 0,1,0,0.75 -domain_cells %d,%d -domain_bc_x %s -fluid_viscosity %.17g "
                      "-time_step %.17g",
                (int)n, (int)(3 * n / 4), m->wall[0] ? "wall" : "periodic", m->nu, dt);
  const Grid g = f->fluid->grid;
  TestCall(VecDuplicate(f->scheme->state.w, &f->fluid->bc1)); /* the fluid destroys it */
  Fill(g, ManufacturedField, 0, m, f->scheme->state.w, f->scheme->state.p);
  for (PetscInt k = 1; k <= steps; k++) {
    Fill(g, ManufacturedField, k * dt, &forcing, f->fluid->bc1, NULL);
    TestCall(SchemeStep(f->scheme, PETSC_MAX_REAL));
    TestWorse(&div, f->scheme->report.div_max);
  }
  return div;
}

/* In space dt = 0.8 h^2, so that both errors fall with h^2; in time on one grid, against a small step. */
static void CheckOrders(const char name[], const Manufactured *m) {
  static const char *const what[] = {"velocity", "pressure"};
  PetscReal space[3][2], time[3][2];
  ScopedWorld fine;
  TestAbout("%s", name);
  (void)RunManufactured(32, 1280, m, &fine);
  for (int level = 0; level < 3; level++) {
    const PetscInt n = 16 << level;
    ScopedWorld f, g;
    Vec w, p;
    CheckBelow(RunManufactured(n, n * n / 4, m, &f), 1e-11, "%d cells: max |div u|", (int)n);
    TestVecs(f.scheme->state.w, &w, NULL);
    TestVecs(f.scheme->state.p, &p, NULL);
    Fill(f.fluid->grid, ManufacturedField, 0.2, m, w, p);
    Distances(f.fluid->grid, w, p, &f.scheme->state, space[level]);
    (void)RunManufactured(32, 20 << level, m, &g);
    Distances(g.fluid->grid, g.scheme->state.w, g.scheme->state.p, &fine.scheme->state, time[level]);
  }
  for (int level = 1; level < 3; level++)
    for (int k = 0; k < 2; k++) {
      const PetscReal in_h = PetscLog2Real(space[level - 1][k] / space[level][k]);
      const PetscReal in_dt = PetscLog2Real(time[level - 1][k] / time[level][k]);
      CHECK(in_h > (k ? 1.5 : 1.8), "%s of order %.2f in h, error %.2e", what[k], in_h, space[level][k]);
      CHECK(in_dt > 0.9, "%s of order %.2f in dt, error %.2e", what[k], in_dt, time[level][k]);
    }
}

void Facts(void) {
  CheckDecay("shear mode in a channel", CHANNEL, ShearMode, PETSC_PI, 1);
  CheckDecay("vortex in a periodic box", PERIODIC, Vortex, 2 * PETSC_PI, 2);
  CheckOrders("four walls", &(Manufactured){{PETSC_TRUE, PETSC_TRUE}, 0.3, PETSC_FALSE});
  CheckOrders("channel along x", &(Manufactured){{PETSC_FALSE, PETSC_TRUE}, 0.3, PETSC_FALSE});
}
