/* Fast solves against copies of the array, back end by back end, field by field, box by box; and Stokes solves. Each
   repetition goes through all of them in turn.
     bench_solve -cells N -repeats R -hypre true|false      one JSON object a line, seconds of each repetition */
#include "bench.h"
#include "fluid/transforms/fastsolver.h"
#include "fluid/stokes/stokes.h"

#define BACK_ENDS 3
#define MOST_REPEATS 64
#define COPIES 16

static const char *const back_ends[BACK_ENDS] = {"fftw_tridiagonal", "fftw", "hypre"};
static const struct {
  const char *name, *options;
} boxes[] = {{"walls", "-domain_bc_x wall -domain_bc_y wall"},
             {"channel", "-domain_bc_x periodic -domain_bc_y wall"},
             {"periodic", "-domain_bc_x periodic -domain_bc_y periodic"}};

static PetscErrorCode Residual(FastSolver s, Vec b, Vec x, PetscReal *residual) {
  PetscReal norm;
  Vec r;
  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(b, &r));
  PetscCall(MatMult(s->A, x, r));
  PetscCall(VecAXPY(r, -1, b));
  PetscCall(VecNorm(r, NORM_2, residual));
  PetscCall(VecNorm(b, NORM_2, &norm));
  *residual /= norm;
  PetscCall(VecDestroy(&r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode TimeCopy(Vec b, Vec x, PetscReal *seconds) {
  const PetscScalar *ba;
  PetscScalar *xa;
  PetscInt n;
  PetscLogDouble start = 0;
  PetscFunctionBeginUser;
  PetscCall(VecGetLocalSize(b, &n));
  PetscCall(VecGetArrayRead(b, &ba));
  PetscCall(VecGetArray(x, &xa));
  PetscCall(Begin(&start));
  for (int k = 0; k < COPIES; k++) {
    memcpy(xa, ba, (size_t)n * sizeof(PetscScalar));
    __asm__ volatile("" : : "r"(xa) : "memory"); /* every copy is made */
  }
  PetscCall(Elapsed(start, seconds));
  *seconds /= COPIES;
  PetscCall(VecRestoreArray(x, &xa));
  PetscCall(VecRestoreArrayRead(b, &ba));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One field: Helmholtz for the velocity with a0 = 3/(2 dt), dt = h, Poisson for the pressure. */
static PetscErrorCode BenchField(Grid grid, const char box[], Field field, PetscInt repeats, PetscBool hypre) {
  const int count = hypre ? BACK_ENDS : BACK_ENDS - 1;
  FastSolver s[BACK_ENDS];
  PetscReal seconds[BACK_ENDS + 1][MOST_REPEATS], residual[BACK_ENDS], sum;
  PetscLogDouble start = 0;
  PetscInt n;
  Vec b, x;
  PetscFunctionBeginUser;
  PetscCall(DMCreateGlobalVector(grid->da[field], &b));
  PetscCall(VecDuplicate(b, &x));
  PetscCall(TestRandomVec(5, b));
  PetscCall(VecSum(b, &sum));
  PetscCall(VecGetSize(b, &n));
  if (field == FIELD_P) PetscCall(VecShift(b, -sum / n));
  for (int k = 0; k < count; k++) {
    PetscCall(FastSolverCreate(grid, field, back_ends[k], &s[k]));
    PetscCall(FastSolverSetCoefficients(s[k], field == FIELD_P ? 0 : 1.5 / grid->h, field == FIELD_P ? -1 : 1));
    PetscCall(PCApply(s[k]->pc, b, x));
    PetscCall(Residual(s[k], b, x, &residual[k]));
  }
  for (PetscInt i = 0; i < repeats; i++) {
    PetscCall(TimeCopy(b, x, &seconds[BACK_ENDS][i]));
    for (int k = 0; k < count; k++) {
      PetscCall(Begin(&start));
      PetscCall(PCApply(s[k]->pc, b, x));
      PetscCall(Elapsed(start, &seconds[k][i]));
    }
  }
  if (!grid->rank) {
    printf("{\"cells\": %d, \"ranks\": %d, \"box\": \"%s\", \"what\": \"%c\", ", (int)grid->n[0], grid->size, box,
           "uvp"[field]);
    PrintList("copy", repeats, seconds[BACK_ENDS]);
    for (int k = 0; k < count; k++) {
      printf(", \"%s_residual\": %.2e, ", back_ends[k], (double)residual[k]);
      PrintList(back_ends[k], repeats, seconds[k]);
    }
    printf("}\n");
  }
  for (int k = 0; k < count; k++) PetscCall(FastSolverDestroy(&s[k]));
  PetscCall(VecDestroy(&b));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A whole Stokes solve, and a copy of a velocity and a pressure, with the force in every row. */
static PetscErrorCode BenchStokes(Scene scene, const char box[], PetscInt repeats) {
  PetscReal seconds[2][MOST_REPEATS], parts[2];
  PetscLogDouble start = 0;
  Fluid fluid;
  Stokes stokes;
  Vec r, u, p, q;
  PetscFunctionBeginUser;
  PetscCall(FluidCreate(&scene->fluid, &fluid));
  PetscCall(FluidSetTimeCoefficient(fluid, 1.5 / fluid->grid->h));
  PetscCall(StokesCreate(fluid, &stokes));
  PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &r));
  PetscCall(VecDuplicate(r, &u));
  PetscCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &p));
  PetscCall(VecDuplicate(p, &q));
  PetscCall(TestRandomVec(6, r));
  PetscCall(StokesSolve(stokes, r, NULL, u, p));
  for (PetscInt i = 0; i < repeats; i++) {
    PetscCall(TimeCopy(r, u, &parts[0]));
    PetscCall(TimeCopy(q, p, &parts[1]));
    seconds[0][i] = parts[0] + parts[1];
    PetscCall(Begin(&start));
    PetscCall(StokesSolve(stokes, r, NULL, u, p));
    PetscCall(Elapsed(start, &seconds[1][i]));
  }
  if (!fluid->grid->rank) {
    printf("{\"cells\": %d, \"ranks\": %d, \"box\": \"%s\", \"what\": \"stokes\", ", (int)fluid->grid->n[0],
           fluid->grid->size, box);
    PrintList("copy", repeats, seconds[0]);
    printf(", ");
    PrintList("fftw_tridiagonal", repeats, seconds[1]);
    printf("}\n");
  }
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscCall(VecDestroy(&q));
  PetscCall(StokesDestroy(&stokes));
  PetscCall(FluidDestroy(&fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Bench(void) {
  PetscInt cells = 256, repeats = 9;
  PetscBool hypre = PETSC_TRUE;
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-cells", &cells, NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-repeats", &repeats, NULL));
  PetscCall(PetscOptionsGetBool(NULL, NULL, "-hypre", &hypre, NULL));
  PetscCheck(repeats > 0 && repeats <= MOST_REPEATS, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
             "-repeats %" PetscInt_FMT ": allowed: 1 to %d", repeats, MOST_REPEATS);
  for (size_t k = 0; k < sizeof(boxes) / sizeof(boxes[0]); k++) {
    char options[256];
    Scene scene;
    Grid grid;
    PetscCall(PetscSNPrintf(options, sizeof(options), "-domain_cells %d,%d %s -vesicle_shape none", (int)cells,
                            (int)cells, boxes[k].options));
    PetscCall(TestScene(options, &scene));
    PetscCall(GridCreate(&scene->fluid, &grid));
    for (int f = 0; f < 3; f++) PetscCall(BenchField(grid, boxes[k].name, (Field)f, repeats, hypre));
    PetscCall(GridDestroy(&grid));
    PetscCall(BenchStokes(scene, boxes[k].name, repeats));
    PetscCall(SceneDestroy(&scene));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Bench);
}
