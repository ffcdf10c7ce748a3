#include "output/framefile.h"

const char *const FrameSeries[FRAME_SERIES] = {"/fluid/u",         "/fluid/v",          "/fluid/p",
                                               "/vesicle/markers", "/vesicle/velocity", "/vesicle/tension",
                                               "/obstacle/force",  "/obstacle/markers"};
static const char *const SolidsAlone[] = {"/fluid/u", "/fluid/v", "/fluid/p", "/obstacle/force", "/obstacle/markers"};

static PetscInt Obstacle(Scheme s) {
  return s->coupling->bodies->obstacles ? s->coupling->bodies->obstacles->layout->M : 0;
}

/* Fills `kind` with the series of this scene, and what an entry of each is: dims[2] numbers. */
static void ListSeries(Scheme s, GrowingKind *kind, PetscInt dims[][2]) {
  const Grid g = s->fluid->grid;
  const PetscInt M = s->membrane->layout->M, W = Obstacle(s);
  kind->path = M ? FrameSeries : SolidsAlone;
  kind->series = FRAME_VESICLES + (M ? 3 : 0) + (W ? 1 : 0) + (s->scene->obstacles.moving ? 1 : 0);
  for (PetscInt k = 0; k < kind->series; k++) {
    const PetscBool fluid = k < FRAME_VESICLES ? PETSC_TRUE : PETSC_FALSE;
    const PetscBool solid = k >= FRAME_VESICLES + (M ? 3 : 0) ? PETSC_TRUE : PETSC_FALSE;
    dims[k][0] = fluid ? g->n[1] : solid ? W : M;
    dims[k][1] = fluid ? g->n[0] : !solid && k == FRAME_FORCE - 1 ? 1 : 2;
    kind->entries[k] = dims[k][0] * dims[k][1];
    kind->single[k] = fluid && s->scene->output.precision == PRECISION_SINGLE ? PETSC_TRUE : PETSC_FALSE;
  }
}

/* The ratios of viscosities, where they are not all 1. */
static PetscErrorCode PutRatios(H5File *f, Scene scene) {
  const PetscInt n = scene->shape.vesicles;
  PetscReal *ratio;
  PetscFunctionBeginUser;
  if (!SceneHasContrast(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &ratio));
  for (PetscInt v = 0; v < n; v++) ratio[v] = SceneViscosityRatio(scene, v);
  PetscCall(H5PutReals(f, "vesicle_viscosity_ratio", n, ratio));
  PetscCall(PetscFree(ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The curves of solids, where they stay where they are. */
static PetscErrorCode PutObstacles(H5File *f, const SceneObstacles *scene, Obstacles o) {
  PetscReal *X;
  PetscInt *kind;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(2 * o->layout->M, &X, o->layout->bodies, &kind));
  ObstaclesCurves(o, 0, X);
  for (PetscInt v = 0; v < o->layout->bodies; v++) kind[v] = o->kind[v].type;
  PetscCall(H5PutInts(f, "obstacle_kind", o->layout->bodies, kind));
  PetscCall(H5PutInts(f, "obstacle_start", o->layout->bodies + 1, o->layout->start));
  if (!scene->moving) PetscCall(H5PutRows(f, "/obstacle/markers", o->layout->M, 2, X));
  PetscCall(PetscFree2(X, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(Scheme s, const char path[], H5File *f) {
  const Grid g = s->fluid->grid;
  const Layout l = s->membrane->layout;
  const Scene scene = s->scene;
  GrowingKind kind;
  PetscInt dims[FRAME_SERIES][2];
  PetscFunctionBeginUser;
  ListSeries(s, &kind, dims);
  PetscCall(H5FileCreate(scene->comm, path, f));
  PetscCall(H5PutReals(f, "box", 4, scene->fluid.box));
  PetscCall(H5PutInts(f, "cells", 2, g->n));
  PetscCall(H5PutReals(f, "h", 1, &g->h));
  PetscCall(H5PutReals(f, "nu", 1, &scene->fluid.nu));
  PetscCall(H5PutReals(f, "c_b", 1, &scene->membrane.bending));
  PetscCall(H5PutInts(f, "vesicle_start", l->bodies + 1, l->start));
  if (l->bodies) PetscCall(H5PutReals(f, "vesicle_c_b", l->bodies, scene->membrane.each));
  PetscCall(PutRatios(f, scene));
  PetscCall(PutObstacles(f, &scene->obstacles, s->coupling->bodies->obstacles));
  PetscCall(H5PutString(f, "about",
                        "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the "
                        "disturbance unless -flow_form total; tension k on the edge from marker k-1 to marker k"));
  PetscCall(H5CreateSeries(f, "/time", 0, NULL));
  for (PetscInt k = 0; k < kind.series; k++)
    PetscCall(
        (kind.single[k] ? H5CreateSingleSeries : H5CreateSeries)(f, kind.path[k], dims[k][1] > 1 ? 2 : 1, dims[k]));
  PetscCall(H5FileFlush(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrameKind(Scheme s, GrowingKind *kind) {
  PetscInt dims[FRAME_SERIES][2];
  PetscFunctionBeginUser;
  kind->name = "run.h5";
  ListSeries(s, kind, dims);
  kind->scheme = s;
  kind->create = Create;
  PetscFunctionReturn(PETSC_SUCCESS);
}
