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
  TestCall(CoupledSolverCreate(q->t.scene, q->t.coupling, &q->s));
  TestFieldVecs(q->t.fluid->grid->velocity, &q->f, &q->w, NULL);
  TestFieldVecs(q->t.fluid->grid->da[FIELD_P], &q->p, NULL);
  TestMarkerVecs(q->t.layout, 1, &q->g, &q->sigma, NULL);
  TestVecs(q->t.X, &q->V, NULL);
}

static void ProblemDestroy(Problem *q) {
  TestCall(CoupledSolverDestroy(&q->s));
  TestWorldDestroy(&q->t);
}

/* A random problem solved, from a zero or a random guess; f stays what it was. */
static void SolveProblem(const char name[], Problem *q, PetscBool random) {
  SolveReport report;
  Forcing r;
  Vec k;
  TestRandomVec(11, q->f);
  TestRandomVec(12, q->g);
  TestCall(VecSet(q->w, 0));
  TestCall(VecSet(q->sigma, 0));
  if (random) {
    TestRandomVec(13, q->w);
    TestRandomVec(14, q->sigma);
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
  CHECK(report.why > 0, "%s: converged in %d iterations", name, (int)report.its);
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
static void CheckSolution(const char name[], Problem *q, PetscBool random) {
  const Fluid f = q->t.fluid;
  const Coupling c = q->t.coupling;
  Vec r, div, U, stretching;
  SolveProblem(name, q, random);
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
    CHECK(row[k] < (k ? 3e-12 : 2e-11) * size, "%s: row %d of the solution put back, %.1e", name, k + 1, row[k] / size);
}

/* B E: <B E w, v> = <w, B E v>, and <B E w, w> >= 0. */
static void CheckBending(const char name[], Problem *q) {
  const Coupling c = q->t.coupling;
  Vec x[2], y[2], U;
  TestVecs(q->t.X, &U, NULL);
  for (int k = 0; k < 2; k++) {
    TestVecs(q->f, &x[k], &y[k], NULL);
    TestRandomVec(21 + (unsigned)k, x[k]);
    TestCall(MatMult(c->markers->E, x[k], U));
    TestCall(MatMult(c->B, U, y[k]));
  }
  const PetscReal energy = TestDot(y[0], x[0]), one = TestDot(y[0], x[1]), two = TestDot(y[1], x[0]);
  CHECK(PetscAbsReal(one - two) < 1e-12 * PetscAbsReal(one), "%s: B E is symmetric, %.1e", name,
        PetscAbsReal(one - two) / PetscAbsReal(one));
  CHECK(energy > 0, "%s: B E only takes energy, %.3e", name, energy);
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
    error = PetscMax(error, TestFar(n, Mob + column * n, all + first));
  }
  return error;
}

/* Mob of one vesicle against E A^-1 E^T: largest difference over the largest entry; and that shares of it add up. */
static void CheckMobility(const char name[], Problem *q, PetscInt v) {
  const MeanMobility mobility = q->s->preconditioner->mobility;
  const PetscInt n = 2 * LayoutCount(q->t.layout, v);
  const MarkerRange own = {q->t.layout->start[v], n / 2};
  TestCall(MeanMobilitySetUp(mobility, q->t.fluid->alpha));
  PetscReal *Mob = TestReals(n * n), *part = TestReals(n * n);
  TestCall(MeanMobilityAssemble(mobility, &own, &own, 0, 1, Mob));
  const PetscReal error = MobilityError(q, v, Mob), asymmetry = TestAsymmetry(n, Mob), most = TestFar(n * n, Mob, NULL);
  CHECK(error < 1e-11 * most, "%s: Mob is E A^-1 E^T, %.1e", name, error / most);
  CHECK(asymmetry < 1e-11 * most, "%s: Mob is symmetric, %.1e", name, asymmetry / most);
  for (PetscInt p = 0; p < 3; p++) {
    TestCall(MeanMobilityAssemble(mobility, &own, &own, p, 3, part));
    for (PetscInt k = 0; k < n * n; k++) Mob[k] -= part[k];
  }
  const PetscReal apart = TestFar(n * n, Mob, NULL);
  CHECK(apart == 0, "%s: three shares of Mob add up to it, %.1e", name, apart / most);
}

/* With the near field: C is in the equations and in the preconditioner alike, and Mob of markers 14 h and more apart is
   smooth and interpolated. Largest difference from E A^-1 E^T over the largest entry, and iterations to 1e-8. */
static void CheckNearField(const char box[], PetscReal a0, PetscReal most_error, PetscInt most_its) {
  Problem q;
  ProblemCreate(
      TestText("-delta_type cbs54 -membrane_derivative spectral -coupling_near_field exact -vesicle_markers 45 "
               "-domain_cells 64,64 -vesicle_semi_axes 0.3,0.6 -vesicle_bending 10 -coupled_ksp_rtol 1e-8 %s",
               box),
      a0, &q);
  SolveProblem(box, &q, PETSC_FALSE);
  CHECK(q.its <= most_its, "%s, a0 = %g: %d iterations", box, a0, (int)q.its);
  if (q.s->preconditioner->mobility && !q.t.fluid->grid->free) {
    const PetscInt n = 2 * q.t.layout->M;
    const MarkerRange own = {0, n / 2};
    PetscReal *Mob = TestReals(n * n);
    TestCall(MeanMobilityAssemble(q.s->preconditioner->mobility, &own, &own, 0, 1, Mob));
    const PetscReal error = MobilityError(&q, 0, Mob), most = TestFar(n * n, Mob, NULL);
    CHECK(error < most_error * most, "%s, a0 = %g: Mob is E A^-1 E^T within %.1e", box, a0, error / most);
  }
  ProblemDestroy(&q);
}

static void CheckCase(const char options[], PetscReal a0, PetscBool periodic) {
  Problem q;
  const char *name = TestText("%s a0 = %g", strstr(options, "-domain_cells") + 14, a0);
  ProblemCreate(TestText("%s -coupled_ksp_rtol 1e-12 %s", options, periodic ? PERIODIC : ""), a0, &q);
  CheckBending(name, &q);
  CheckSolution(name, &q, PETSC_FALSE);
  CheckSolution(name, &q, PETSC_TRUE);
  for (PetscInt v = 0; v < q.t.layout->bodies && periodic; v++) CheckMobility(name, &q, v);
  ProblemDestroy(&q);
}

void Facts(void) {
  const PetscBool yes = PETSC_TRUE, no = PETSC_FALSE;
  CheckCase("-domain_cells 48,48 -vesicle_bending 1", 100, no);
  CheckCase("-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47 -domain_bc_x periodic "
            "-vesicle_center 0.95,0.05 -vesicle_angle 20",
            3, no);
  CheckCase("-domain_cells 48,48 -vesicle_angle 20", 100, yes);
  CheckCase("-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47 -vesicle_center -0.97,0.93", 0.5, yes);
  CheckCase("-domain_cells 32,32 -delta_type cbs54 -vesicle_center 0.9,0.9", 30, yes);
  /* two vesicles of different size, each with its own ds, and one that nearly fills the period */
  CheckCase("-domain_cells 48,48 -vesicle_count 2 -vesicle_center -0.5,0,0.5,0 -vesicle_semi_axes "
            "0.2,0.5,0.3,0.35",
            20, yes);
  CheckCase("-domain_cells 32,32 -vesicle_semi_axes 0.9,0.2", 20, yes);
  /* so many markers that every vesicle has a dense block of its own, with its owner */
  CheckCase("-domain_cells 256,256 -domain_bc_x periodic -vesicle_bending 1e-3 -vesicle_count 5 -vesicle_semi_axes "
            "0.3,0.35,0.25,0.35,0.2,0.3,0.3,0.2,0.25,0.3 "
            "-vesicle_center -0.5,-0.5,0.3,-0.5,-0.5,0.4,0.2,0.5,0.9,0.4",
            20, no);
  /* images in walls are left to FGMRES; a channel lets the mean flow slip, which closed membranes do not make */
  CheckNearField("-domain_bc_x periodic -domain_bc_y periodic", 3, 2e-6, 2);
  CheckNearField("-domain_bc_x periodic -domain_bc_y periodic", 300, 2e-6, 2);
  CheckNearField("-domain_bc_x periodic -domain_bc_y periodic -fluid_inertia none", 3, 2e-6, 2);
  CheckNearField("-domain_bc_x periodic -fluid_inertia none", 3, 0.8, 7);
  CheckNearField("-fluid_inertia none", 3, 0.2, 9);
  CheckNearField("", 30, 0.1, 6);
  CheckNearField("-domain_bc_x free -domain_bc_y free -fluid_inertia none", 3, 0, 1);
}
