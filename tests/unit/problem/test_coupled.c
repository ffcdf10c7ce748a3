/* The coupled problem's parts: its solution put back into the equations of the step, Mob against E A^-1 E^T column by
   column. */
#include "facts.h"
#include "krylov/solver.h"

typedef struct {
  TestWorld t;
  CoupledSolver s;
  Vec f, w, p, g, sigma, V; /* right-hand sides and solution */
  PetscInt its;             /* of the last solve */
} Problem;

static void ProblemCreate(const char options[], PetscReal a0, Problem *q) {
  TestWorldCreate(&q->t, "%s", options);
  TestWorldPlace(a0, &q->t);
  TestAbout("%s, a0 = %g", options, a0);
  TestCall(CoupledSolverCreate(q->t.scene, q->t.coupling, &q->s));
  TestFieldVecs(q->t.fluid->grid->velocity, &q->f, &q->w, NULL);
  TestFieldVecs(q->t.fluid->grid->da[FIELD_P], &q->p, NULL);
  TestMarkerVecs(q->t.layout, 1, &q->g, &q->sigma, NULL);
  TestVecs(q->t.X, &q->V, NULL);
}

#define ScopedProblem __attribute__((cleanup(ProblemDestroy))) Problem
static void ProblemDestroy(Problem *q) {
  TestCall(CoupledSolverDestroy(&q->s));
  TestWorldDestroy(&q->t);
}

/* A random problem solved, from a zero or a random guess; f stays what it was. */
static void SolveProblem(Problem *q, PetscBool random) {
  SolveReport report;
  Forcing r;
  Vec k;
  TestRandomVecs(11, q->f, q->g, NULL);
  TestCall(VecSet(q->w, 0));
  TestCall(VecSet(q->sigma, 0));
  if (random) {
    TestRandomVecs(13, q->w, q->sigma, NULL);
    TestCall(VecScale(q->w, 0.01)); /* a guess far larger than the solution would leave its rounding */
    TestCall(VecScale(q->sigma, 0.01));
  }
  TestCall(MarkersInterpolate(q->t.coupling->markers, q->w, q->V));
  TestCall(ForcingCreate(q->t.fluid->grid, PETSC_FALSE, &r));
  TestCall(ForcingAdd(&r, q->f));
  TestVecs(q->V, &k, NULL);
  if (q->t.fluid->grid->free) TestRandomVec(16, k); /* there a force on the grid does nothing */
  const CoupledProblem problem = {.known.f = &r, .g = q->g, .k = k, .sigma = q->sigma, .V = q->V};
  TestCall(CoupledSolverSolve(q->s, &problem, &report));
  TestCall(MobilityFields(q->t.coupling->mobility, &r, q->w, q->p));
  CHECK(report.why > 0, "converged in %d iterations", (int)report.its);
  q->its = report.its;
  TestCall(ForcingDestroy(&r));
}

/* d times the scale of each edge's row: what a residual of S^T u = g counts in the solver's norm. */
static PetscReal ScaledNorm(Problem *q, Vec d) {
  Vec scaled;
  TestVecs(q->s->x, &scaled, NULL);
  TestCall(UnknownsPack(q->s->unknowns, NULL, NULL, d, scaled));
  UnknownsScale(q->s->unknowns, PETSC_FALSE, TestArray(scaled));
  return TestNorm(NORM_2, scaled);
}

/* The solution put back into H w + B E w/a0 + G p + S sigma = f, G^T w = 0, S^T w = g by the operators that split uses;
   the third row scaled. */
static void CheckSolution(Problem *q, PetscBool random) {
  const Fluid f = q->t.fluid;
  const Coupling c = q->t.coupling;
  Vec r, div, U, stretching;
  SolveProblem(q, random);
  TestVecs(q->f, &r, NULL);
  TestVecs(q->p, &div, NULL);
  TestVecs(q->t.X, &U, NULL);
  TestVecs(q->g, &stretching, NULL);
  TestCall(MatMult(f->H, q->w, r));
  TestCall(MatMult(c->markers->E, q->w, U));
  TestCall(CouplingSpreadBending(c, 1 / f->a0, U, r));
  TestCall(GridGradient(f->grid, 1, q->p, PETSC_TRUE, r));
  TestCall(CouplingSpreadTension(c, 1, q->sigma, r));
  TestCall(VecAXPY(r, -1, q->f));
  TestCall(GridGradientTranspose(f->grid, 1, q->w, div));
  TestCall(MatMultTranspose(c->S, q->w, stretching));
  TestCall(VecAXPY(stretching, -1, q->g));
  const PetscReal row[3] = {TestNorm(NORM_2, r), TestNorm(NORM_2, div), ScaledNorm(q, stretching)};
  const PetscReal size = PetscHypotReal(TestNorm(NORM_2, q->f), ScaledNorm(q, q->g));
  for (int k = 0; k < 3; k++) /* the solver's residual is V - E u; in row 1 it counts with the bending's stiffness */
    CheckBelow(row[k] / size, (k ? 3e-12 : 2e-11), "row %d of the solution put back", k + 1);
}

/* B E: <B E w, v> = <w, B E v>, and <B E w, w> >= 0. */
static void CheckBending(Problem *q) {
  Vec x[2], y[2], U;
  TestVecs(q->t.X, &U, NULL);
  for (unsigned k = 0; k < 2; k++) {
    TestVecs(q->f, &x[k], &y[k], NULL);
    TestRandomVec(21 + k, x[k]);
    TestCall(MatMult(q->t.coupling->markers->E, x[k], U));
    TestCall(MatMult(q->t.coupling->B, U, y[k]));
  }
  CheckBelow(TestDot(y[1], x[0]) / TestDot(y[0], x[1]) - 1, 1e-12, "B E is symmetric");
  CHECK(TestDot(y[0], x[0]) > 0, "B E only takes energy, %.3e", TestDot(y[0], x[0]));
}

/* Largest |Mob - E A^-1 E^T| of one vesicle, one Stokes solve a column, on every rank. */
static PetscReal MobilityError(Problem *q, PetscInt v, const PetscReal Mob[]) {
  const Markers m = q->t.coupling->markers;
  const PetscInt first = 2 * q->t.layout->start[v], n = 2 * LayoutCount(q->t.layout, v);
  PetscReal *all = TestReals(2 * q->t.layout->M), error = 0;
  Vec F, r;
  TestVecs(q->t.X, &F, NULL);
  TestVecs(q->f, &r, NULL);
  for (PetscInt column = 0; column < n; column++) {
    TestUnit(first + column, F);
    TestCall(MatMultTranspose(m->E, F, r));
    TestCall(StokesProject(TestWorldStokes(&q->t), r, NULL, r, q->p)); /* the table knows no walls */
    TestCall(MatMult(m->E, r, F));
    TestCall(LayoutGatherVec(q->t.layout, F, all));
    TestWorse(&error, TestFar(n, Mob + column * n, all + first));
  }
  return error;
}

/* Mob of one vesicle against E A^-1 E^T: largest difference over the largest entry; and that shares of it add up. */
static void CheckMobility(Problem *q, PetscInt v) {
  const MeanMobility mobility = q->s->preconditioner->mobility;
  const PetscInt n = 2 * LayoutCount(q->t.layout, v);
  const MarkerRange own = {q->t.layout->start[v], n / 2};
  TestCall(MeanMobilitySetUp(mobility, q->t.fluid->alpha));
  PetscReal *Mob = TestReals(n * n), *part = TestReals(n * n);
  TestCall(MeanMobilityAssemble(mobility, &own, &own, 0, 1, Mob));
  const PetscReal most = TestFar(n * n, Mob, NULL);
  CheckBelow(MobilityError(q, v, Mob) / most, 1e-11, "Mob is E A^-1 E^T");
  CheckBelow(TestAsymmetry(n, Mob) / most, 1e-11, "Mob is symmetric");
  for (PetscInt p = 0; p < 3; p++) {
    TestCall(MeanMobilityAssemble(mobility, &own, &own, p, 3, part));
    for (PetscInt k = 0; k < n * n; k++) Mob[k] -= part[k];
  }
  CHECK(TestFar(n * n, Mob, NULL) == 0, "three shares of Mob add up to it");
}

/* With the near field: C is in the equations and in the preconditioner alike, and Mob of markers 14 h and more apart is
   smooth and interpolated. Largest difference from E A^-1 E^T over the largest entry, and iterations to 1e-8. */
static void CheckNearField(const char box[], PetscReal a0, PetscReal most_error, PetscInt most_its) {
  ScopedProblem q;
  ProblemCreate(
      TestText("-delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact -vesicle_markers 45 "
               "-domain_cells 64,64 -vesicle_semi_axes 0.3,0.6 -vesicle_bending 10 -coupled_ksp_rtol 1e-8 %s",
               box),
      a0, &q);
  SolveProblem(&q, PETSC_FALSE);
  CHECK(q.its <= most_its, "%d iterations", (int)q.its);
  if (!q.s->preconditioner->mobility || q.t.fluid->grid->free) return;
  const PetscInt n = 2 * q.t.layout->M;
  PetscReal *Mob = TestReals(n * n);
  TestCall(MeanMobilityAssemble(q.s->preconditioner->mobility, &(MarkerRange){0, n / 2}, &(MarkerRange){0, n / 2}, 0, 1,
                                Mob));
  CheckBelow(MobilityError(&q, 0, Mob) / TestFar(n * n, Mob, NULL), most_error, "Mob is E A^-1 E^T");
}

static void CheckCase(const char options[], PetscReal a0, PetscBool periodic) {
  ScopedProblem q;
  ProblemCreate(TestText("%s -coupled_ksp_rtol 1e-12 %s", options, periodic ? PERIODIC : ""), a0, &q);
  CheckBending(&q);
  CheckSolution(&q, PETSC_FALSE);
  CheckSolution(&q, PETSC_TRUE);
  for (PetscInt v = 0; v < q.t.layout->bodies && periodic; v++) CheckMobility(&q, v);
}

void Facts(void) {
  CheckCase("-domain_cells 48,48 -vesicle_bending 1", 100, PETSC_FALSE);
  CheckCase(OBLONG CHANNEL "-vesicle_center 0.95,0.05 -vesicle_angle 20", 3, PETSC_FALSE);
  CheckCase("-domain_cells 48,48 -vesicle_angle 20", 100, PETSC_TRUE);
  CheckCase(OBLONG "-vesicle_center -0.97,0.93", 0.5, PETSC_TRUE);
  CheckCase("-domain_cells 32,32 -delta_type cbs54 -vesicle_center 0.9,0.9", 30, PETSC_TRUE);
  /* two vesicles of different size, each with its own ds, and one that nearly fills the period */
  CheckCase("-domain_cells 48,48 -vesicle_count 2 -vesicle_center -0.5,0,0.5,0 -vesicle_semi_axes 0.2,0.5,0.3,0.35", 20,
            PETSC_TRUE);
  CheckCase("-domain_cells 32,32 -vesicle_semi_axes 0.9,0.2", 20, PETSC_TRUE);
  /* so many markers that every vesicle has a dense block of its own, with its owner */
  CheckCase("-domain_cells 256,256 -domain_bc_x periodic -vesicle_bending 1e-3 -vesicle_count 5 -vesicle_semi_axes "
            "0.3,0.35,0.25,0.35,0.2,0.3,0.3,0.2,0.25,0.3 "
            "-vesicle_center -0.5,-0.5,0.3,-0.5,-0.5,0.4,0.2,0.5,0.9,0.4",
            20, PETSC_FALSE);
  /* images in walls are left to FGMRES; a channel lets the mean flow slip, which closed membranes do not make */
  CheckNearField(PERIODIC, 3, 2e-6, 2);
  CheckNearField(PERIODIC, 300, 2e-6, 2);
  CheckNearField(PERIODIC "-fluid_inertia none", 3, 2e-6, 2);
  CheckNearField("-domain_bc_x periodic -fluid_inertia none", 3, 0.8, 7);
  CheckNearField("-fluid_inertia none", 3, 0.2, 9);
  CheckNearField("", 30, 0.1, 6);
  CheckNearField("-domain_bc_x free -domain_bc_y free -fluid_inertia none", 3, 0, 1);
}
