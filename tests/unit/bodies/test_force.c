/* A force that the program does not have, a spring from every marker to a point, is added to the list of forces: step,
   energy column, stress and preconditioner have it. */
#include "facts.h"
#include "plane/plane.h"

/* Minus the force is k (X - P), its energy k/2 |X - P|^2. */
typedef struct {
  Layout layout;
  PetscReal k, P[2];
} PointSpring;

static PetscErrorCode PointSpringRate(void *context, PetscReal alpha, const PetscScalar V[], PetscScalar F[]) {
  const PointSpring *s = (const PointSpring *)context;
  for (PetscInt k = 0; k < 2 * s->layout->n; k++) F[k] += alpha * s->k * V[k];
  return PETSC_SUCCESS;
}

static PetscErrorCode PointSpringKnown(void *context, PetscReal alpha, const PetscScalar X[], PetscScalar F[]) {
  const PointSpring *s = (const PointSpring *)context;
  for (PetscInt k = 0; k < 2 * s->layout->n; k++) F[k] -= alpha * s->k * s->P[k % 2];
  return PETSC_SUCCESS;
}

static PetscErrorCode PointSpringDense(void *context, PetscInt v, PetscReal alpha, PetscReal K[]) {
  const PointSpring *s = (const PointSpring *)context;
  const PetscInt n = 2 * LayoutCount(s->layout, v);
  for (PetscInt k = 0; k < n; k++) K[k * n + k] += alpha * s->k;
  return PETSC_SUCCESS;
}

static PetscErrorCode PointSpringEnergy(void *context, Instant at, const PetscScalar X[], PetscScalar F[],
                                        PetscReal E[]) {
  const PointSpring *s = (const PointSpring *)context;
  for (PetscInt k = 0; k < 2 * s->layout->n; k++) E[0] += 0.5 * s->k * PetscSqr(X[k] - s->P[k % 2]); /* one vesicle */
  return PETSC_SUCCESS;
}

#define SHEARED                                                                                                        \
  "-domain_box -2,2,-1,1 -domain_cells 64,32 -domain_bc_x periodic -flow_type shear -scheme_type coupled "             \
  "-fluid_inertia none -coupling_near_field exact -vesicle_semi_axes 0.5,0.3 -vesicle_markers 32 "                     \
  "-vesicle_center 0.1,0.2 "
static const char shear[] = SHEARED "-time_step 0.01 -coupled_ksp_rtol 1e-9 ";
static const char large_steps[] = SHEARED "-time_step 0.1 -coupled_ksp_rtol 1e-6 ";

/* What a run of three steps shows. */
typedef struct {
  Record record;
  PetscInt its; /* iterations of all steps */
  PetscBool has_spring;
  PetscReal energy; /* the last column */
  const PetscReal *center;
} Shown;

/* Three steps, with the spring where it is given: with or without its part of the preconditioner. */
static void Run(const char options[], PointSpring *spring, PetscBool dense, Shown *shown) {
  struct _p_Plane plane;
  RecordSetting columns;
  ScopedWorld w;
  TestScene(&w.scene, "%s", options);
  TestWorldBuild(&w);
  if (spring) {
    const Force force = {.name = "spring",
                         .reach = FORCE_OUTSIDE,
                         .context = spring,
                         .rate = PointSpringRate,
                         .known = PointSpringKnown,
                         .dense = dense ? PointSpringDense : NULL,
                         .energy = PointSpringEnergy};
    spring->layout = w.layout;
    TestCall(ForcesAdd(w.coupling->forces, &force));
  }
  TestWorldScheme(&w);
  plane = (struct _p_Plane){.scene = w.scene, .membrane = w.membrane, .coupling = w.coupling, .scheme = w.scheme};
  TestCall(PlaneColumns(&plane, &columns));
  TestCall(RecordCreate(&columns, &shown->record));
  shown->its = 0;
  for (int k = 0; k < 3; k++) {
    TestCall(SchemeStep(w.scheme, PETSC_MAX_REAL));
    PetscCheckAbort(!*w.scheme->report.failure, w.scene->comm, PETSC_ERR_LIB, "%s", w.scheme->report.failure);
    shown->its += w.scheme->report.coupled_its;
  }
  TestCall(PlaneRow(&plane, shown->record.last));
  TestCall(PlaneMeasure(&plane, shown->record.each, shown->record.last));
  TestSum(w.layout->bodies * COLUMN_COUNT, shown->record.each);
  RecordCombine(&shown->record);
  TestCall(PetscFree(plane.extra));
  TestCall(PetscFree(plane.work));
  shown->has_spring = !strcmp(strrchr(shown->record.header, ','), ",energy_spring");
  shown->energy = strtod(strrchr(shown->record.text, ',') + 1, NULL);
  shown->center = shown->record.last + COLUMN_CENTER_X;
  if (spring) { /* the energy by hand */
    PetscReal energy = 0;
    const PetscScalar *X = TestArray(w.scheme->state.X);
    for (PetscInt k = 0; k < 2 * w.layout->n; k++) energy += 0.5 * spring->k * PetscSqr(X[k] - spring->P[k % 2]);
    TestSum(1, &energy);
    CheckBelow(shown->energy / energy - 1, 1e-13, "the last column is the spring's energy, %.6g", energy);
  }
}

/* Soft springs to points around the vesicle: it comes closer to the point by a way in proportion to the spring's
   stiffness; both stresses of the channel have the spring, and agree. */
static void CheckSoft(const Shown *without, PetscReal x, PetscReal y) {
  PointSpring soft = {.k = 0.05, .P = {x, y}}, softer = {.k = 0.025, .P = {x, y}};
  const PetscReal *none = without->record.last, d[2] = {x - without->center[0], y - without->center[1]};
  Shown one, half;
  Run(shear, &soft, PETSC_TRUE, &one);
  Run(shear, &softer, PETSC_TRUE, &half);
  PetscReal along = 0, ratio = 0;
  for (int c = 0; c < 2; c++) {
    along += d[c] * (one.center[c] - without->center[c]);
    ratio += d[c] * (half.center[c] - without->center[c]);
  }
  const PetscReal *row = one.record.last;
  TestAbout("spring to %g,%g", x, y);
  CHECK(one.has_spring, "series.csv has the column energy_spring");
  CHECK(along > 1e-3 * (d[0] * d[0] + d[1] * d[1]), "it moves the vesicle, %.3g", along);
  CheckBelow(ratio / along - 0.5, 0.05, "half the spring moves it by half of that");
  CheckBelow(row[COLUMN_VISCOSITY] - row[COLUMN_VISCOSITY_WALL], 1e-6, "the stress from forces is that at the walls");
  CHECK(PetscAbsReal(row[COLUMN_VISCOSITY] - none[COLUMN_VISCOSITY]) > 1e-3, "it adds %.4f to the viscosity",
        row[COLUMN_VISCOSITY] - none[COLUMN_VISCOSITY]);
  TestCall(RecordDestroy(&one.record));
  TestCall(RecordDestroy(&half.record));
}

/* A stiff spring is solved in fewer iterations because the preconditioner has it, and with the same result. */
static void CheckStiff(PetscReal k) {
  PointSpring stiff = {.k = k, .P = {0.1, 0.1}};
  Shown with, without;
  Run(large_steps, &stiff, PETSC_TRUE, &with);
  Run(large_steps, &stiff, PETSC_FALSE, &without);
  TestAbout("spring of %g", k);
  CHECK(with.its < without.its, "%d iterations, %d without the preconditioner's part", (int)with.its, (int)without.its);
  CheckBelow(with.energy / without.energy - 1, 1e-4, "energy %.8g with and without", with.energy);
  TestCall(RecordDestroy(&with.record));
  TestCall(RecordDestroy(&without.record));
}

/* The forces' part of a dense block is the matrix of their rates. */
static void CheckDense(const char membrane[]) {
  unsigned state = 3;
  ScopedWorld w;
  TestAbout("%s", membrane);
  TestRunCreate(&w, "%s-vesicle_markers 33 -membrane_derivative spectral -vesicle_bending 0.1 %s", shear, membrane);
  TestCall(SchemeStep(w.scheme, PETSC_MAX_REAL));
  const PetscInt n = 2 * w.layout->n;
  PetscReal *K = TestReals(n * n), *V = TestRandoms(n, &state), *rate = TestReals(n), *product = TestReals(n);
  if (n) TestCall(ForcesDense(w.coupling->forces, 0, 0.3, K));
  TestCall(ForcesRate(w.coupling->forces, 0.3, V, rate));
  for (PetscInt k = 0; k < n; k++) product[k] = TestProduct(n, K + k * n, V); /* K is symmetric */
  CheckBelow(TestFar(n, product, rate) / PetscMax(TestFar(n, rate, NULL), 1e-30), 1e-12,
             "a dense block has the forces' rates");
}

void Facts(void) {
  Shown without;
  CheckDense("");
  CheckDense("-membrane_memory 1");
  CheckDense("-membrane_memory 1 -membrane_law hooke -membrane_stretching 30 -membrane_moment helfrich");
  CheckDense("-membrane_memory 0.5 -membrane_law green -membrane_stretching 30 -membrane_moment angle");
  Run(shear, NULL, PETSC_FALSE, &without);
  CHECK(!without.has_spring, "without the spring there is no column energy_spring");
  CheckSoft(&without, 0.6, 0.2);
  CheckSoft(&without, -0.5, -0.5);
  CheckStiff(10);
  CheckStiff(30);
  TestCall(RecordDestroy(&without.record));
}
