/* StokesSolve: H u + G p = r_u, G^T u = r_p for random data with a consistent r_p, exactly. StokesProject between four
   walls: the divergence is met, and what is left of the momentum lies on the faces next to the walls that run along the
   velocity component: rows of u under walls in y, columns of v beside walls in x. */
#include "facts.h"
#include "fluid/stokes/stokes.h"

#define TOLERANCE 1e-11

/* Largest entry of a velocity on the faces next to walls along the component, and on all the others. */
static PetscErrorCode WallAndInside(Grid g, Vec r, PetscReal *wall, PetscReal *inside) {
  const PetscScalar *a;
  PetscReal most[2] = {0, 0};
  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(r, &a));
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      for (PetscInt i = 0; i < g->columns[f]; i++) {
        const int across = 1 - f; /* direction across the component */
        const PetscInt at = across ? j + g->first : i, last = g->n[across] - 1;
        const int k = g->wall[across] && (at == 0 || at == last) ? 0 : 1;
        most[k] = PetscMax(most[k], PetscAbsReal(a[GridRowStart(g, (Field)f, j) + i]));
      }
  PetscCall(VecRestoreArrayRead(r, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, most, 2, MPIU_REAL, MPI_MAX, g->comm));
  *wall = most[0];
  *inside = most[1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  Vec r_u, r_p, u, p, left_u, left_p;
} Fields;

static PetscErrorCode FieldsCreate(Fluid f, Fields *x) {
  PetscFunctionBeginUser;
  PetscCall(TestFieldVecs(f->grid->velocity, &x->r_u, &x->u, &x->left_u, NULL));
  PetscCall(TestFieldVecs(f->grid->da[FIELD_P], &x->r_p, &x->p, &x->left_p, NULL));
  PetscCall(TestRandomVec(1, x->r_u));
  PetscCall(TestRandomVec(2, x->r_p));
  PetscCall(TestRemoveMean(x->r_p)); /* what walls at rest, or a period, can let in */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* left_u = H u + G p - r_u, left_p = G^T u - r_p (r_p left out when it is not with). */
static PetscErrorCode Residual(Fluid f, PetscBool with_r_p, Fields *x) {
  PetscFunctionBeginUser;
  PetscCall(MatMult(f->H, x->u, x->left_u));
  PetscCall(GridGradient(f->grid, 1, x->p, PETSC_TRUE, x->left_u));
  PetscCall(VecAXPY(x->left_u, -1, x->r_u));
  PetscCall(GridGradientTranspose(f->grid, 1, x->u, x->left_p));
  if (with_r_p) PetscCall(VecAXPY(x->left_p, -1, x->r_p));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of StokesSolve, or of StokesProject between four walls. */
static PetscErrorCode CheckSolve(const char name[], Fluid f, Stokes stokes, PetscBool with_r_p, PetscBool project,
                                 Fields *x) {
  PetscReal size_u, size_p, left_u, left_p, wall = 0, inside = 0, mean;
  PetscFunctionBeginUser;
  PetscCall((project ? StokesProject : StokesSolve)(stokes, x->r_u, with_r_p ? x->r_p : NULL, x->u, x->p));
  PetscCall(Residual(f, with_r_p, x));
  PetscCall(VecNorm(x->r_u, NORM_2, &size_u));
  PetscCall(VecNorm(x->r_p, NORM_2, &size_p));
  PetscCall(VecNorm(x->left_u, NORM_2, &left_u));
  PetscCall(VecNorm(x->left_p, NORM_2, &left_p));
  PetscCall(VecSum(x->p, &mean));
  PetscCall(WallAndInside(f->grid, x->left_u, &wall, &inside));
  CHECK(left_p < TOLERANCE * size_p, "%s: G^T u = r_p, %.1e", name, left_p / size_p);
  CHECK(PetscAbsReal(mean) < TOLERANCE * size_u * size_p, "%s: p has no mean, sum %.1e", name, mean);
  if (!project)
    CHECK(left_u < TOLERANCE * size_u, "%s: H u + G p = r_u, %.1e", name, left_u / size_u);
  else {
    CHECK(inside < TOLERANCE * size_u, "%s: momentum is met away from the walls, %.1e", name, inside / size_u);
    CHECK(wall > 1e-6, "%s: it is a projection next to the walls, %.1e", name, wall);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* u over r_u and p over r_p give the same bits. */
static PetscErrorCode CheckInPlace(const char name[], Stokes stokes, Fields *x) {
  PetscBool same_u, same_p;
  PetscFunctionBeginUser;
  PetscCall(StokesSolve(stokes, x->r_u, x->r_p, x->u, x->p));
  PetscCall(StokesSolve(stokes, x->r_u, x->r_p, x->r_u, x->r_p));
  PetscCall(VecEqual(x->r_u, x->u, &same_u));
  PetscCall(VecEqual(x->r_p, x->p, &same_p));
  CHECK(same_u && same_p, "%s: in place too", name);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckBox(const char grid[], const char bc[]) {
  static const PetscReal coefficients[] = {128, 0.75, 128};
  char options[512], name[256];
  TestBox box;
  Fields x;
  PetscInt before;
  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(options, sizeof(options), "%s %s -vesicle_shape none -fluid_viscosity 0.7", grid, bc));
  PetscCall(TestBoxCreate(options, &box));
  const Fluid fluid = box.fluid;
  PetscCall(FieldsCreate(fluid, &x));
  for (int k = 0; k < 3; k++) { /* there and back: nothing of an earlier a0 may stay */
    PetscCall(FluidSetTimeCoefficient(fluid, coefficients[k]));
    for (int with = 0; with < 2; with++) {
      PetscCall(PetscSNPrintf(name, sizeof(name), "%s %s a0 = %g%s", strstr(grid, "-domain_cells") + 14, bc,
                              (double)coefficients[k], with ? "" : ", r_p = 0"));
      PetscCall(CheckSolve(name, fluid, box.stokes, with ? PETSC_TRUE : PETSC_FALSE, PETSC_FALSE, &x));
      if (!fluid->grid->wall[0]) continue;
      PetscCall(CheckSolve(name, fluid, box.stokes, with ? PETSC_TRUE : PETSC_FALSE, PETSC_TRUE, &x));
    }
  }
  before = FluidCountSolves(fluid);
  PetscCall(CheckInPlace(name, box.stokes, &x));
  if (fluid->grid->wall[1])
    CHECK(FluidCountSolves(fluid) == before + 10, "%s: five scalar solves each, two twice and one for r_p", name);
  else
    CHECK(FluidCountSolves(fluid) == before + 6, "%s: three scalar solves each", name);
  PetscCall(TestBoxDestroy(&box));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode Facts(void) {
  static const char *const grids[] = {
      "-domain_box -1,1,-1,1 -domain_cells 48,48", "-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47",
      "-domain_box 0,3,0,1.0540540540540540 -domain_cells 74,26", "-domain_box 0,1,0,2.2 -domain_cells 25,55",
      "-domain_box 0,1,0,0.5 -domain_cells 176,88"};
  PetscFunctionBeginUser;
  for (int g = 0; g < 5; g++) {
    PetscCall(CheckBox(grids[g], "-domain_bc_x periodic -domain_bc_y periodic"));
    PetscCall(CheckBox(grids[g], "-domain_bc_x periodic"));
    PetscCall(CheckBox(grids[g], ""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
