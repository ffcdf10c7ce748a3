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

/* TestScene - the scene of PAPER_MEMBRANE and an options text, which replaces what earlier scenes of the same program
   set. */
static inline PetscErrorCode TestScene(const char options[], Scene *scene) {
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsClear(NULL));
  PetscCall(PetscOptionsInsertString(NULL, PAPER_MEMBRANE));
  PetscCall(PetscOptionsInsertString(NULL, options));
  PetscCall(SceneCreate(PETSC_COMM_WORLD, NULL, NULL, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The membranes of a scene without a fluid. Every rank has all vesicles to itself: the layout is of PETSC_COMM_SELF. */
typedef struct {
  Scene scene;
  Layout layout;
  Membrane membrane;
  PetscInt M; /* markers in all */
} TestMembrane;

/* TestMembraneCreate - from an options text after PAPER_MEMBRANE. */
static inline PetscErrorCode TestMembraneCreate(const char options[], TestMembrane *m) {
  const SceneMembrane *membrane;
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &m->scene));
  membrane = &m->scene->membrane;
  PetscCall(LayoutCreate(PETSC_COMM_SELF, m->scene->shape.vesicles, m->scene->shape.start, NULL, &m->layout));
  PetscCall(MembraneCreate(m->layout, m->scene->shape.X, membrane, &m->membrane));
  m->M = m->layout->M;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestMembraneDestroy(TestMembrane *m) {
  PetscFunctionBeginUser;
  PetscCall(MembraneDestroy(&m->membrane));
  PetscCall(LayoutDestroy(&m->layout));
  PetscCall(SceneDestroy(&m->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
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
} TestWorld;

/* TestWorldBuildFor - all but the scheme, from the scene that is in it, with the settings of the coupling.
   TestWorldBuild - with the scene's kernel and near field alone. */
static inline PetscErrorCode TestWorldBuildFor(const CouplingSetting *setting, TestWorld *w) {
  const Scene s = w->scene;
  PetscScalar *x;
  PetscFunctionBeginUser;
  w->scheme = NULL;
  PetscCall(FluidCreate(&s->fluid, &w->fluid));
  PetscCall(LayoutCreate(s->comm, s->shape.vesicles, s->shape.start, NULL, &w->layout));
  PetscCall(MembraneCreate(w->layout, s->shape.X, &s->membrane, &w->membrane));
  PetscCall(CouplingCreate(w->fluid, w->membrane, NULL, setting, &w->coupling));
  PetscCall(LayoutCreateVec(w->layout, 2, &w->X));
  PetscCall(VecGetArray(w->X, &x));
  PetscCall(PetscArraycpy(x, s->shape.X + 2 * w->layout->first, 2 * w->layout->n));
  PetscCall(VecRestoreArray(w->X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestWorldBuild(TestWorld *w) {
  const SceneCoupling *c = &w->scene->coupling;
  const CouplingSetting setting = {
      .mobility = {.kernel = c->kernel, .near = (NearFieldType)c->near_field, .solver = !SceneIsProjection(w->scene)}};
  PetscFunctionBeginUser;
  PetscCall(TestWorldBuildFor(&setting, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestFieldVecs - vectors of a field of the grid, TestMarkerVecs - of `each` numbers a marker; as TestVecs makes them.
 */
static inline PetscErrorCode TestFieldVecs(DM dm, ...) {
  va_list list;
  Vec x;
  PetscFunctionBeginUser;
  va_start(list, dm);
  PetscCall(DMCreateGlobalVector(dm, &x));
  PetscCall(TestVecsLike(x, list));
  va_end(list);
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestMarkerVecs(Layout layout, PetscInt each, ...) {
  va_list list;
  Vec x;
  PetscFunctionBeginUser;
  va_start(list, each);
  PetscCall(LayoutCreateVec(layout, each, &x));
  PetscCall(TestVecsLike(x, list));
  va_end(list);
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestFill - entry (i, j) of the fields first .. last of x, a velocity (FIELD_U to FIELD_V) or a pressure, becomes
   value(ctx, field, i, j), j counting the rows of all ranks. Not collective. */
typedef PetscReal TestValue(const void *ctx, Field field, PetscInt i, PetscInt j);
static inline PetscErrorCode TestFill(Grid g, Field first, Field last, TestValue value, const void *ctx, Vec x) {
  PetscScalar *a;
  PetscFunctionBeginUser;
  PetscCall(VecGetArray(x, &a));
  for (int f = first; f <= (int)last; f++)
    for (PetscInt j = 0; j < g->rows[f]; j++)
      for (PetscInt i = 0; i < g->columns[f]; i++)
        a[GridRowStart(g, (Field)f, j) + i] = value(ctx, (Field)f, i, j + g->first);
  PetscCall(VecRestoreArray(x, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestBox - a fluid without vesicles and its Stokes solve, from an options text after PAPER_MEMBRANE. */
typedef struct {
  Scene scene;
  Fluid fluid;
  Stokes stokes;
} TestBox;

static inline PetscErrorCode TestBoxCreate(const char options[], TestBox *b) {
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &b->scene));
  PetscCall(FluidCreate(&b->scene->fluid, &b->fluid));
  PetscCall(StokesCreate(b->fluid, &b->stokes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestBoxDestroy(TestBox *b) {
  PetscFunctionBeginUser;
  PetscCall(StokesDestroy(&b->stokes));
  PetscCall(FluidDestroy(&b->fluid));
  PetscCall(SceneDestroy(&b->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldPlace - the coupling at the initial markers for the time coefficient a0. */
static inline PetscErrorCode TestWorldPlace(PetscReal a0, TestWorld *w) {
  char message[PETVES_MAX_MESSAGE];
  PetscFunctionBeginUser;
  PetscCall(CouplingPlace(w->coupling, a0, (Instant){0}, w->X, NULL, message));
  PetscCheck(!*message, w->scene->comm, PETSC_ERR_LIB, "%s", message);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldRespond - U = E A^-1 E^T F/h^2 of marker forces F, A^-1 the Stokes solve, and with `near` + C F. Collective.
 */
static inline PetscErrorCode TestWorldRespond(TestWorld *t, Stokes stokes, PetscBool near, Vec F, Vec U) {
  const Grid g = t->fluid->grid;
  const PetscScalar *f;
  PetscScalar *u;
  Vec w, p;
  PetscFunctionBeginUser;
  PetscCall(DMGetGlobalVector(g->velocity, &w));
  PetscCall(DMGetGlobalVector(g->da[FIELD_P], &p));
  PetscCall(VecSet(w, 0));
  PetscCall(MarkersSpread(t->coupling->markers, 1 / PetscSqr(g->h), F, w));
  PetscCall(StokesSolve(stokes, w, NULL, w, p));
  PetscCall(MarkersInterpolate(t->coupling->markers, w, U));
  PetscCall(VecGetArrayRead(F, &f));
  PetscCall(VecGetArray(U, &u));
  if (near) PetscCall(NearFieldApply(t->coupling->mobility->near, 1, f, u));
  PetscCall(VecRestoreArray(U, &u));
  PetscCall(VecRestoreArrayRead(F, &f));
  PetscCall(DMRestoreGlobalVector(g->da[FIELD_P], &p));
  PetscCall(DMRestoreGlobalVector(g->velocity, &w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldShare - x[n] of the first vesicle's owner to every rank. Collective. */
static inline PetscErrorCode TestWorldShare(TestWorld *w, PetscMPIInt n, PetscReal x[]) {
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(x, n, MPIU_REAL, LayoutOwner(w->layout, 0), w->scene->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldScheme - the scheme, at its initial state. */
static inline PetscErrorCode TestWorldScheme(TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(BaselinesRegister());
  PetscCall(SchemeCreate(w->scene, w->coupling, w->scene->shape.X, &w->scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldCreate - placed, for the first step's a0, without a scheme; TestRunCreate - with a scheme, which places:
   from an options text after PAPER_MEMBRANE. */
static inline PetscErrorCode TestWorldCreate(const char options[], TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &w->scene));
  PetscCall(TestWorldBuild(w));
  PetscCall(TestWorldPlace(w->fluid->a0, w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestRunCreate(const char options[], TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &w->scene));
  PetscCall(TestWorldBuild(w));
  PetscCall(TestWorldScheme(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestWorldDestroy(TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(SchemeDestroy(&w->scheme));
  PetscCall(VecDestroy(&w->X));
  PetscCall(CouplingDestroy(&w->coupling));
  PetscCall(MembraneDestroy(&w->membrane));
  PetscCall(LayoutDestroy(&w->layout));
  PetscCall(FluidDestroy(&w->fluid));
  PetscCall(SceneDestroy(&w->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
