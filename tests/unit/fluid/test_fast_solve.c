/* Fast solves: the stencil applied to the solution gives the right-hand side back, for every boundary pair, field and
   grid shape; FFTW and hypre agree. */
#include "facts.h"
#include "fluid/transforms/fastsolver.h"

typedef struct {
  const char *box, *cells;
} Size;

/* |b - A x|_2 / |b|_2. Where A is singular b is taken
   from its range: mean zero. mean: of the solution, over its largest entry. */
static PetscErrorCode Residual(FastSolver s, PetscReal *error, PetscReal *mean) {
  Vec b, x, r;
  PetscReal size[2], sum;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(TestFieldVecs(s->grid->da[s->field], &b, &x, &r, NULL));
  PetscCall(TestRandomVec(11, b));
  PetscCall(VecGetSize(b, &n));
  if (s->singular) {
    PetscCall(VecSum(b, &sum));
    PetscCall(VecShift(b, -sum / n));
  }
  PetscCall(PCApply(s->pc, b, x));
  PetscCall(MatMult(s->A, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, error));
  PetscCall(VecNorm(b, NORM_2, &size[0]));
  *error /= size[0];
  PetscCall(VecSum(x, &sum));
  PetscCall(VecNorm(x, NORM_INFINITY, &size[1]));
  *mean = PetscAbsReal(sum) / n / size[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Every second row is zero, as the forces of a membrane leave most rows. */
static PetscErrorCode ClearRows(FastSolver s, Vec b) {
  const PetscInt n = s->grid->columns[s->field];
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(b, &a));
  for (PetscInt j = 0; j < s->grid->rows[s->field]; j += 2)
    for (PetscInt i = 0; i < n; i++) a[j * n + i] = 0;
  PetscCall(VecRestoreArray(b, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* |x_fftw - x_hypre|_inf / |x_fftw|_inf */
static PetscErrorCode Difference(FastSolver one, FastSolver two, PetscReal *error) {
  Vec b, x, y;
  PetscReal size, sum;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(TestFieldVecs(one->grid->da[one->field], &b, &x, &y, NULL));
  PetscCall(TestRandomVec(12, b));
  PetscCall(ClearRows(one, b));
  PetscCall(VecGetSize(b, &n));
  PetscCall(VecSum(b, &sum));
  if (one->singular) PetscCall(VecShift(b, -sum / n));
  PetscCall(PCApply(one->pc, b, x));
  PetscCall(PCApply(two->pc, b, y));
  PetscCall(VecNorm(x, NORM_INFINITY, &size));
  PetscCall(VecAXPY(y, -1, x));
  PetscCall(VecNorm(y, NORM_INFINITY, error));
  *error /= size;
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
    FastSolver fftw, tridiagonal, other;
    PetscCall(FastSolverCreate(grid, (Field)f, "fftw", &fftw));
    PetscCall(FastSolverCreate(grid, (Field)f, "fftw_tridiagonal", &tridiagonal));
    if (hypre) PetscCall(FastSolverCreate(grid, (Field)f, "hypre", &other));
    for (int k = 0; k < 4; k++) {
      PetscReal error, mean;
      PetscCall(FastSolverSetCoefficients(fftw, problems[k].a0, problems[k].nu));
      PetscCall(Residual(fftw, &error, &mean));
      CHECK(error < 1e-12, "%s %s, %c, %s: residual %.1e", size->cells, bc, fields[f], problems[k].name, error);
      if (fftw->singular) CHECK(mean < 1e-14, "   the solution's mean is zero: %.1e", mean);
      PetscCall(FastSolverSetCoefficients(tridiagonal, problems[k].a0, problems[k].nu));
      PetscCall(Residual(tridiagonal, &error, &mean));
      CHECK(error < 1e-12, "%s %s, %c, %s: fftw_tridiagonal's residual %.1e", size->cells, bc, fields[f],
            problems[k].name, error);
      if (tridiagonal->singular) CHECK(mean < 1e-14, "   the solution's mean is zero: %.1e", mean);
      PetscCall(Difference(fftw, tridiagonal, &error));
      CHECK(error < 1e-11, "   fftw_tridiagonal against fftw %.1e", error);
      if (!hypre) continue;
      PetscCall(FastSolverSetCoefficients(other, problems[k].a0, problems[k].nu));
      PetscCall(Difference(fftw, other, &error));
      CHECK(error < 1e-8, "%s %s, %c, %s: fftw against hypre %.1e", size->cells, bc, fields[f], problems[k].name,
            error);
    }
    PetscCall(FastSolverDestroy(&fftw));
    PetscCall(FastSolverDestroy(&tridiagonal));
    if (hypre) PetscCall(FastSolverDestroy(&other));
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
