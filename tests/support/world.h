/* A scene and what is made from it, from an options text: what C tests and benches start from. */
#pragma once
#include "check.h"
#include "baselines/baselines.h"
#include "fluid/stokes/stokes.h"
#include "scheme/scheme.h"

/* The paper's discretisation of the membrane and its model of the fluid, which tests start from: options given after
   it win. */
#define PAPER_MEMBRANE                                                                                                 \
  "-delta_type ib6 -membrane_derivative fd -coupling_near_field none "                                                 \
  "-fluid_inertia unsteady "

/* What scenes of tests have in common. */
#define CHANNEL "-domain_bc_x periodic "
#define PERIODIC "-domain_bc_x periodic -domain_bc_y periodic "
#define SQUARE "-domain_box -1,1,-1,1 -domain_cells 48,48 "
#define OBLONG "-domain_box -1,1,-1,1.1860465116279069 -domain_cells 43,47 "
#define EXACT "-coupling_near_field exact -membrane_derivative spectral -vesicle_allow_close_markers "

/* TestScene - the scene of PAPER_MEMBRANE and an options text, which replaces what earlier scenes of the same program
   set. The text of this and of what else is made from one is a format, as that of printf. */
#define TestScene(scene, ...) TestSceneOf(scene, TestText(__VA_ARGS__))
static inline void TestSceneOf(Scene *scene, const char options[]) {
  TestCall(PetscOptionsClear(NULL));
  TestCall(PetscOptionsInsertString(NULL, PAPER_MEMBRANE));
  TestCall(PetscOptionsInsertString(NULL, options));
  TestCall(SceneCreate(PETSC_COMM_WORLD, NULL, NULL, scene));
}

/* The membranes of a scene without a fluid. Every rank has all vesicles to itself: the layout is of PETSC_COMM_SELF. */
typedef struct {
  Scene scene;
  Layout layout;
  Membrane membrane;
  PetscInt M; /* markers in all */
} TestMembrane;

/* TestMembraneCreate - from an options text after PAPER_MEMBRANE. */
#define TestMembraneCreate(m, ...) TestMembraneOf(m, TestText(__VA_ARGS__))
static inline void TestMembraneOf(TestMembrane *m, const char options[]) {
  TestSceneOf(&m->scene, options);
  TestCall(LayoutCreate(PETSC_COMM_SELF, m->scene->shape.vesicles, m->scene->shape.start, NULL, &m->layout));
  TestCall(MembraneCreate(m->layout, m->scene->shape.X, &m->scene->membrane, &m->membrane));
  m->M = m->layout->M;
}

/* Scoped - what the end of its block destroys. */
#define ScopedMembrane __attribute__((cleanup(TestMembraneDestroy))) TestMembrane
#define ScopedWorld __attribute__((cleanup(TestWorldDestroy))) TestWorld

static inline void TestMembraneDestroy(TestMembrane *m) {
  TestCall(MembraneDestroy(&m->membrane));
  TestCall(LayoutDestroy(&m->layout));
  TestCall(SceneDestroy(&m->scene));
}

/* A fluid and the membranes in it, none without vesicles; no files. */
typedef struct {
  Scene scene;
  Fluid fluid;
  Layout layout;
  Membrane membrane;
  Coupling coupling;
  Vec X;         /* the initial markers */
  Scheme scheme; /* NULL: none made */
  Stokes stokes; /* NULL: not asked for */
} TestWorld;

/* TestWorldBuildFor - all but the scheme, from the scene that is in it, with the settings of the coupling.
   TestWorldBuild - with the scene's kernel and near field alone. */
static inline void TestWorldBuildFor(const CouplingSetting *setting, TestWorld *w) {
  const Scene s = w->scene;
  w->scheme = NULL;
  w->stokes = NULL;
  TestCall(FluidCreate(&s->fluid, &w->fluid));
  TestCall(LayoutCreate(s->comm, s->shape.vesicles, s->shape.start, NULL, &w->layout));
  TestCall(MembraneCreate(w->layout, s->shape.X, &s->membrane, &w->membrane));
  TestCall(CouplingCreate(w->fluid, w->membrane, NULL, setting, &w->coupling));
  TestCall(LayoutCreateVec(w->layout, 2, &w->X));
  PetscScalar *x = TestArray(w->X);
  TestCall(PetscArraycpy(x, s->shape.X + 2 * w->layout->first, 2 * w->layout->n));
}

static inline void TestWorldBuild(TestWorld *w) {
  const SceneCoupling *c = &w->scene->coupling;
  const CouplingSetting setting = {
      .mobility = {.kernel = c->kernel, .near = (NearFieldType)c->near_field, .solver = !SceneIsProjection(w->scene)}};
  TestWorldBuildFor(&setting, w);
}

/* TestFieldVecs - vectors of a field of the grid, TestMarkerVecs - of `each` numbers a marker; as TestVecs makes them.
 */
static inline void TestFieldVecs(DM dm, ...) {
  va_list list;
  Vec x;
  va_start(list, dm);
  TestCall(DMCreateGlobalVector(dm, &x));
  TestVecsLike(x, list);
  va_end(list);
  TestCall(VecDestroy(&x));
}

static inline void TestMarkerVecs(Layout layout, PetscInt each, ...) {
  va_list list;
  Vec x;
  va_start(list, each);
  TestCall(LayoutCreateVec(layout, each, &x));
  TestVecsLike(x, list);
  va_end(list);
  TestCall(VecDestroy(&x));
}

/* TestFill - entries of the fields first .. last of x, a velocity (FIELD_U to FIELD_V) or a pressure, become
   value(ctx, field, place). Not collective. */
typedef PetscReal TestValue(const void *ctx, Field field, const PetscReal X[2]);
static inline void TestFill(Grid g, Field first, Field last, TestValue value, const void *ctx, Vec x) {
  PetscScalar *a = TestArray(x);
  PetscReal X[2];
  for (int f = first; f <= (int)last; f++)
    for (PetscInt k = 0; k < g->rows[f] * g->columns[f]; k++) {
      GridPosition(g, (Field)f, k % g->columns[f], k / g->columns[f] + g->first, X);
      a[GridRowStart(g, (Field)f, 0) + k] = value(ctx, (Field)f, X);
    }
}

/* TestWeight - phi(x) of a kernel: the weight at grid point 0 of a marker at x (cells). */
static inline PetscReal TestWeight(KernelWeights weights, PetscReal x) {
  PetscReal w[KERNEL_MAX_POINTS];
  PetscInt first;
  const PetscInt n = weights(x, &first, w);
  return first <= 0 && -first < n ? w[-first] : 0;
}

/* TestWorldPlace - the coupling at the initial markers for the time coefficient a0. */
static inline void TestWorldPlace(PetscReal a0, TestWorld *w) {
  char message[PETVES_MAX_MESSAGE];
  TestCall(CouplingPlace(w->coupling, a0, (Instant){0}, w->X, NULL, message));
  PetscCheckAbort(!*message, w->scene->comm, PETSC_ERR_LIB, "%s", message);
}

/* TestWorldStokes - the Stokes solve of the world's fluid, made when it is first asked for. */
static inline Stokes TestWorldStokes(TestWorld *w) {
  if (!w->stokes) TestCall(StokesCreate(w->fluid, &w->stokes));
  return w->stokes;
}

/* TestWorldRespond - U = E A^-1 E^T F/h^2 of marker forces F, A^-1 the Stokes solve, and with `near` + C F. Collective.
 */
static inline void TestWorldRespond(TestWorld *t, PetscBool near, Vec F, Vec U) {
  const Grid g = t->fluid->grid;
  Vec w, p;
  TestCall(DMGetGlobalVector(g->velocity, &w));
  TestCall(DMGetGlobalVector(g->da[FIELD_P], &p));
  TestCall(VecSet(w, 0));
  TestCall(MarkersSpread(t->coupling->markers, 1 / PetscSqr(g->h), F, w));
  TestCall(StokesSolve(TestWorldStokes(t), w, NULL, w, p));
  TestCall(MarkersInterpolate(t->coupling->markers, w, U));
  const PetscScalar *f = TestArray(F);
  PetscScalar *u = TestArray(U);
  if (near) TestCall(NearFieldApply(t->coupling->mobility->near, 1, f, u));
  TestCall(DMRestoreGlobalVector(g->da[FIELD_P], &p));
  TestCall(DMRestoreGlobalVector(g->velocity, &w));
}

/* TestWorldScheme - the scheme, at its initial state. */
static inline void TestWorldScheme(TestWorld *w) {
  TestCall(BaselinesRegister());
  TestCall(SchemeCreate(w->scene, w->coupling, w->scene->shape.X, &w->scheme));
}

/* TestWorldCreate - placed, for the first step's a0, without a scheme; TestRunCreate - with a scheme, which places:
   from an options text after PAPER_MEMBRANE. */
#define TestWorldCreate(w, ...) TestWorldOf(w, TestText(__VA_ARGS__), PETSC_FALSE)
#define TestRunCreate(w, ...) TestWorldOf(w, TestText(__VA_ARGS__), PETSC_TRUE)
static inline void TestWorldOf(TestWorld *w, const char options[], PetscBool scheme) {
  TestSceneOf(&w->scene, options);
  TestWorldBuild(w);
  if (scheme)
    TestWorldScheme(w);
  else
    TestWorldPlace(w->fluid->a0, w);
}

static inline void TestWorldDestroy(TestWorld *w) {
  TestCall(SchemeDestroy(&w->scheme));
  TestCall(StokesDestroy(&w->stokes));
  TestCall(VecDestroy(&w->X));
  TestCall(CouplingDestroy(&w->coupling));
  TestCall(MembraneDestroy(&w->membrane));
  TestCall(LayoutDestroy(&w->layout));
  TestCall(FluidDestroy(&w->fluid));
  TestCall(SceneDestroy(&w->scene));
}

/* TestStokeslet - the velocity `response` at the offset (x, y) of a unit force along `source`, nu = 1. */
static inline PetscReal TestStokeslet(int source, int response, PetscReal x, PetscReal y) {
  const PetscReal r2 = x * x + y * y, d[2] = {x, y};
  return ((source == response ? -0.5 * PetscLogReal(r2) : 0) + d[source] * d[response] / r2) / (4 * PETSC_PI);
}
