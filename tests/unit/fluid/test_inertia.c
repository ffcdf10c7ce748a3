/* Convection: its discrete form keeps energy and momentum and is of second order; Navier-Stokes flow against a vortex
   carried by a stream, and against manufactured solutions. Quasi-steady flow: the limit of a slow step. */
#include "facts.h"
#include "krylov/solver.h"
#include "fluid/stokes/convection.h"
#include "fluid/stokes/stokes.h"
#include <dlfcn.h>

#define NU 0.05

typedef void (*Exact)(PetscReal x, PetscReal y, PetscReal t, PetscReal value[3]); /* u', v', p */

/* u' and p of a stream function psi = amplitude P(x) Q(y) that is odd about walls after one derivative. */
static void Flow2(PetscReal amplitude, const PetscReal P[2], const PetscReal Q[2], PetscReal value[3]) {
  value[0] = amplitude * P[0] * Q[1];
  value[1] = -amplitude * P[1] * Q[0];
}

static void InChannel(PetscReal x, PetscReal y, PetscReal t, PetscReal value[3]) {
  const PetscReal phase = PETSC_PI * x - t, half = PETSC_PI * (y + 1) / 2;
  const PetscReal P[2] = {PetscSinReal(phase), PETSC_PI * PetscCosReal(phase)};
  const PetscReal Q[2] = {PetscSqr(PetscSinReal(half)), PETSC_PI / 2 * PetscSinReal(2 * half)};
  Flow2(0.3 * (1 + 0.5 * PetscSinReal(2 * t)), P, Q, value);
  value[2] = PetscCosReal(PETSC_PI * x) * PetscCosReal(PETSC_PI * y);
}

static void InBox(PetscReal x, PetscReal y, PetscReal t, PetscReal value[3]) {
  const PetscReal halves[2] = {PETSC_PI * (x + 1) / 2, PETSC_PI * (y + 1) / 2};
  PetscReal F[2][2];
  for (int d = 0; d < 2; d++) {
    F[d][0] = PetscSqr(PetscSinReal(halves[d]));
    F[d][1] = PETSC_PI / 2 * PetscSinReal(2 * halves[d]);
  }
  Flow2(0.4 * (1 + 0.5 * PetscSinReal(2 * t)), F[0], F[1], value);
  value[2] = PetscCosReal(PETSC_PI * x) * PetscCosReal(PETSC_PI * y);
}

/* Vortices of wave number pi, carried by a stream (1, 0) and decaying: an exact solution of Navier-Stokes. */
static void Carried(PetscReal x, PetscReal y, PetscReal t, PetscReal value[3]) {
  const PetscReal a = PETSC_PI * (x - t), b = PETSC_PI * y, decay = PetscExpReal(-2 * NU * PETSC_PI * PETSC_PI * t);
  value[0] = decay * PetscSinReal(a) * PetscCosReal(b);
  value[1] = -decay * PetscCosReal(a) * PetscSinReal(b);
  value[2] = decay * decay * (PetscCosReal(2 * a) + PetscCosReal(2 * b)) / 4;
}

/* Derivative of component c: axis 0 x, 1 y, 2 t; by differences of fourth order. */
static PetscReal First(Exact f, int c, int axis, const PetscReal at[3]) {
  const PetscReal d = 1e-3, weight[2] = {8, -1};
  PetscReal sum = 0, value[3];
  for (int k = 1; k <= 2; k++)
    for (int side = -1; side <= 1; side += 2) {
      PetscReal q[3] = {at[0], at[1], at[2]};
      q[axis] += side * k * d;
      f(q[0], q[1], q[2], value);
      sum += side * weight[k - 1] * value[c] / (12 * d);
    }
  return sum;
}

static PetscReal Laplacian(Exact f, int c, const PetscReal at[3]) {
  const PetscReal d = 2e-3, weight[2] = {16, -1};
  PetscReal sum = 0, value[3];
  f(at[0], at[1], at[2], value);
  sum = -60 * value[c];
  for (int axis = 0; axis < 2; axis++)
    for (int k = 1; k <= 2; k++)
      for (int side = -1; side <= 1; side += 2) {
        PetscReal q[3] = {at[0], at[1], at[2]};
        q[axis] += side * k * d;
        f(q[0], q[1], q[2], value);
        sum += weight[k - 1] * value[c];
      }
  return sum / (12 * d * d);
}

/* N of the exact flow at a point. */
static PetscReal ExactConvection(const Flow *flow, Exact f, int c, const PetscReal at[3]) {
  PetscReal value[3], background[2], gradient[2][2], sum = 0;
  f(at[0], at[1], at[2], value);
  FlowVelocity(flow, 0, at[0], at[1], background);
  FlowGradient(flow, at[1], gradient);
  for (int b = 0; b < 2; b++) sum += (value[b] + background[b]) * First(f, c, b, at) + value[b] * gradient[c][b];
  return sum;
}

typedef enum { VALUE, CONVECTION, FORCE } What;

/* A velocity vector of the exact flow's values, convection, or the force that upholds it. */
static void Sample(Scene scene, Grid g, Exact f, PetscReal t, What what, Vec w) {
  PetscReal at[3] = {0, 0, t}, value[3];
  PetscScalar *a = TestArray(w);
  for (int c = 0; c < 2; c++)
    for (PetscInt j = 0; j < g->rows[c]; j++)
      for (PetscInt i = 0; i < g->columns[c]; i++) {
        PetscScalar *entry = a + GridRowStart(g, (Field)c, j) + i;
        GridPosition(g, (Field)c, i, j + g->first, at);
        f(at[0], at[1], t, value);
        *entry = value[c];
        if (what != VALUE) *entry = ExactConvection(&scene->flow, f, c, at);
        if (what == FORCE) *entry += First(f, c, 2, at) + First(f, 2, c, at) - scene->fluid.nu * Laplacian(f, c, at);
      }
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

/* Root mean square velocity error at time 0.4, from the exact start; forced: with the force that upholds f. w: copy of
   the end state, or NULL. */
static PetscReal Error(const char options[], Exact f, PetscBool forced, PetscInt n, PetscInt steps, Vec *w) {
  const PetscReal t_end = 0.4, dt = t_end / steps;
  ScopedWorld r;
  Vec exact;
  RunCreate(options, n, dt, &r);
  TestVecs(r.scheme->state.w, &exact, NULL);
  Sample(r.scene, r.fluid->grid, f, 0, VALUE, r.scheme->state.w);
  if (forced) TestCall(VecDuplicate(exact, &body_force));
  for (PetscInt k = 1; k <= steps; k++) {
    if (forced) Sample(r.scene, r.fluid->grid, f, k * dt, FORCE, body_force);
    TestCall(SchemeStep(r.scheme, PETSC_MAX_REAL));
    PetscCheckAbort(!*r.scheme->report.failure, PETSC_COMM_WORLD, PETSC_ERR_LIB, "%s", r.scheme->report.failure);
  }
  Sample(r.scene, r.fluid->grid, f, t_end, VALUE, exact);
  TestCall(VecAYPX(exact, -1, r.scheme->state.w));
  const PetscReal error = TestNorm(NORM_2, exact) * r.fluid->grid->h / 2; /* the box is 2 x 2 */
  if (w) TestVecs(exact, w, NULL);
  if (w) TestCall(VecCopy(r.scheme->state.w, *w));
  TestCall(VecDestroy(&body_force));
  return error;
}

#define PERIODIC "-domain_bc_x periodic -domain_bc_y periodic "
#define STREAM "-flow_type poiseuille -flow_half_width 1e7 "
#define CHANNEL "-domain_bc_x periodic -flow_type poiseuille -flow_half_width 1 "

/* u.N(u) = 0 to rounding for any velocity, divergence or not, on any carrying stream that walls do not cut; and for a
   divergence-free one in a periodic box N adds up to zero. */
static void CheckConservation(const char name[], const char options[]) {
  ScopedWorld r;
  Convection c;
  Vec w, N;
  PetscReal size = 0;
  RunCreate(options, 24, 1e-6, &r);
  TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
  TestVecs(r.scheme->state.w, &w, &N, NULL);
  TestRandomVec(3, w);
  for (int free = 0; free < 2; free++) {
    if (free) TestCall(StokesSolve(TestWorldStokes(&r), w, NULL, w, r.scheme->state.p));
    TestCall(VecSet(N, 0));
    TestCall(ConvectionAdd(c, 1, w, &(Forcing){.values = N}));
    size = TestNorm(NORM_2, N);
    const PetscReal product = TestDot(w, N) / (TestNorm(NORM_2, w) * size);
    CHECK(PetscAbsReal(product) <= 1e-12 && size > 0,
          "%s, %s velocity: convection keeps the energy, u.N over |u| |N| = %.1e", name,
          free ? "divergence-free" : "random", product);
  }
  const PetscScalar sum = TestTotal(N);
  if (!r.fluid->grid->wall[0] && !r.fluid->grid->wall[1])
    CHECK(PetscAbsReal(sum) <= 1e-11 * size * 24, "%s: convection keeps the momentum, sum of N over its size %.1e",
          name, sum / (size * 24));
  TestCall(ConvectionDestroy(&c));
}

/* N against its formula, second order. */
static void CheckConsistency(const char name[], const char options[], Exact f) {
  PetscReal error[2];
  for (int k = 0; k < 2; k++) {
    ScopedWorld r;
    Convection c;
    Vec w, N;
    RunCreate(options, 24 << k, 1e-6, &r);
    TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
    TestVecs(r.scheme->state.w, &w, &N, NULL);
    Sample(r.scene, r.fluid->grid, f, 0.3, VALUE, w);
    Sample(r.scene, r.fluid->grid, f, 0.3, CONVECTION, N);
    TestCall(ConvectionAdd(c, -1, w, &(Forcing){.values = N}));
    error[k] = TestNorm(NORM_2, N) * r.fluid->grid->h / 2;
    TestCall(ConvectionDestroy(&c));
  }
  CHECK(error[0] / error[1] > 3.6 && error[0] < 0.1, "%s: convection is of second order, error %.1e and %.1e", name,
        error[0], error[1]);
}

/* Second order when h and dt go down together, and in dt alone at fixed h. */
static void CheckOrder(const char name[], const char options[], Exact f, PetscBool forced) {
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

/* Stokes() at alpha = 0 is the limit of small alpha, and in a periodic box has no mean. */
static void CheckQuasiSteady(const char name[], const char options[]) {
  const char *const inertia[] = {"-fluid_inertia none", "-fluid_inertia unsteady"};
  Vec w[2], p[2], force;
  for (int k = 0; k < 2; k++) {
    ScopedWorld r;
    RunCreate(TestText("%s %s", options, inertia[k]), 24, 1, &r);
    TestCall(FluidSetTimeCoefficient(r.fluid, 1e-7));
    if (!k) CHECK(r.fluid->alpha == 0 && r.fluid->a0 > 0, "%s: no inertia in quasi-steady flow", name);
    TestVecs(r.scheme->state.w, &force, &w[k], NULL);
    TestVecs(r.scheme->state.p, &p[k], NULL);
    Sample(r.scene, r.fluid->grid, InBox, 0, FORCE, force);
    if (!r.fluid->grid->wall[0] && !r.fluid->grid->wall[1]) TestCall(FluidRemoveMean(r.fluid, force));
    TestCall(StokesSolve(TestWorldStokes(&r), force, NULL, w[k], p[k]));
  }
  if (strstr(options, "bc_y"))
    CHECK(PetscAbsReal(TestTotal(w[0])) <= 1e-10 * TestNorm(NORM_2, w[0]), "%s: no mean flow", name);
  PetscReal apart = TestApart(NORM_2, w[1], w[0]);
  CHECK(apart <= 1e-4 && apart > 0, "%s: velocity is the limit of small inertia, %.1e apart", name, apart);
  apart = TestApart(NORM_2, p[1], p[0]);
  CHECK(apart <= 1e-4, "%s: pressure is the limit of small inertia, %.1e apart", name, apart);
}

/* One entry of a velocity that is not a number, on one rank, is found by all ranks: the speed decides whether a step is
   taken. Nothing is left of it in a velocity of finite entries. */
static void CheckSpeed(void) {
  ScopedWorld r;
  Convection c;
  PetscReal speed;
  PetscMPIInt bad;
  RunCreate(PERIODIC, 24, 1e-6, &r);
  TestCall(ConvectionCreate(&r.scene->flow, r.fluid, &c));
  for (PetscMPIInt rank = 0; rank < r.fluid->grid->size; rank++) {
    TestCall(VecSet(r.scheme->state.w, 0.5));
    TestCall(ConvectionSpeed(c, r.scheme->state.w, &speed));
    CHECK(PetscAbsReal(speed - 1) < 1e-15, "speed |u| + |v| of a uniform flow: %g", speed);
    PetscScalar *a = TestArray(r.scheme->state.w);
    if (r.fluid->grid->rank == rank) a[30] = NAN;
    TestCall(ConvectionSpeed(c, r.scheme->state.w, &speed));
    bad = PetscIsNanReal(speed) ? 1 : 0;
    TestCall(MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_SUM, r.fluid->grid->comm));
    CHECK(bad == r.fluid->grid->size, "a velocity that is not a number on rank %d is seen by %d ranks", rank, bad);
  }
  TestCall(ConvectionDestroy(&c));
}

void Facts(void) {
  CheckConservation("periodic", PERIODIC);
  CheckConservation("periodic with a stream", PERIODIC STREAM);
  CheckConservation("channel", "-domain_bc_x periodic");
  CheckConservation("walls", "");
  CheckConsistency("poiseuille in a channel", CHANNEL, InChannel);
  CheckConsistency("shear between walls", "-flow_type shear", InBox);
  CheckConsistency("extension between walls", "-flow_type extension", InBox);
  CheckOrder("vortices in a stream", PERIODIC STREAM, Carried, PETSC_FALSE);
  CheckOrder("manufactured, poiseuille in a channel", CHANNEL, InChannel, PETSC_TRUE);
  CheckOrder("manufactured, shear between walls", "-flow_type shear", InBox, PETSC_TRUE);
  CheckSpeed();
  CheckUnsteady();
  CheckQuasiSteady("periodic box", PERIODIC);
  CheckQuasiSteady("channel", "-domain_bc_x periodic");
  CheckQuasiSteady("walls", "");
}
