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

static void Residual(FastSolver s, Vec b, Vec x, PetscReal *residual) {
  PetscReal norm;
  Vec r;
  TestCall(VecDuplicate(b, &r));
  TestCall(MatMult(s->A, x, r));
  TestCall(VecAXPY(r, -1, b));
  TestCall(VecNorm(r, NORM_2, residual));
  TestCall(VecNorm(b, NORM_2, &norm));
  *residual /= norm;
  TestCall(VecDestroy(&r));
}

static void TimeCopy(Vec b, Vec x, PetscReal *seconds) {
  const PetscScalar *ba;
  PetscScalar *xa;
  PetscInt n;
  PetscLogDouble start = 0;
  TestCall(VecGetLocalSize(b, &n));
  TestCall(VecGetArrayRead(b, &ba));
  TestCall(VecGetArray(x, &xa));
  Begin(&start);
  for (int k = 0; k < COPIES; k++) {
    memcpy(xa, ba, (size_t)n * sizeof(PetscScalar));
    __asm__ volatile("" : : "r"(xa) : "memory"); /* every copy is made */
  }
  Elapsed(start, seconds);
  *seconds /= COPIES;
  TestCall(VecRestoreArray(x, &xa));
  TestCall(VecRestoreArrayRead(b, &ba));
}

/* One field: Helmholtz for the velocity with a0 = 3/(2 dt), dt = h, Poisson for the pressure. */
static void BenchField(Grid grid, const char box[], Field field, PetscInt repeats, PetscBool hypre) {
  const int count = hypre ? BACK_ENDS : BACK_ENDS - 1;
  FastSolver s[BACK_ENDS];
  PetscReal seconds[BACK_ENDS + 1][MOST_REPEATS], residual[BACK_ENDS], sum;
  PetscLogDouble start = 0;
  PetscInt n;
  Vec b, x;
  TestCall(DMCreateGlobalVector(grid->da[field], &b));
  TestCall(VecDuplicate(b, &x));
  TestRandomVec(5, b);
  TestCall(VecSum(b, &sum));
  TestCall(VecGetSize(b, &n));
  if (field == FIELD_P) TestCall(VecShift(b, -sum / n));
  for (int k = 0; k < count; k++) {
    TestCall(FastSolverCreate(grid, field, back_ends[k], &s[k]));
    TestCall(FastSolverSetCoefficients(s[k], field == FIELD_P ? 0 : 1.5 / grid->h, field == FIELD_P ? -1 : 1));
    TestCall(PCApply(s[k]->pc, b, x));
    Residual(s[k], b, x, &residual[k]);
  }
  for (PetscInt i = 0; i < repeats; i++) {
    TimeCopy(b, x, &seconds[BACK_ENDS][i]);
    for (int k = 0; k < count; k++) {
      Begin(&start);
      TestCall(PCApply(s[k]->pc, b, x));
      Elapsed(start, &seconds[k][i]);
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
  for (int k = 0; k < count; k++) TestCall(FastSolverDestroy(&s[k]));
  TestCall(VecDestroy(&b));
  TestCall(VecDestroy(&x));
}

/* A whole Stokes solve, and a copy of a velocity and a pressure, with the force in every row. */
static void BenchStokes(Scene scene, const char box[], PetscInt repeats) {
  PetscReal seconds[2][MOST_REPEATS], parts[2];
  PetscLogDouble start = 0;
  Fluid fluid;
  Stokes stokes;
  Vec r, u, p, q;
  TestCall(FluidCreate(&scene->fluid, &fluid));
  TestCall(FluidSetTimeCoefficient(fluid, 1.5 / fluid->grid->h));
  TestCall(StokesCreate(fluid, &stokes));
  TestCall(DMCreateGlobalVector(fluid->grid->velocity, &r));
  TestCall(VecDuplicate(r, &u));
  TestCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &p));
  TestCall(VecDuplicate(p, &q));
  TestRandomVec(6, r);
  TestCall(StokesSolve(stokes, r, NULL, u, p));
  for (PetscInt i = 0; i < repeats; i++) {
    TimeCopy(r, u, &parts[0]);
    TimeCopy(q, p, &parts[1]);
    seconds[0][i] = parts[0] + parts[1];
    Begin(&start);
    TestCall(StokesSolve(stokes, r, NULL, u, p));
    Elapsed(start, &seconds[1][i]);
  }
  if (!fluid->grid->rank) {
    printf("{\"cells\": %d, \"ranks\": %d, \"box\": \"%s\", \"what\": \"stokes\", ", (int)fluid->grid->n[0],
           fluid->grid->size, box);
    PrintList("copy", repeats, seconds[0]);
    printf(", ");
    PrintList("fftw_tridiagonal", repeats, seconds[1]);
    printf("}\n");
  }
  TestCall(VecDestroy(&r));
  TestCall(VecDestroy(&u));
  TestCall(VecDestroy(&p));
  TestCall(VecDestroy(&q));
  TestCall(StokesDestroy(&stokes));
  TestCall(FluidDestroy(&fluid));
}

static void Bench(void) {
  PetscInt cells = 256, repeats = 9;
  PetscBool hypre = PETSC_TRUE;
  TestCall(PetscOptionsGetInt(NULL, NULL, "-cells", &cells, NULL));
  TestCall(PetscOptionsGetInt(NULL, NULL, "-repeats", &repeats, NULL));
  TestCall(PetscOptionsGetBool(NULL, NULL, "-hypre", &hypre, NULL));
  PetscCheckAbort(repeats > 0 && repeats <= MOST_REPEATS, PETSC_COMM_WORLD, PETSC_ERR_USER_INPUT,
                  "-repeats %" PetscInt_FMT ": allowed: 1 to %d", repeats, MOST_REPEATS);
  for (size_t k = 0; k < sizeof(boxes) / sizeof(boxes[0]); k++) {
    Scene scene;
    Grid grid;
    TestScene(&scene, "-domain_cells %d,%d %s -vesicle_shape none", (int)cells, (int)cells, boxes[k].options);
    TestCall(GridCreate(&scene->fluid, &grid));
    for (int f = 0; f < 3; f++) BenchField(grid, boxes[k].name, (Field)f, repeats, hypre);
    TestCall(GridDestroy(&grid));
    BenchStokes(scene, boxes[k].name, repeats);
    TestCall(SceneDestroy(&scene));
  }
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Bench);
}
