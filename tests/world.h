/* A scene and what is made from it, from an options text: what C tests and benches start from. */
#pragma once
#include "check.h"
#include "scheme/scheme.h"

/* The paper's discretisation of the membrane and its model of the fluid, which tests start from: options given after
   it win. */
#define PAPER_MEMBRANE                                                                                                 \
  "-delta_type ib6 -membrane_derivative fd -coupling_self_mobility none -scheme_area_target false "                    \
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

/* A fluid and (coupling and X NULL without vesicles) membranes in it; no files. */
typedef struct {
  Scene scene;
  Fluid fluid;
  Membrane membrane;
  Coupling coupling;
  Vec X;         /* the initial markers */
  Scheme scheme; /* NULL: none made */
} TestWorld;

/* TestWorldBuild - all but the scheme, from the scene that is in it. */
static inline PetscErrorCode TestWorldBuild(TestWorld *w) {
  const SceneMembrane *membrane = &w->scene->membrane;
  PetscScalar *x;
  PetscFunctionBeginUser;
  PetscCall(FluidCreate(&w->scene->fluid, &w->fluid));
  PetscCall(MembraneCreate(&w->scene->shape, membrane->bending, (DerivativeType)membrane->derivative, &w->membrane));
  w->scheme = NULL;
  w->coupling = NULL;
  w->X = NULL;
  if (!w->scene->shape.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CouplingCreate(w->fluid->grid, w->membrane, w->scene->coupling.kernel, &w->coupling));
  PetscCall(MembraneCreateMarkerVec(w->membrane, &w->X));
  PetscCall(VecGetArray(w->X, &x));
  PetscCall(PetscArraycpy(x, w->scene->shape.X, 2 * w->membrane->M));
  PetscCall(VecRestoreArray(w->X, &x));
  PetscCall(CouplingSetMarkers(w->coupling, w->X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldScheme - the scheme, at its initial state. */
static inline PetscErrorCode TestWorldScheme(TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(SchemeCreate(w->scene, w->fluid, w->membrane, w->coupling, w->scene->shape.X, &w->scheme));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* TestWorldCreate - without a scheme; TestRunCreate - with it: from an options text after PAPER_MEMBRANE. */
static inline PetscErrorCode TestWorldCreate(const char options[], TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(TestScene(options, &w->scene));
  PetscCall(TestWorldBuild(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestRunCreate(const char options[], TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(TestWorldCreate(options, w));
  PetscCall(TestWorldScheme(w));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static inline PetscErrorCode TestWorldDestroy(TestWorld *w) {
  PetscFunctionBeginUser;
  PetscCall(SchemeDestroy(&w->scheme));
  PetscCall(VecDestroy(&w->X));
  PetscCall(CouplingDestroy(&w->coupling));
  PetscCall(MembraneDestroy(&w->membrane));
  PetscCall(FluidDestroy(&w->fluid));
  PetscCall(SceneDestroy(&w->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}
