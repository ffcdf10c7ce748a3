#include "output/framefile.h"

const char *const FrameSeries[FRAME_SERIES] = {"/fluid/u",         "/fluid/v",          "/fluid/p",
                                               "/vesicle/markers", "/vesicle/velocity", "/vesicle/tension"};

static PetscInt Count(Scheme s) {
  return s->membrane->layout->M ? FRAME_SERIES : 3;
}

/* Whether series k is in single precision. */
static PetscBool IsSingle(Scheme s, PetscInt k) {
  return k < 3 && s->scene->output.precision == PRECISION_SINGLE ? PETSC_TRUE : PETSC_FALSE;
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

/* The curves of solids, which stay where they are. */
static PetscErrorCode PutObstacles(H5File *f, Obstacles o) {
  PetscReal *X;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * o->layout->M, &X));
  ObstaclesCurves(o, X);
  PetscCall(H5PutInts(f, "obstacle_start", o->layout->bodies + 1, o->layout->start));
  PetscCall(H5PutRows(f, "/obstacle/markers", o->layout->M, 2, X));
  PetscCall(PetscFree(X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Create(Scheme s, const char path[], H5File *f) {
  const Grid g = s->fluid->grid;
  const Layout l = s->membrane->layout;
  const Scene scene = s->scene;
  const PetscInt cells[2] = {g->n[1], g->n[0]}, markers[2] = {l->M, 2};
  PetscFunctionBeginUser;
  PetscCall(H5FileCreate(scene->comm, path, f));
  PetscCall(H5PutReals(f, "box", 4, scene->fluid.box));
  PetscCall(H5PutInts(f, "cells", 2, g->n));
  PetscCall(H5PutReals(f, "h", 1, &g->h));
  PetscCall(H5PutReals(f, "nu", 1, &scene->fluid.nu));
  PetscCall(H5PutReals(f, "c_b", 1, &scene->membrane.bending));
  PetscCall(H5PutInts(f, "vesicle_start", l->bodies + 1, l->start));
  if (l->bodies) PetscCall(H5PutReals(f, "vesicle_c_b", l->bodies, scene->membrane.each));
  PetscCall(PutRatios(f, scene));
  PetscCall(PutObstacles(f, s->coupling->bodies->obstacles));
  PetscCall(H5PutString(f, "about",
                        "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the "
                        "disturbance unless -flow_form total; tension k on the edge from marker k-1 to marker k"));
  PetscCall(H5CreateSeries(f, "/time", 0, NULL));
  for (int k = 0; k < Count(s); k++)
    PetscCall((IsSingle(s, k) ? H5CreateSingleSeries : H5CreateSeries)(f, FrameSeries[k], k < 5 ? 2 : 1,
                                                                       k < 3 ? cells : markers));
  PetscCall(H5FileFlush(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FrameKind(Scheme s, GrowingKind *kind) {
  const Grid g = s->fluid->grid;
  PetscFunctionBeginUser;
  kind->name = "run.h5";
  kind->series = Count(s);
  kind->path = FrameSeries;
  for (PetscInt k = 0; k < kind->series; k++) {
    kind->entries[k] = k < 3 ? g->n[0] * g->n[1] : s->membrane->layout->M * (k < 5 ? 2 : 1);
    kind->single[k] = IsSingle(s, k);
  }
  kind->scheme = s;
  kind->create = Create;
  PetscFunctionReturn(PETSC_SUCCESS);
}
