#include "output/frames.h"
#include "output/cells.h"
#include "base/version.h"

#define ABOUT                                                                                                          \
  "u, v: velocity (background included) at cell centres; p: pressure at cell centres, of the disturbance (without "    \
  "that of the background flow) unless -flow_form total; tension k "

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

/* The lines through the markers of all bodies of a kind as cells of VTK, and their numbers from 1 on: of each body the
   type of a line of many points, how many, and the points, of which the first comes again where it is closed. */
static PetscErrorCode FramesPutLines(H5File *f, Layout l, const CurveKind kind[], const char lines[],
                                     const char number[]) {
  enum { POLYLINE = 2 };
  PetscInt *list, n = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(l->M + 3 * l->bodies, &list));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt closed = !kind || kind[v].type == CURVE_CLOSED;
    list[n++] = POLYLINE;
    list[n++] = LayoutCount(l, v) + closed;
    for (PetscInt k = l->start[v]; k < l->start[v + 1]; k++) list[n++] = k;
    if (closed) list[n++] = l->start[v];
  }
  H5PutWhole(f, lines, n, list);
  for (PetscInt v = 0; v < l->bodies; v++) list[v] = v + 1;
  H5PutWhole(f, number, l->bodies, list);
  PetscCall(PetscFree(list));
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
  PetscCall(FramesPutLines(f, o->layout, o->kind, "/obstacle/lines", "/obstacle/number"));
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
  if (l->bodies) PetscCall(FramesPutLines(f, l, NULL, "/vesicle/lines", "/vesicle/number"));
  PetscCall(FramesPutRatios(f, scene));
  PetscCall(FramesPutObstacles(f, &scene->obstacles, s->coupling->bodies->obstacles));
  H5PutText(f, "version", PETVES_VERSION);
  H5PutText(f, "git_commit", PetvesCommit());
  H5PutText(f, "about",
            scene->membrane.derivative == DERIVATIVE_SPECTRAL ? ABOUT "at marker k"
                                                              : ABOUT "on the edge from marker k-1 to marker k");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool FramesAreWrapped(Scheme s) {
  const Grid g = s->fluid->grid;
  return !g->free && !(g->wall[0] && g->wall[1]) ? PETSC_TRUE : PETSC_FALSE;
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
  if (M && FramesAreWrapped(s)) AppendedAddSeries(kind, "/vesicle/wrapped", M, 2, PETSC_FALSE);
  if (s->scene->obstacles.moving && FramesAreWrapped(s))
    AppendedAddSeries(kind, "/obstacle/wrapped", W, 2, PETSC_FALSE);
  PetscCall(PetscMalloc5(n, &f->cells[0], n, &f->cells[1], n, &f->cells[2], 2 * M, &f->wrapped, 2 * W, &f->solid));
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

/* Shift n markers by whole periods, so that the middle of the places X[2n] is in the box. */
static void ShiftIntoBox(Grid g, PetscInt n, const PetscReal X[], PetscInt markers, PetscReal shifted[]) {
  for (int d = 0; d < 2; d++) {
    const PetscReal period = g->hi[d] - g->lo[d];
    PetscReal middle = 0;
    for (PetscInt k = 0; k < n; k++) middle += X[2 * k + d] / n;
    for (PetscInt k = 0; k < markers && !g->wall[d]; k++)
      shifted[2 * k + d] -= period * PetscFloorReal((middle - g->lo[d]) / period);
  }
}

/* The markers by whole periods in the box, from series k on; f->solid has those of obstacles where they move. */
static PetscErrorCode FramesSetWrapped(Frames *f, const Gathered *now, PetscInt k) {
  const Scheme s = f->scheme;
  const Layout l = s->membrane->layout;
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscReal *X = now->part[GATHERED_MARKERS].values;
  PetscFunctionBeginUser;
  PetscCall(PetscArraycpy(f->wrapped, X, 2 * l->M));
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt at = 2 * l->start[v], n = LayoutCount(l, v);
    ShiftIntoBox(s->fluid->grid, n, X + at, n, f->wrapped + at);
  }
  if (l->M) AppendedSet(&f->file, k++, f->wrapped);
  if (!s->scene->obstacles.moving) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt v = 0; v < o->layout->bodies; v++) {
    const BodyPose pose = MotionPose(&o->motion[v], s->state.t);
    if (o->motion[v].carried)
      ShiftIntoBox(s->fluid->grid, 1, pose.center, LayoutCount(o->layout, v), f->solid + 2 * o->layout->start[v]);
  }
  AppendedSet(&f->file, k, f->solid);
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
    AppendedSet(file, k++, f->solid);
  }
  if (FramesAreWrapped(s)) PetscCall(FramesSetWrapped(f, now, k));
  PetscCall(AppendedFlush(file, PETSC_FALSE)); /* values before the time by which readers count them */
  PetscCall(AppendedAdd(file, s->state.t));
  PetscCall(AppendedFlush(file, PETSC_FALSE));
  if (scheduled) f->scheduled = file->count;
  f->time = s->state.t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FramesClose(Frames *f, PetscBool *good) {
  PetscFunctionBeginUser;
  PetscCall(AppendedClose(&f->file, good));
  PetscCall(PetscFree5(f->cells[0], f->cells[1], f->cells[2], f->wrapped, f->solid));
  PetscFunctionReturn(PETSC_SUCCESS);
}
