/* Fast solves: the stencil applied to the solution gives the right-hand side back, for every boundary pair, field and
   grid shape; FFTW and hypre agree. */
#include "facts.h"
#include "fluid/transforms/fastsolver.h"

typedef struct {
  const char *box, *cells;
} Size;

/* A right-hand side from the range of the operator, of mean zero where that is singular; with gaps, every second row is
   zero, as the forces of a membrane leave most rows. */
static void RightSide(FastSolver s, unsigned seed, PetscBool gaps, Vec b) {
  const PetscInt n = s->grid->columns[s->field];
  TestRandomVec(seed, b);
  PetscScalar *a = TestArray(b);
  for (PetscInt j = 0; j < s->grid->rows[s->field] && gaps; j += 2) TestCall(PetscArrayzero(a + j * n, n));
  if (s->singular) TestRemoveMean(b);
}

/* |b - A x|_2 / |b|_2; mean: of the solution, over its largest entry. */
static PetscReal Residual(FastSolver s, PetscReal *mean) {
  Vec b, x, r;
  PetscInt n;
  TestFieldVecs(s->grid->da[s->field], &b, &x, &r, NULL);
  RightSide(s, 11, PETSC_FALSE, b);
  TestCall(PCApply(s->pc, b, x));
  TestCall(MatMult(s->A, x, r));
  TestCall(VecGetSize(x, &n));
  *mean = PetscAbsReal(TestTotal(x)) / n / TestNorm(NORM_INFINITY, x);
  return TestApart(NORM_2, r, b);
}

/* |x_one - x_two|_inf / |x_one|_inf */
static PetscReal Difference(FastSolver one, FastSolver two) {
  Vec b, x, y;
  TestFieldVecs(one->grid->da[one->field], &b, &x, &y, NULL);
  RightSide(one, 12, PETSC_TRUE, b);
  TestCall(PCApply(one->pc, b, x));
  TestCall(PCApply(two->pc, b, y));
  return TestApart(NORM_INFINITY, y, x);
}

/* Operators to solve: the Helmholtz problem of the paper's settings, a stiffer one, and the Poisson problem. */
static const struct {
  const char *name;
  PetscReal a0, nu;
} problems[] = {{"Helmholtz dt = 1/128", 128, 1},
                {"Helmholtz dt = 10", 0.1, 3},
                {"Helmholtz without a0", 0, 2},
                {"Poisson", 0, -1}};

/* Back ends, and how far each may be from the first. */
static const struct {
  const char *type;
  PetscReal apart;
} back_ends[] = {{"fftw", 0}, {"fftw_tridiagonal", 1e-11}, {"hypre", 1e-8}};

static void CheckGrid(const Size *size, const char bc[], PetscBool hypre) {
  static const char fields[] = "uvp";
  Scene scene;
  Grid grid;
  TestScene(&scene, "-domain_box %s -domain_cells %s %s -vesicle_shape none", size->box, size->cells, bc);
  TestCall(GridCreate(&scene->fluid, &grid));
  for (int f = 0; f < 3; f++) {
    FastSolver solver[3];
    for (int q = 0; q < (hypre ? 3 : 2); q++) TestCall(FastSolverCreate(grid, (Field)f, back_ends[q].type, &solver[q]));
    for (int k = 0; k < 4; k++)
      for (int q = 0; q < (hypre ? 3 : 2); q++) {
        PetscReal error, mean;
        const char *options = TestText("%s %s, %c, %s: %s", size->cells, bc, fields[f], problems[k].name,
                                       back_ends[q].type);
        TestCall(FastSolverSetCoefficients(solver[q], problems[k].a0, problems[k].nu));
        if (q < 2) {
          error = Residual(solver[q], &mean);
          CHECK(error < 1e-12, "%s, residual %.1e", options, error);
          if (solver[q]->singular) CHECK(mean < 1e-14, "   the solution's mean is zero: %.1e", mean);
        }
        if (!q) continue;
        error = Difference(solver[0], solver[q]);
        CHECK(error < back_ends[q].apart, "%s against fftw %.1e", options, error);
      }
    for (int q = 0; q < (hypre ? 3 : 2); q++) TestCall(FastSolverDestroy(&solver[q]));
  }
  TestCall(GridDestroy(&grid));
  TestCall(SceneDestroy(&scene));
}

void Facts(void) {
  static const char *const bc[] = {"-domain_bc_x wall -domain_bc_y wall", "-domain_bc_x periodic -domain_bc_y wall",
                                   "-domain_bc_x periodic -domain_bc_y periodic"};
  static const Size sizes[] = {
      {"-1,1,-1,1", "64,64"}, {"0,5,0,3.7", "50,37"}, {"0,5.3,0,3.7", "53,37"}, {"0,4,0,3", "128,96"}};
  static const Size small[] = {{"-1,1,-1,1", "32,32"}, {"0,2.5,0,1.9", "25,19"}};
  for (int b = 0; b < 3; b++) {
    for (int k = 0; k < 3; k++) CheckGrid(&sizes[k], bc[b], PETSC_FALSE);
    for (int k = 0; k < 2; k++) CheckGrid(&small[k], bc[b], PETSC_TRUE);
  }
}
