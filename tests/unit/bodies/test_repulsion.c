/* Repulsion and adhesion of membranes: the force is minus the slope of the energy, every force has its counterforce,
   and the springs of a step are the law where they were found. */
#include "facts.h"
#include "bodies/repulsion.h"

/* Two vesicles, one of them near a wall and near an image of the other. */
static const char scene[] =
    "-domain_box 0,3,0,3 -domain_cells 48,48 -domain_bc_x periodic -scheme_type coupled -fluid_inertia none "
    "-membrane_derivative spectral -vesicle_count 2 -vesicle_semi_axes 0.6,0.5 -vesicle_angle 20,-30 "
    "-vesicle_markers 30 -vesicle_allow_close_markers ";

typedef struct {
  const char *name, *centers;
  SceneRepulsion law;
  PetscBool wall, folded;
} Case;

static const Case cases[] = {
    {"repulsion", "-vesicle_center 0.8,1.5,2.05,1.6", {20, 0.25, 0, 0}, PETSC_FALSE},
    {"over the seam", "-vesicle_center 0.3,1.5,2.1,1.6", {20, 0.4, 0, 0}, PETSC_FALSE},
    {"at a wall", "-vesicle_center 0.8,0.65,2.1,1.6", {20, 0.25, 0, 0}, PETSC_TRUE},
    {"adhesion", "-vesicle_center 0.8,1.5,2.05,1.6", {20, 0.13, 0.3, 0.3}, PETSC_FALSE},
    {"one vesicle", "-vesicle_center 0.8,1.5,2.1,1.6", {20, 0.25, 0, 0}, PETSC_FALSE, PETSC_TRUE}};

/* A thin vesicle bent to a ring whose ends are near: its parts touch across the inside and across the outside. */
static void Fold(PetscInt n, PetscReal X[]) {
  for (PetscInt k = 0; k < n; k++) {
    const PetscReal t = 2 * PETSC_PI * (PetscReal)k / (PetscReal)n, r = 0.35 + 0.07 * PetscSinReal(t),
                    phi = -0.93 * PETSC_PI * PetscCosReal(t);
    X[2 * k] = 0.8 + r * PetscCosReal(phi);
    X[2 * k + 1] = 1.5 + r * PetscSinReal(phi);
  }
}

/* The energy of both vesicles. */
static PetscReal EnergyOf(const Force *force, const PetscReal X[]) {
  PetscReal E[2] = {0, 0};
  TestCall(force->energy(force->context, (Instant){0}, X, NULL, E));
  return E[0] + E[1];
}

/* Largest difference of the force from the energy's slope, over the largest force. */
static void CheckSlope(const Case *c, const Force *r, Layout l, PetscReal X[]) {
  const PetscReal step = 1e-6;
  PetscReal around[2], off = 0, sum[2] = {0, 0}, torque = 0;
  PetscReal *F = TestReals(2 * l->M);
  TestCall(r->law(r->context, (Instant){0}, X, F, NULL));
  for (PetscInt k = 0; k < 2 * l->M; k++) {
    const PetscReal x = X[k];
    for (int side = 0; side < 2; side++) {
      X[k] = x + (side ? step : -step);
      around[side] = EnergyOf(r, X);
    }
    X[k] = x;
    TestWorse(&off, F[k] + (around[1] - around[0]) / (2 * step));
    sum[k % 2] += F[k];
    torque += k % 2 ? X[k - 1] * F[k] : -X[k + 1] * F[k];
  }
  const PetscReal largest = TestFar(2 * l->M, F, NULL);
  CHECK(largest > 0.01 && off < 1e-5 * largest, "force %.3g, minus the energy's slope to %.1g", largest, off);
  CHECK(PetscAbsReal(sum[0]) < 1e-12 && (c->wall ? sum[1] > 0.01 : PetscAbsReal(sum[1]) < 1e-12),
        "forces add up to %.1g, %.3g", sum[0], sum[1]);
  if (c->folded) CheckBelow(torque, 1e-12, "torques add up");
}

/* At X*, push - K_rep X is the force; K_rep is symmetric and takes energy. */
static void CheckSprings(const Force *r, Layout l, const PetscReal X[]) {
  unsigned seed = 5;
  const PetscReal *x = TestRandoms(2 * l->M, &seed), *y = TestRandoms(2 * l->M, &seed);
  PetscReal *F = TestReals(2 * l->M), *Kx = TestReals(2 * l->M), *Ky = TestReals(2 * l->M);
  TestCall(r->place(r->context, (Instant){0}, X));
  TestCall(r->law(r->context, (Instant){0}, X, F, NULL));
  TestCall(r->known(r->context, 1, X, F));
  TestCall(r->rate(r->context, 1, X, F));
  const PetscReal off = TestFar(2 * l->M, F, NULL);
  TestCall(r->rate(r->context, 1, x, Kx));
  TestCall(r->rate(r->context, 1, y, Ky));
  CHECK(((Repulsion)r->context)->count > 0 && off < 1e-12, "%d springs are the law where they were found, to %.1g",
        (int)((Repulsion)r->context)->count, off);
  CheckBelow(TestProduct(2 * l->M, x, Ky) - TestProduct(2 * l->M, y, Kx), 1e-12, "K_rep is symmetric");
  CHECK(TestProduct(2 * l->M, x, Kx) >= 0, "K_rep takes energy, %.3g", TestProduct(2 * l->M, x, Kx));
}

/* With a range shorter than every film there is neither spring nor force nor energy. */
static void CheckRange(const Case *c, const TestMembrane *m, Bodies bodies, Grid grid, const PetscReal X[]) {
  struct _p_Scene near = *m->scene;
  Force r;
  near.repulsion = c->law;
  near.repulsion.range = near.repulsion.band = 1e-3;
  TestCall(ForceCreate_Contact(bodies, grid, &near, &r));
  PetscReal *F = TestReals(2 * m->M);
  TestCall(r.place(r.context, (Instant){0}, X));
  TestCall(r.law(r.context, (Instant){0}, X, F, NULL));
  const PetscReal energy = EnergyOf(&r, X), largest = TestFar(2 * m->M, F, NULL);
  CHECK(((Repulsion)r.context)->count == 0 && energy == 0 && largest == 0,
        "out of range there are %d springs and no force", (int)((Repulsion)r.context)->count);
  TestCall(r.destroy(r.context));
}

void Facts(void) {
  for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
    ScopedMembrane m;
    Bodies bodies;
    Force r;
    Grid grid;
    TestAbout("%s", cases[k].name);
    TestMembraneCreate(&m, "%s%s", scene, cases[k].centers);
    TestCall(GridCreate(&m.scene->fluid, &grid));
    TestCall(BodiesCreate(m.membrane, NULL, &bodies));
    struct _p_Scene near = *m.scene;
    near.repulsion = cases[k].law;
    TestCall(ForceCreate_Contact(bodies, grid, &near, &r));
    PetscReal *X = TestReals(2 * m.M);
    TestCall(PetscArraycpy(X, m.scene->shape.X, 2 * m.M));
    if (cases[k].folded) Fold(m.layout->start[1], X);
    CheckSlope(&cases[k], &r, m.layout, X);
    CheckSprings(&r, m.layout, X);
    CheckRange(&cases[k], &m, bodies, grid, X);
    TestCall(r.destroy(r.context));
    TestCall(BodiesDestroy(&bodies));
    TestCall(GridDestroy(&grid));
  }
}
