/* Fast solves: the stencil applied to the solution gives the right-hand side back, for every boundary pair, field and
   grid shape; FFTW and hypre agree. */
#include "facts.h"
#include "fluid/transforms/fastsolver.h"

typedef struct {
  const char *box, *cells;
} Size;

/* A right-hand side from the range of the operator, of mean zero where that is singular; with gaps, every second row is
   zero, as the forces of a membrane leave most rows. */
static PetscErrorCode RightSide(FastSolver s, unsigned seed, PetscBool gaps, Vec b) {
  const PetscInt n = s->grid->columns[s->field];
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(TestRandomVec(seed, b));
  PetscCall(VecGetArray(b, &a));
  for (PetscInt j = 0; j < s->grid->rows[s->field] && gaps; j += 2) PetscCall(PetscArrayzero(a + j * n, n));
  PetscCall(VecRestoreArray(b, &a));
  if (s->singular) PetscCall(TestRemoveMean(b));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |b - A x|_2 / |b|_2; mean: of the solution, over its largest entry. */
static PetscErrorCode Residual(FastSolver s, PetscReal *error, PetscReal *mean) {
  Vec b, x, r;
  PetscReal size, sum;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(TestFieldVecs(s->grid->da[s->field], &b, &x, &r, NULL));
  PetscCall(RightSide(s, 11, PETSC_FALSE, b));
  PetscCall(PCApply(s->pc, b, x));
  PetscCall(MatMult(s->A, x, r));
  PetscCall(TestApart(NORM_2, r, b, error));
  PetscCall(VecGetSize(x, &n));
  PetscCall(VecSum(x, &sum));
  PetscCall(VecNorm(x, NORM_INFINITY, &size));
  *mean = PetscAbsReal(sum) / n / size;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |x_one - x_two|_inf / |x_one|_inf */
static PetscErrorCode Difference(FastSolver one, FastSolver two, PetscReal *error) {
  Vec b, x, y;
  PetscFunctionBeginUser;
  PetscCall(TestFieldVecs(one->grid->da[one->field], &b, &x, &y, NULL));
  PetscCall(RightSide(one, 12, PETSC_TRUE, b));
  PetscCall(PCApply(one->pc, b, x));
  PetscCall(PCApply(two->pc, b, y));
  PetscCall(TestApart(NORM_INFINITY, y, x, error));
  PetscFunctionReturn(PETSC_SUCCESS);
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

static PetscErrorCode CheckGrid(const Size *size, const char bc[], PetscBool hypre) {
  static const char fields[] = "uvp";
  Scene scene;
  Grid grid;
  char options[512];
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), "-domain_box %s -domain_cells %s %s -vesicle_shape none", size->box,
                          size->cells, bc));
  PetscCall(TestScene(options, &scene));
  PetscCall(GridCreate(&scene->fluid, &grid));
  for (int f = 0; f < 3; f++) {
    FastSolver solver[3];
    for (int q = 0; q < (hypre ? 3 : 2); q++)
      PetscCall(FastSolverCreate(grid, (Field)f, back_ends[q].type, &solver[q]));
    for (int k = 0; k < 4; k++)
      for (int q = 0; q < (hypre ? 3 : 2); q++) {
        PetscReal error, mean;
        PetscCall(PetscSNPrintf(options, sizeof(options), "%s %s, %c, %s: %s", size->cells, bc, fields[f],
                                problems[k].name, back_ends[q].type));
        PetscCall(FastSolverSetCoefficients(solver[q], problems[k].a0, problems[k].nu));
        if (q < 2) {
          PetscCall(Residual(solver[q], &error, &mean));
          CHECK(error < 1e-12, "%s, residual %.1e", options, error);
          if (solver[q]->singular) CHECK(mean < 1e-14, "   the solution's mean is zero: %.1e", mean);
        }
        if (!q) continue;
        PetscCall(Difference(solver[0], solver[q], &error));
        CHECK(error < back_ends[q].apart, "%s against fftw %.1e", options, error);
      }
    for (int q = 0; q < (hypre ? 3 : 2); q++) PetscCall(FastSolverDestroy(&solver[q]));
  }
  PetscCall(GridDestroy(&grid));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  static const char *const bc[] = {"-domain_bc_x wall -domain_bc_y wall", "-domain_bc_x periodic -domain_bc_y wall",
                                   "-domain_bc_x periodic -domain_bc_y periodic"};
  static const Size sizes[] = {
      {"-1,1,-1,1", "64,64"}, {"0,5,0,3.7", "50,37"}, {"0,5.3,0,3.7", "53,37"}, {"0,4,0,3", "128,96"}};
  static const Size small[] = {{"-1,1,-1,1", "32,32"}, {"0,2.5,0,1.9", "25,19"}};
  PetscFunctionBeginUser;
  for (int b = 0; b < 3; b++) {
    for (int k = 0; k < 3; k++) PetscCall(CheckGrid(&sizes[k], bc[b], PETSC_FALSE));
    for (int k = 0; k < 2; k++) PetscCall(CheckGrid(&small[k], bc[b], PETSC_TRUE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
