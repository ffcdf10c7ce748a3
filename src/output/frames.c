#include "output/frames.h"
#include "output/cells.h"

/* The ratios of viscosities, unless all are 1. */
static PetscErrorCode FramesPutRatios(H5File *f, Scene scene) {
  const PetscInt n = scene->shape.vesicles;
  PetscReal *ratio;
  PetscFunctionBeginUser;
  if (!SceneHasContrast(scene)) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(n, &ratio));
  for (PetscInt v = 0; v < n; v++) ratio[v] = SceneViscosityRatio(scene, v);
  H5PutReals(f, "vesicle_viscosity_ratio", n, ratio);
  PetscCall(PetscFree(ratio));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The kinds of obstacles, and the markers of obstacles that rest. */
static PetscErrorCode FramesPutObstacles(H5File *f, const SceneObstacles *scene, Obstacles o) {
  PetscReal *X;
  PetscInt *kind;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc2(2 * o->layout->M, &X, o->layout->bodies, &kind));
  ObstaclesCurves(o, 0, X);
  for (PetscInt v = 0; v < o->layout->bodies; v++) kind[v] = o->kind[v].type;
  H5PutInts(f, "obstacle_kind", o->layout->bodies, kind);
  H5PutInts(f, "obstacle_start", o->layout->bodies + 1, o->layout->start);
  if (!scene->moving) H5PutRows(f, "/obstacle/markers", o->layout->M, 2, X);
  PetscCall(PetscFree2(X, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FramesDescribe(Scheme s, H5File *f) {
  const Grid g = s->fluid->grid;
  const Layout l = s->membrane->layout;
  const Scene scene = s->scene;
  PetscFunctionBeginUser;
  H5PutReals(f, "box", 4, scene->fluid.box);
  H5PutInts(f, "cells", 2, g->n);
  H5PutReals(f, "h", 1, &g->h);
  H5PutReals(f, "nu", 1, &scene->fluid.nu);
  H5PutReals(f, "c_b", 1, &scene->membrane.bending);
  H5PutInts(f, "vesicle_start", l->bodies + 1, l->start);
  if (l->bodies) H5PutReals(f, "vesicle_c_b", l->bodies, scene->membrane.each);
  PetscCall(FramesPutRatios(f, scene));
  PetscCall(FramesPutObstacles(f, &scene->obstacles, s->coupling->bodies->obstacles));
  H5PutText(f, "about",
            "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the "
            "disturbance unless -flow_form total; tension k on the edge from marker k-1 to marker k");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The series of this scene, and room for the values of a frame. */
static PetscErrorCode FramesBegin(Frames *f, Scheme s, AppendedKind *kind) {
  const Grid g = s->fluid->grid;
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscInt M = s->membrane->layout->M, W = o ? o->layout->M : 0, n = g->n[0] * g->rows[FIELD_P];
  const PetscBool single = s->scene->output.precision == PRECISION_SINGLE ? PETSC_TRUE : PETSC_FALSE;
  static const char *const fluid[3] = {"/fluid/u", "/fluid/v", "/fluid/p"};
  PetscFunctionBeginUser;
  f->scheme = s;
  *kind = (AppendedKind){.name = "run.h5", .entries = "frames", .scheme = s, .describe = FramesDescribe};
  for (int c = 0; c < 3; c++) AppendedAddSeries(kind, fluid[c], g->n[1], g->n[0], single);
  if (M) AppendedAddSeries(kind, "/vesicle/markers", M, 2, PETSC_FALSE);
  if (M) AppendedAddSeries(kind, "/vesicle/velocity", M, 2, PETSC_FALSE);
  if (M) AppendedAddSeries(kind, "/vesicle/tension", M, 1, PETSC_FALSE);
  if (W) AppendedAddSeries(kind, "/obstacle/force", W, 2, PETSC_FALSE);
  if (s->scene->obstacles.moving) AppendedAddSeries(kind, "/obstacle/markers", W, 2, PETSC_FALSE);
  PetscCall(PetscMalloc4(n, &f->cells[0], n, &f->cells[1], n, &f->cells[2], 2 * W, &f->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesCreate(Frames *f, Folder *folder, Scheme scheme) {
  AppendedKind kind;
  PetscFunctionBeginUser;
  PetscCall(FramesBegin(f, scheme, &kind));
  PetscCall(AppendedCreate(&f->file, folder, &kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesGoOn(Frames *f, Folder *folder, Scheme scheme, PetscInt scheduled, const char restart[]) {
  AppendedKind kind;
  PetscInt length;
  PetscFunctionBeginUser;
  PetscCall(FramesBegin(f, scheme, &kind));
  PetscCall(AppendedOpen(&f->file, folder, &kind, scheduled, &length));
  PetscCall(AppendedGoOn(&f->file, length, scheduled, restart));
  f->scheduled = scheduled;
  if (scheduled) f->time = f->file.time[scheduled - 1];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesWrite(Frames *f, const Gathered *now, PetscBool scheduled) {
  const Scheme s = f->scheme;
  const Obstacles o = s->coupling->bodies->obstacles;
  AppendedFile *file = &f->file;
  PetscInt k = 0;
  PetscFunctionBeginUser;
  file->count = f->scheduled;
  PetscCall(CellFields(s, f->cells[0], f->cells[1], f->cells[2]));
  for (; k < 3; k++)
    PetscCall(H5TransferRows(&file->file, PETSC_TRUE, &(H5Entry){file->kind.path[k], file->count}, s->fluid->grid,
                             FIELD_P, s->fluid->grid->n[0], f->cells[k]));
  for (int part = GATHERED_MARKERS; part <= GATHERED_TENSION; part++)
    if (now->part[part].n) AppendedSet(file, k++, now->part[part].values);
  if (o) {
    ObstaclesOrder(o, now->part[GATHERED_SOLIDS].values, f->solid);
    AppendedSet(file, k++, f->solid);
  }
  if (s->scene->obstacles.moving) {
    ObstaclesCurves(o, s->state.t, f->solid);
    AppendedSet(file, k, f->solid);
  }
  PetscCall(AppendedFlush(file, PETSC_FALSE)); /* values before the time by which readers count them */
  PetscCall(AppendedAdd(file, s->state.t));
  PetscCall(AppendedFlush(file, PETSC_FALSE));
  if (scheduled) f->scheduled = file->count;
  f->time = s->state.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesMarkers(Frames *f, PetscReal **markers) {
  const PetscInt M = f->scheme->membrane->layout->M;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * M * f->file.count, markers));
  for (PetscInt t = 0; t < f->file.count && M; t++)
    PetscCall(H5ReadArray(&f->file.file, "/vesicle/markers", t, 2 * M, *markers + 2 * M * t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesClose(Frames *f, PetscBool *good) {
  PetscFunctionBeginUser;
  PetscCall(AppendedClose(&f->file, good));
  PetscCall(PetscFree4(f->cells[0], f->cells[1], f->cells[2], f->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
