/* StokesSolve: H u + G p = r_u, G^T u = r_p for random data with a consistent r_p, exactly, but for a uniform force
   where that moves nothing: in a periodic box in quasi-steady flow, in a channel without flux. StokesProject between
   four walls: the divergence is met, and what is left of the momentum lies on the faces next to the walls that run
   along the velocity component: rows of u under walls in y, columns of v beside walls in x. */
#include "facts.h"
#include "fluid/stokes/stokes.h"

#define TOLERANCE 1e-11

/* Largest entry of a velocity on the faces next to walls along the component, and on all the others. */
static void WallAndInside(Grid g, Vec r, PetscReal most[2]) {
  const PetscScalar *a = TestArray(r);
  for (int f = FIELD_U; f <= FIELD_V; f++)
    for (PetscInt k = 0; k < g->rows[f] * g->columns[f]; k++) {
      const int across = 1 - f; /* direction across the component */
      const PetscInt at = across ? k / g->columns[f] + g->first : k % g->columns[f], last = g->n[across] - 1;
      TestWorse(&most[g->wall[across] && (at == 0 || at == last) ? 0 : 1], a[GridRowStart(g, (Field)f, 0) + k]);
    }
  TestMost(2, most);
}

/* Take off what a uniform force holds. */
static void RemoveUniform(Fluid f, Vec w) {
  const Grid g = f->grid;
  const PetscInt n = f->zero_flux ? GridLocalU(g) : 0;
  PetscScalar *a = TestArray(w), sum = 0;
  if (!g->wall[0] && !g->wall[1] && (f->alpha == 0 || f->held)) TestCall(FluidRemoveMean(f, w));
  for (PetscInt k = 0; k < n; k++) sum += a[k];
  TestSum(1, &sum);
  for (PetscInt k = 0; k < n; k++) a[k] -= sum / ((PetscReal)g->n[0] * g->n[1]);
}

typedef struct {
  Vec r_u, r_p, u, p, left_u, left_p;
} Fields;

static void FieldsCreate(Fluid f, Fields *x) {
  TestFieldVecs(f->grid->velocity, &x->r_u, &x->u, &x->left_u, NULL);
  TestFieldVecs(f->grid->da[FIELD_P], &x->r_p, &x->p, &x->left_p, NULL);
  TestRandomVecs(1, x->r_u, x->r_p, NULL);
  TestRemoveMean(x->r_p); /* what walls at rest, or a period, can let in */
}

/* Of StokesSolve, or of StokesProject between four walls: left_u = H u + G p - r_u, left_p = G^T u - r_p (r_p left out
   when it is not with). Where a uniform force moves nothing the velocity has no mean. */
static void CheckSolve(Fluid f, Stokes stokes, PetscBool with_r_p, PetscBool project, Fields *x) {
  const PetscReal size_u = TestNorm(NORM_2, x->r_u), size_p = TestNorm(NORM_2, x->r_p);
  PetscReal most[2] = {0, 0};
  TestCall((project ? StokesProject : StokesSolve)(stokes, x->r_u, with_r_p ? x->r_p : NULL, x->u, x->p));
  if (f->alpha == 0 && !f->grid->wall[0] && !f->grid->wall[1])
    CheckBelow(TestTotal(x->u) / TestNorm(NORM_2, x->u), 1e-10, "no mean flow");
  TestCall(MatMult(f->H, x->u, x->left_u));
  TestCall(GridGradient(f->grid, 1, x->p, PETSC_TRUE, x->left_u));
  TestCall(VecAXPY(x->left_u, -1, x->r_u));
  RemoveUniform(f, x->left_u);
  TestCall(GridGradientTranspose(f->grid, 1, x->u, x->left_p));
  if (with_r_p) TestCall(VecAXPY(x->left_p, -1, x->r_p));
  WallAndInside(f->grid, x->left_u, most);
  CheckBelow(TestNorm(NORM_2, x->left_p) / size_p, TOLERANCE, "G^T u = r_p");
  CheckBelow(TestTotal(x->p) / (size_u * size_p), TOLERANCE, "p has no mean");
  if (!project)
    CheckBelow(TestNorm(NORM_2, x->left_u) / size_u, TOLERANCE, "H u + G p = r_u");
  else {
    CheckBelow(most[1] / size_u, TOLERANCE, "momentum is met away from the walls");
    CHECK(most[0] > 1e-6, "it is a projection next to the walls, %.1e", most[0]);
  }
}

/* u over r_u and p over r_p give the same bits. */
static void CheckInPlace(Stokes stokes, Fields *x) {
  PetscBool same_u, same_p;
  TestCall(StokesSolve(stokes, x->r_u, x->r_p, x->u, x->p));
  TestCall(StokesSolve(stokes, x->r_u, x->r_p, x->r_u, x->r_p));
  TestCall(VecEqual(x->r_u, x->u, &same_u));
  TestCall(VecEqual(x->r_p, x->p, &same_p));
  CHECK(same_u && same_p, "in place too");
}

static void CheckBox(const char grid[], const char bc[], const char kind[]) {
  static const PetscReal coefficients[] = {128, 0.75, 128};
  ScopedWorld box;
  Fields x;
  TestWorldCreate(&box, "%s %s %s -vesicle_shape none -fluid_viscosity 0.7", grid, bc, kind);
  const Fluid fluid = box.fluid;
  const Stokes stokes = TestWorldStokes(&box);
  FieldsCreate(fluid, &x);
  for (int k = 0; k < (fluid->alpha > 0 ? 3 : 1); k++) { /* there and back: nothing of an earlier a0 may stay */
    TestCall(FluidSetTimeCoefficient(fluid, coefficients[k]));
    for (int with = 0; with < 2; with++) {
      TestAbout("%s %s %s a0 = %g%s", grid, bc, kind, coefficients[k], with ? "" : ", r_p = 0");
      CheckSolve(fluid, stokes, with, PETSC_FALSE, &x);
      if (fluid->grid->wall[0]) CheckSolve(fluid, stokes, with, PETSC_TRUE, &x);
    }
  }
  const PetscInt before = FluidCountSolves(fluid);
  CHECK(fluid->a0 > 0 && (fluid->alpha > 0) == !strstr(kind, "none"), "no inertia in quasi-steady flow");
  CheckInPlace(stokes, &x);
  CHECK(FluidCountSolves(fluid) == before + (fluid->grid->wall[1] ? 10 : 6),
        "three scalar solves each; with walls in y five, two twice and one for r_p");
}

void Facts(void) {
  static const char *const grids[] = {SQUARE,
                                      OBLONG,
                                      "-domain_box 0,3,0,1.0540540540540540 -domain_cells 74,26",
                                      "-domain_box 0,1,0,2.2 -domain_cells 25,55",
                                      "-domain_box 0,1,0,0.5 -domain_cells 176,88",
                                      "-domain_box 0,1,0,1.875 -domain_cells 8,15"};
  static const char *const kinds[] = {"-fluid_inertia unsteady", "-fluid_inertia none"};
  for (int k = 0; k < 12; k++) {
    CheckBox(grids[k / 2], PERIODIC, kinds[k % 2]);
    CheckBox(grids[k / 2], CHANNEL, kinds[k % 2]);
    CheckBox(grids[k / 2], "", kinds[k % 2]);
    if (k % 2) CheckBox(grids[k / 2], CHANNEL, "-fluid_inertia none -flow_drive flux");
  }
}
