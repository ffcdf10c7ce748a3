/* The velocity by the stream function is the Stokes solve's, in channels and periodic boxes, steady or not, with a flux
   or without; on every number of ranks. */
#include "world.h"
#include "fluid/stokes.h"

#define TOLERANCE 1e-11

typedef struct {
  Grid grid;
  const PetscScalar *force;
  Rows u;
  PetscScalar *velocity;
} Arrays;

static const PetscScalar *Force(void *ctx, Field f, PetscInt j, PetscScalar work[]) {
  const Arrays *a = (const Arrays *)ctx;
  return f == FIELD_U ? RowAt(&a->u, j) : a->force + GridLocalU(a->grid) + j * a->grid->columns[f];
}

static void Velocity(void *ctx, Field f, PetscInt j, const PetscScalar row[]) {
  Arrays *a = (Arrays *)ctx;
  const PetscInt n = a->grid->columns[f];
  (void)PetscArraycpy(a->velocity + (f == FIELD_V ? GridLocalU(a->grid) : 0) + j * n, row, n);
}

/* u of the force r by rows. */
static PetscErrorCode Solve(Fluid fluid, Stokes stokes, Vec r, Vec u) {
  Arrays a = {.grid = fluid->grid};
  const StreamRows rows = {.ctx = &a, .force = Force, .velocity = Velocity};
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &a.force));
  PetscCall(VecGetArray(u, &a.velocity));
  PetscCall(GridRows(fluid->grid, FIELD_U, a.force, &a.u));
  PetscCall(StreamSolve(StokesStream(stokes), &rows));
  PetscCall(VecRestoreArray(u, &a.velocity));
  PetscCall(VecRestoreArrayRead(r, &a.force));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBox(const char options[]) {
  static const PetscReal coefficients[] = {128, 0.75, 128};
  PetscReal norm, error;
  PetscInt before;
  Scene scene;
  Fluid fluid;
  Stokes stokes;
  Vec r, p, exact, u;
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &scene));
  PetscCall(FluidCreate(&scene->fluid, &fluid));
  PetscCall(StokesCreate(fluid, &stokes));
  PetscCall(DMCreateGlobalVector(fluid->grid->velocity, &r));
  PetscCall(VecDuplicate(r, &exact));
  PetscCall(VecDuplicate(r, &u));
  PetscCall(DMCreateGlobalVector(fluid->grid->da[FIELD_P], &p));
  PetscCall(TestRandomVec(3, r));
  for (int k = 0; k < 3; k++) { /* there and back: nothing of an earlier a0 may stay */
    PetscCall(FluidSetTimeCoefficient(fluid, coefficients[k]));
    PetscCall(StokesSolve(stokes, r, NULL, exact, p));
    before = FluidCountSolves(fluid);
    PetscCall(Solve(fluid, stokes, r, u));
    CHECK(FluidCountSolves(fluid) == before + 1, "%s: counted as one scalar solve", options);
    PetscCall(VecNorm(exact, NORM_2, &norm));
    PetscCall(VecAXPY(u, -1, exact));
    PetscCall(VecNorm(u, NORM_2, &error));
    CHECK(error < TOLERANCE * norm, "%s, a0 = %g: the Stokes solve's velocity, %.1e", options, (double)coefficients[k],
          (double)(error / norm));
  }
  PetscCall(VecDestroy(&r));
  PetscCall(VecDestroy(&exact));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&p));
  PetscCall(StokesDestroy(&stokes));
  PetscCall(FluidDestroy(&fluid));
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Facts(void) {
  static const char *const grids[] = {
      "-domain_box -1,1,-1,1 -domain_cells 48,48", "-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47",
      "-domain_box 0,3,0,1.0540540540540540 -domain_cells 74,26", "-domain_box 0,1,0,2.24 -domain_cells 25,56",
      "-domain_box 0,1,0,1.875 -domain_cells 8,15"};
  static const char *const kinds[] = {"-domain_bc_y periodic -fluid_inertia unsteady",
                                      "-domain_bc_y periodic -fluid_inertia none", "-fluid_inertia unsteady",
                                      "-fluid_inertia none", "-fluid_inertia none -flow_drive flux"};
  char options[512];
  PetscFunctionBeginUser;
  for (int g = 0; g < 5; g++)
    for (int k = 0; k < 5; k++) {
      PetscCall(PetscSNPrintf(options, sizeof(options),
                              "%s %s -domain_bc_x periodic -vesicle_shape none -fluid_viscosity 0.7", grids[g],
                              kinds[k]));
      PetscCall(CheckBox(options));
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv) {
  return CheckMain(argc, argv, Facts);
}
