/* Convection: its discrete form keeps energy and momentum and is of second order; Navier-Stokes flow against a vortex
   carried by a stream, and against manufactured solutions. The split step's unsteady Stokes flow against exact ones. */
#include "facts.h"
#include "krylov/solver.h"
#include "fluid/stokes/convection.h"
#include "fluid/stokes/stokes.h"
#include <dlfcn.h>

TestScoped(Convection, ConvectionDestroy);

#define NU 0.05

typedef void Exact(const PetscReal at[3], PetscReal value[3]); /* u', v', p at x, y, t */

static PetscReal height = 2; /* of the box [-1, 1] x [-1, height - 1] */

/* u' of a stream function psi = amplitude P(x) Q(y) that is odd about walls after one derivative; a pressure with slope
   at walls in y. */
static void Flow2(const PetscReal at[3], PetscReal amplitude, const PetscReal P[2], const PetscReal Q[2],
                  PetscReal value[3]) {
  const PetscReal now = amplitude * (1 + 0.5 * PetscSinReal(2 * at[2]));
  value[0] = now * P[0] * Q[1];
  value[1] = -now * P[1] * Q[0];
  value[2] = (1 + PetscCosReal(4 * at[2])) * PetscSinReal(1.3 * at[1] + 0.4);
}

/* A function that is flat at walls x = -1 and length - 1, and its derivative. */
static void Flat(PetscReal x, PetscReal length, PetscReal F[2]) {
  F[0] = PetscSqr(PetscSinReal(PETSC_PI * (x + 1) / length));
  F[1] = PETSC_PI / length * PetscSinReal(2 * PETSC_PI * (x + 1) / length);
}

static void InChannel(const PetscReal at[3], PetscReal value[3]) {
  const PetscReal phase = PETSC_PI * at[0] - at[2], P[2] = {PetscSinReal(phase), PETSC_PI * PetscCosReal(phase)};
  PetscReal Q[2];
  Flat(at[1], height, Q);
  Flow2(at, 0.3, P, Q, value);
  value[2] *= PetscCosReal(PETSC_PI * at[0]);
}

static void InBox(const PetscReal at[3], PetscReal value[3]) {
  PetscReal P[2], Q[2];
  Flat(at[0], 2, P);
  Flat(at[1], height, Q);
  Flow2(at, 0.4, P, Q, value);
  value[2] *= PetscSinReal(1.3 * at[0] + 0.4);
}

/* First mode of a channel, and a Taylor-Green vortex in a periodic box: exactly divergence free on the grid too. */
static void ShearMode(const PetscReal at[3], PetscReal value[3]) {
  value[0] = PetscSinReal(PETSC_PI * at[1]);
  value[1] = 0;
}

static void Vortex(const PetscReal at[3], PetscReal value[3]) {
  const PetscReal x = 2 * PETSC_PI * at[0], y = 2 * PETSC_PI * at[1];
  value[0] = PetscCosReal(x) * PetscSinReal(y);
  value[1] = -PetscSinReal(x) * PetscCosReal(y);
}

/* Vortices of wave number pi, carried by a stream (1, 0) and decaying: an exact solution of Navier-Stokes. */
static void Carried(const PetscReal at[3], PetscReal value[3]) {
  const PetscReal a = PETSC_PI * (at[0] - at[2]), b = PETSC_PI * at[1];
  const PetscReal decay = PetscExpReal(-2 * NU * PETSC_PI * PETSC_PI * at[2]);
  value[0] = decay * PetscSinReal(a) * PetscCosReal(b);
  value[1] = -decay * PetscCosReal(a) * PetscSinReal(b);
  value[2] = decay * decay * (PetscCosReal(2 * a) + PetscCosReal(2 * b)) / 4;
}

/* Derivative number 1 or 2 of component c along axis 0 x, 1 y, 2 t; by differences of fourth order. */
static PetscReal Derivative(Exact *f, int c, int axis, int number, const PetscReal at[3]) {
  static const PetscReal weight[2][5] = {{1. / 12, -2. / 3, 0, 2. / 3, -1. / 12},
                                         {-1. / 12, 4. / 3, -5. / 2, 4. / 3, -1. / 12}};
  const PetscReal step = 1e-3 * number;
  PetscReal sum = 0, value[3];
  for (int k = 0; k < 5; k++) {
    PetscReal q[3] = {at[0], at[1], at[2]};
    if (weight[number - 1][k] == 0) continue;
    q[axis] += (k - 2) * step;
    f(q, value);
    sum += weight[number - 1][k] * value[c];
  }
  return sum / PetscPowRealInt(step, number);
}

/* The exact flow's values, its convection N, or the force that upholds it, with N where there is convection. */
typedef enum { VALUE, CONVECTION, FORCE } What;

typedef struct {
  Scene scene;
  Exact *flow;
  PetscReal t;
  What what;
} Sampling;

static PetscReal SamplingValue(const void *ctx, Field c, const PetscReal X[2]) {
  const Sampling *s = (const Sampling *)ctx;
  const PetscReal at[3] = {X[0], X[1], s->t};
  PetscReal value[3], background[2], gradient[2][2], sum = 0;
  s->flow(at, value);
  if (s->what == VALUE) return value[c];
  FlowVelocity(&s->scene->flow, 0, at[0], at[1], background);
  FlowGradient(&s->scene->flow, at[1], gradient);
  for (int b = 0; b < 2 && s->scene->fluid.inertia == INERTIA_CONVECTIVE; b++)
    sum += (value[b] + background[b]) * Derivative(s->flow, c, b, 1, at) + value[b] * gradient[c][b];
  if (s->what == CONVECTION) return sum;
  for (int b = 0; b < 2; b++) sum -= s->scene->fluid.nu * Derivative(s->flow, c, b, 2, at);
  return sum + Derivative(s->flow, c, 2, 1, at) + Derivative(s->flow, 2, c, 1, at);
}

static void Sample(const TestWorld *r, Exact *flow, PetscReal t, What what, Vec w) {
  TestFill(r->fluid->grid, FIELD_U, FIELD_V, SamplingValue, &(Sampling){r->scene, flow, t, what}, w);
}

/* A scheme without vesicles, of n cells across, options after the common ones. */
static void RunCreate(const char options[], PetscInt n, PetscReal dt, TestWorld *r) {
  TestRunCreate(r,
                "-vesicle_shape none -scheme_startup euler -coupled_ksp_rtol 1e-11 -fluid_viscosity %.17g "
                "-fluid_inertia convective -domain_cells %" PetscInt_FMT ",%" PetscInt_FMT " -time_step %.17g %s",
                NU, n, n, dt, options);
}

static Vec body_force; /* in every solve's momentum; NULL: none */

/* In the place of the library's, which it calls: the dynamic linker finds this one first. */
PetscErrorCode MobilityFields(Mobility m, const Forcing *f, Vec u, Vec p) {
  PetscErrorCode (*solve)(Mobility, const Forcing *, Vec, Vec);
  PetscFunctionBeginUser;
  *(void **)&solve = dlsym(RTLD_NEXT, "MobilityFields");
  if (body_force) PetscCall(VecAXPY(f->values, 1, body_force));
  PetscCall(solve(m, f, u, p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Steps from the exact start to time 0.4, with the force that upholds f where it is forced; the largest divergence. */
static PetscReal Run(const char options[], Exact *f, PetscBool forced, PetscInt n, PetscInt steps, TestWorld *r) {
  const PetscReal dt = 0.4 / steps;
  PetscReal div = 0;
  RunCreate(options, n, dt, r);
  const State *state = &r->scheme->state;
  Vec *force = SceneIsProjection(r->scene) ? &r->fluid->bc1 : &body_force; /* the fluid destroys bc1 */
  Sample(r, f, 0, VALUE, state->w);
  TestFill(r->fluid->grid, FIELD_P, FIELD_P, SamplingValue, &(Sampling){r->scene, f, 0, VALUE}, state->p);
  if (forced) TestCall(VecDuplicate(state->w, force));
  for (PetscInt k = 1; k <= steps; k++) {
    if (forced) Sample(r, f, k * dt, FORCE, *force);
    TestCall(SchemeStep(r->scheme, PETSC_MAX_REAL));
    PetscCheckAbort(!*r->scheme->report.failure, PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", r->scheme->report.failure);
    TestWorse(&div, r->scheme->report.div_max);
  }
  TestCall(VecDestroy(&body_force));
  return div;
}

/* Root mean square errors of velocity and pressure, the pressure's without its mean, beside f, or another run. */
static void Errors(const TestWorld *r, Exact *f, const TestWorld *other, PetscReal error[2]) {
  const Grid g = r->fluid->grid;
  const PetscReal scale = g->h / PetscSqrtReal(2 * height);
  Vec w, p;
  TestVecs(r->scheme->state.w, &w, NULL);
  TestVecs(r->scheme->state.p, &p, NULL);
  Sample(r, f, 0.4, VALUE, w);
  TestFill(g, FIELD_P, FIELD_P, SamplingValue, &(Sampling){r->scene, f, 0.4, VALUE}, p);
  if (other) TestCall(VecCopy(other->scheme->state.w, w));
  if (other) TestCall(VecCopy(other->scheme->state.p, p));
  TestCall(VecAXPY(w, -1, r->scheme->state.w));
  TestCall(VecAXPY(p, -1, r->scheme->state.p));
  TestRemoveMean(p);
  error[0] = TestNorm(NORM_2, w) * scale;
  error[1] = TestNorm(NORM_2, p) * scale;
}

/* Of the velocity beside f. */
static PetscReal Error(const char options[], Exact *f, PetscBool forced, PetscInt n, PetscInt steps) {
  ScopedWorld r;
  PetscReal error[2];
  (void)Run(options, f, forced, n, steps, &r);
  Errors(&r, f, NULL, error);
  return error[0];
}

#define SPLIT "-scheme_type split -fluid_inertia unsteady "
#define STREAM "-flow_type poiseuille -flow_half_width 1e7 "
#define POISEUILLE CHANNEL "-flow_type poiseuille -flow_half_width 1 "

/* u.N(u) = 0 to rounding for any velocity, divergence or not, on any carrying stream that walls do not cut; and for a
   divergence-free one in a periodic box N adds up to zero. */
static void CheckConservation(const char name[], const char options[]) {
  ScopedWorld r;
  Scoped(Convection) c;
  Vec w, N;
  PetscReal size = 0;
  TestAbout("%s", name);
  RunCreate(options, 24, 1e-6, &r);
  TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
  TestVecs(r.scheme->state.w, &w, &N, NULL);
  TestRandomVec(3, w);
  for (int free = 0; free < 2; free++) {
    if (free) TestCall(StokesSolve(TestWorldStokes(&r), w, NULL, w, r.scheme->state.p));
    TestCall(VecSet(N, 0));
    TestCall(ConvectionAdd(c, 1, w, &(Forcing){.values = N}));
    size = TestNorm(NORM_2, N);
    CHECK(size > 0, "there is convection");
    CheckBelow(TestDot(w, N) / (TestNorm(NORM_2, w) * size), 1e-12, "%s velocity: convection keeps the energy, u.N",
               free ? "divergence-free" : "random");
  }
  if (!r.fluid->grid->wall[0] && !r.fluid->grid->wall[1])
    CheckBelow(TestTotal(N) / (size * 24), 1e-11, "convection keeps the momentum, sum of N");
}

/* N against its formula, second order. */
static void CheckConsistency(const char name[], const char options[], Exact *f) {
  PetscReal error[2];
  TestAbout("convection, %s", name);
  for (int k = 0; k < 2; k++) {
    ScopedWorld r;
    Scoped(Convection) c;
    Vec w, N;
    RunCreate(options, 24 << k, 1e-6, &r);
    TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
    TestVecs(r.scheme->state.w, &w, &N, NULL);
    Sample(&r, f, 0.3, VALUE, w);
    Sample(&r, f, 0.3, CONVECTION, N);
    TestCall(ConvectionAdd(c, -1, w, &(Forcing){.values = N}));
    error[k] = TestNorm(NORM_2, N) * r.fluid->grid->h / 2;
  }
  CHECK(error[0] / error[1] > 3.6 && error[0] < 0.1, "second order, error %.1e and %.1e", error[0], error[1]);
}

/* Second order when h and dt go down together, and in dt alone at fixed h. */
static void CheckOrder(const char name[], const char options[], Exact *f, PetscBool forced) {
  PetscReal error[2], apart[2][2];
  TestAbout("%s", name);
  TestWorld r[3];
  for (int k = 0; k < 2; k++) error[k] = Error(options, f, forced, 16 << k, 16 << k);
  CHECK(error[0] / error[1] > 3.4 && error[0] < 0.05, "second order in h and dt, error %.1e and %.1e", error[0],
        error[1]);
  for (int k = 0; k < 3; k++) (void)Run(options, f, forced, 16, 16 << k, &r[k]);
  for (int k = 0; k < 2; k++) Errors(&r[k], f, &r[k + 1], apart[k]);
  CHECK(apart[0][0] / apart[1][0] > 3.4 && apart[1][0] > 0, "second order in dt, differences %.1e and %.1e",
        apart[0][0], apart[1][0]);
  for (int k = 0; k < 3; k++) TestWorldDestroy(&r[k]);
}

/* Decaying modes that are eigenvectors of the discrete operators: split follows backward Euler to round-off. */
static void CheckDecay(const char name[], const char bc[], Exact *f, PetscReal wave, PetscInt directions) {
  const PetscReal dt = 0.03, h = 1.0 / 24;
  const PetscReal lambda = directions * 4 / (h * h) * PetscSqr(PetscSinReal(wave * h / 2));
  ScopedWorld r;
  Vec want;
  RunCreate(TestText(SPLIT "-fluid_viscosity 0.4 %s", bc), 48, dt, &r);
  TestVecs(r.scheme->state.w, &want, NULL);
  Sample(&r, f, 0, VALUE, want);
  TestCall(VecCopy(want, r.scheme->state.w));
  for (PetscInt k = 0; k < 8; k++) TestCall(SchemeStep(r.scheme, PETSC_MAX_REAL));
  TestCall(VecScale(want, PetscPowRealInt(1 + dt * 0.4 * lambda, -8)));
  TestAbout("%s", name);
  CheckBelow(TestApart(NORM_2, want, r.scheme->state.w), 1e-12, "it decays as backward Euler says");
  CheckBelow(TestNorm(NORM_INFINITY, r.scheme->state.p), 1e-12, "it makes no pressure");
  CHECK(r.scheme->report.solves == 3, "3 scalar solves a step");
}

/* Options of n x 3n/4 cells. */
static const char *Oblong(const char bc[], int n) {
  return TestText(SPLIT "-fluid_viscosity 0.3 -domain_box -1,1,-1,0.5 -domain_cells %d,%d %s", n, 3 * n / 4, bc);
}

/* Split with a force in Fluid->bc1: second order in h, where dt = 0.8 h^2, so that both errors fall with h^2; first
   order in dt, on one grid, against a small step. */
static void CheckSplit(const char name[], const char bc[], Exact *f) {
  static const char *const what[] = {"velocity", "pressure"};
  PetscReal space[3][2], time[3][2];
  ScopedWorld fine;
  height = 1.5;
  TestAbout("split, %s", name);
  (void)Run(Oblong(bc, 16), f, PETSC_TRUE, 16, 1280, &fine);
  for (int level = 0; level < 3; level++) {
    const int n = 12 << level;
    ScopedWorld r, s;
    const PetscReal div = Run(Oblong(bc, n), f, PETSC_TRUE, n, n * n / 8, &r);
    CheckBelow(div, 1e-11, "%d cells: max |div u|", n);
    Errors(&r, f, NULL, space[level]);
    (void)Run(Oblong(bc, 16), f, PETSC_TRUE, 16, 20 << level, &s);
    Errors(&s, f, &fine, time[level]);
  }
  for (int level = 1; level < 3; level++)
    for (int k = 0; k < 2; k++) {
      const PetscReal in_h = PetscLog2Real(space[level - 1][k] / space[level][k]);
      const PetscReal in_dt = PetscLog2Real(time[level - 1][k] / time[level][k]);
      CHECK(in_h > (k ? 1.5 : 1.8), "%s of order %.2f in h, error %.2e", what[k], in_h, space[level][k]);
      CHECK(in_dt > 0.9, "%s of order %.2f in dt, error %.2e", what[k], in_dt, time[level][k]);
    }
  height = 2;
}

/* Galilean invariance of the fluid alone: unsteady Stokes flow leaves the vortices where they were. */
static void CheckUnsteady(void) {
  const PetscReal with = Error(PERIODIC STREAM, Carried, PETSC_FALSE, 32, 64);
  const PetscReal without = Error(PERIODIC STREAM "-fluid_inertia unsteady", Carried, PETSC_FALSE, 32, 64);
  CHECK(with < 0.01 && without > 30 * with, "vortices in a stream: error %.1e with convection, %.1e without", with,
        without);
}

/* One entry of a velocity that is not a number, on one rank, is found by all ranks: the speed decides whether a step is
   taken. Nothing is left of it in a velocity of finite entries. */
static void CheckSpeed(void) {
  ScopedWorld r;
  Scoped(Convection) c;
  PetscReal speed;
  RunCreate(PERIODIC, 24, 1e-6, &r);
  TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
  for (PetscMPIInt rank = 0; rank < r.fluid->grid->size; rank++) {
    TestCall(VecSet(r.scheme->state.w, 0.5));
    TestCall(ConvectionSpeed(c, r.scheme->state.w, &speed));
    CheckBelow(speed - 1, 1e-15, "speed |u| + |v| of a uniform flow");
    PetscScalar *a = TestArray(r.scheme->state.w);
    if (r.fluid->grid->rank == rank) a[30] = NAN;
    TestCall(ConvectionSpeed(c, r.scheme->state.w, &speed));
    CHECK(PetscIsNanReal(speed), "a velocity that is not a number on rank %d is seen by all", rank);
  }
}

void Facts(void) {
  CheckConservation("periodic", PERIODIC);
  CheckConservation("periodic with a stream", PERIODIC STREAM);
  CheckConservation("channel", CHANNEL);
  CheckConservation("walls", "");
  CheckConsistency("poiseuille in a channel", POISEUILLE, InChannel);
  CheckConsistency("shear between walls", "-flow_type shear", InBox);
  CheckConsistency("extension between walls", "-flow_type extension", InBox);
  CheckOrder("vortices in a stream", PERIODIC STREAM, Carried, PETSC_FALSE);
  CheckOrder("manufactured, poiseuille in a channel", POISEUILLE, InChannel, PETSC_TRUE);
  CheckOrder("manufactured, shear between walls", "-flow_type shear", InBox, PETSC_TRUE);
  TestAbout("fluid with inertia");
  CheckSpeed();
  CheckUnsteady();
  CheckDecay("shear mode in a channel", CHANNEL, ShearMode, PETSC_PI, 1);
  CheckDecay("vortex in a periodic box", PERIODIC, Vortex, 2 * PETSC_PI, 2);
  CheckSplit("four walls", "", InBox);
  CheckSplit("channel along x", CHANNEL, InChannel);
}
