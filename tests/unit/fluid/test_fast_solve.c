/* Fast solves: the stencil applied to the solution gives the right-hand side back, for every boundary pair, field and
   grid shape; FFTW and hypre agree. */
#include "facts.h"
#include "fluid/transforms/fastsolver.h"

/* A right-hand side from the range of the operator, of mean zero where that is singular; with gaps, every second row is
   zero, as the forces of a membrane leave most rows. */
static void RightSide(FastSolver s, unsigned seed, PetscBool gaps, Vec b) {
  const PetscInt n = s->grid->columns[s->field];
  TestRandomVec(seed, b);
  for (PetscInt j = 0; j < s->grid->rows[s->field] && gaps; j += 2) TestCall(PetscArrayzero(TestArray(b) + j * n, n));
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

static void CheckGrid(const char box[], const char bc[], int count) {
  Scene scene;
  Grid grid;
  TestScene(&scene, "%s %s -vesicle_shape none", box, bc);
  TestCall(GridCreate(&scene->fluid, &grid));
  for (int f = 0; f < 3; f++) {
    FastSolver solver[3];
    for (int q = 0; q < count; q++) TestCall(FastSolverCreate(grid, (Field)f, back_ends[q].type, &solver[q]));
    for (int k = 0; k < 4 * count; k++) {
      const FastSolver s = solver[k % count];
      PetscReal mean;
      TestAbout("%s %s, %c, %s, %s", box, bc, "uvp"[f], problems[k / count].name, back_ends[k % count].type);
      TestCall(FastSolverSetCoefficients(s, problems[k / count].a0, problems[k / count].nu));
      if (k % count < 2) {
        CheckBelow(Residual(s, &mean), 1e-12, "residual");
        if (s->singular) CheckBelow(mean, 1e-14, "the solution's mean is zero");
      }
      if (k % count) CheckBelow(Difference(solver[0], s), back_ends[k % count].apart, "against fftw");
    }
    for (int q = 0; q < count; q++) TestCall(FastSolverDestroy(&solver[q]));
  }
  TestCall(GridDestroy(&grid));
  TestCall(SceneDestroy(&scene));
}

void Facts(void) {
  static const char *const bc[] = {"", CHANNEL, PERIODIC};
  static const struct {
    const char *box;
    int back_ends;
  } boxes[] = {{"-domain_box -1,1,-1,1 -domain_cells 64,64", 2},
               {"-domain_box 0,5,0,3.7 -domain_cells 50,37", 2},
               {"-domain_box 0,5.3,0,3.7 -domain_cells 53,37", 2},
               {"-domain_box -1,1,-1,1 -domain_cells 32,32", 3},
               {"-domain_box 0,2.5,0,1.9 -domain_cells 25,19", 3}};
  for (int k = 0; k < 15; k++) CheckGrid(boxes[k / 3].box, bc[k % 3], boxes[k / 3].back_ends);
}
