/* Convection: its discrete form keeps energy and momentum and is of second order; Navier-Stokes flow against a vortex
   carried by a stream, and against manufactured solutions. */
#include "facts.h"
#include "krylov/solver.h"
#include "fluid/stokes/convection.h"
#include "fluid/stokes/stokes.h"
#include <dlfcn.h>

TestScoped(Convection, ConvectionDestroy)

#define NU 0.05

    typedef void Exact(const PetscReal at[3], PetscReal value[3]); /* u', v', p at x, y, t */

/* u' and p = cos(pi x) cos(pi y) of a stream function psi = amplitude P(x) Q(y) that is odd about walls after one
   derivative. */
static void Flow2(const PetscReal at[3], PetscReal amplitude, const PetscReal P[2], const PetscReal Q[2],
                  PetscReal value[3]) {
  const PetscReal now = amplitude * (1 + 0.5 * PetscSinReal(2 * at[2]));
  value[0] = now * P[0] * Q[1];
  value[1] = -now * P[1] * Q[0];
  value[2] = PetscCosReal(PETSC_PI * at[0]) * PetscCosReal(PETSC_PI * at[1]);
}

/* A function that is flat at walls x = +-1, and its derivative. */
static void Flat(PetscReal x, PetscReal F[2]) {
  F[0] = PetscSqr(PetscSinReal(PETSC_PI * (x + 1) / 2));
  F[1] = PETSC_PI / 2 * PetscSinReal(PETSC_PI * (x + 1));
}

static void InChannel(const PetscReal at[3], PetscReal value[3]) {
  const PetscReal phase = PETSC_PI * at[0] - at[2], P[2] = {PetscSinReal(phase), PETSC_PI * PetscCosReal(phase)};
  PetscReal Q[2];
  Flat(at[1], Q);
  Flow2(at, 0.3, P, Q, value);
}

static void InBox(const PetscReal at[3], PetscReal value[3]) {
  PetscReal P[2], Q[2];
  Flat(at[0], P);
  Flat(at[1], Q);
  Flow2(at, 0.4, P, Q, value);
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
    q[axis] += (k - 2) * step;
    f(q, value);
    sum += weight[number - 1][k] * value[c];
  }
  return sum / PetscPowRealInt(step, number);
}

/* The exact flow's values, its convection N, or the force that upholds it. */
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
  for (int b = 0; b < 2; b++)
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

/* Root mean square velocity error at time 0.4, from the exact start, and the end state where w is given; forced: with
   the force that upholds f. */
static PetscReal Error(const char options[], Exact *f, PetscBool forced, PetscInt n, PetscInt steps, Vec *w) {
  const PetscReal t_end = 0.4, dt = t_end / steps;
  ScopedWorld r;
  Vec exact, end;
  RunCreate(options, n, dt, &r);
  end = r.scheme->state.w;
  TestVecs(end, &exact, NULL);
  Sample(&r, f, 0, VALUE, end);
  if (forced) TestCall(VecDuplicate(exact, &body_force));
  for (PetscInt k = 1; k <= steps; k++) {
    if (forced) Sample(&r, f, k * dt, FORCE, body_force);
    TestCall(SchemeStep(r.scheme, PETSC_MAX_REAL));
    PetscCheckAbort(!*r.scheme->report.failure, PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", r.scheme->report.failure);
  }
  TestCall(VecDestroy(&body_force));
  if (w) TestVecs(end, w, NULL);
  if (w) TestCall(VecCopy(end, *w));
  Sample(&r, f, t_end, VALUE, exact);
  TestCall(VecAXPY(exact, -1, end));
  return TestNorm(NORM_2, exact) * r.fluid->grid->h / 2; /* the box is 2 x 2 */
}

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
  CHECK(error[0] / error[1] > 3.6 && error[0] < 0.1, "%s: convection is of second order, error %.1e and %.1e", name,
        error[0], error[1]);
}

/* Second order when h and dt go down together, and in dt alone at fixed h. */
static void CheckOrder(const char name[], const char options[], Exact *f, PetscBool forced) {
  PetscReal error[2], apart[2];
  Vec w[3];
  for (int k = 0; k < 2; k++) error[k] = Error(options, f, forced, 16 << k, 16 << k, NULL);
  CHECK(error[0] / error[1] > 3.4 && error[0] < 0.05, "%s: second order in h and dt, error %.1e and %.1e", name,
        error[0], error[1]);
  for (int k = 0; k < 3; k++) (void)Error(options, f, forced, 16, 16 << k, &w[k]);
  for (int k = 0; k < 2; k++) {
    TestCall(VecAXPY(w[k], -1, w[k + 1]));
    apart[k] = TestNorm(NORM_2, w[k]);
  }
  CHECK(apart[0] / apart[1] > 3.4 && apart[1] > 0, "%s: second order in dt, differences %.1e and %.1e", name, apart[0],
        apart[1]);
}

/* Galilean invariance of the fluid alone: unsteady Stokes flow leaves the vortices where they were. */
static void CheckUnsteady(void) {
  const PetscReal with = Error(PERIODIC STREAM, Carried, PETSC_FALSE, 32, 64, NULL);
  const PetscReal without = Error(PERIODIC STREAM "-fluid_inertia unsteady", Carried, PETSC_FALSE, 32, 64, NULL);
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
  CheckSpeed();
  CheckUnsteady();
}
