/* Frames of run.h5: what a state in the plane is at a saved time. Each rank sends its rows of the fluid's fields to
   rank 0; markers are on every rank. */
#include "base/version.h"
#include "plane/cells.h"
#include "plane/gathered.h"
#include "plane/plane.h"
#include "scheme/pressuredrop.h"

#define ABOUT                                                                                                          \
  "u, v: velocity (background included) at cell centres; p: pressure at cell centres, without its mean gradient "      \
  "along x, which is pressure_gradient; tension k "

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
  H5PutRows(f, lines, H5_INT, n, 0, list);
  for (PetscInt v = 0; v < l->bodies; v++) list[v] = v + 1;
  H5PutRows(f, number, H5_INT, l->bodies, 0, list);
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
  ObstaclesCurves(o, (Instant){0}, X);
  for (PetscInt v = 0; v < o->layout->bodies; v++) kind[v] = o->kind[v].type;
  H5Put(f, "obstacle_kind", H5_INT, o->layout->bodies, kind);
  H5Put(f, "obstacle_start", H5_INT, o->layout->bodies + 1, o->layout->start);
  if (!SceneObstaclesMove(scene)) {
    H5PutRows(f, "/obstacle/markers", H5_REAL, o->layout->M, 2, X);
    H5PutUnit(f, "/obstacle/markers", "length");
  }
  PetscCall(FramesPutLines(f, o->layout, o->kind, "/obstacle/lines", "/obstacle/number"));
  PetscCall(PetscFree2(X, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PlaneDescribe(const void *plane, H5File *f) {
  const Scheme s = ((Plane)plane)->scheme;
  const Grid g = s->fluid->grid;
  const Layout l = s->membrane->layout;
  const Scene scene = s->scene;
  PetscFunctionBeginUser;
  H5Put(f, "box", H5_REAL, 4, scene->fluid.box);
  H5Put(f, "cells", H5_INT, 2, g->n);
  H5Put(f, "h", H5_REAL, 1, &g->h);
  H5Put(f, "nu", H5_REAL, 1, &scene->fluid.nu);
  H5Put(f, "c_b", H5_REAL, 1, &scene->membrane.bending);
  for (int d = 0; d < 2; d++) {
    PetscReal *x;
    PetscCall(PetscMalloc1(g->n[d], &x));
    for (PetscInt i = 0; i < g->n[d]; i++) x[i] = g->lo[d] + (i + 0.5) * g->h;
    H5PutRows(f, d ? "/fluid/y" : "/fluid/x", H5_REAL, g->n[d], 0, x);
    H5PutUnit(f, d ? "/fluid/y" : "/fluid/x", "length");
    PetscCall(PetscFree(x));
  }
  H5Put(f, "vesicle_start", H5_INT, l->bodies + 1, l->start);
  if (l->bodies) {
    PetscReal *each;
    PetscCall(PetscMalloc1(l->bodies, &each));
    for (PetscInt v = 0; v < l->bodies; v++) each[v] = scene->membrane.material[v].bending;
    H5Put(f, "vesicle_c_b", H5_REAL, l->bodies, each);
    for (PetscInt v = 0; v < l->bodies; v++) each[v] = SceneViscosityRatio(scene, v);
    if (SceneHasContrast(scene)) H5Put(f, "vesicle_viscosity_ratio", H5_REAL, l->bodies, each);
    PetscCall(PetscFree(each));
    PetscCall(FramesPutLines(f, l, NULL, "/vesicle/lines", "/vesicle/number"));
  }
  PetscCall(FramesPutObstacles(f, &scene->obstacles, s->coupling->bodies->obstacles));
  H5PutText(f, "version", PETVES_VERSION);
  H5PutText(f, "git_commit", PetvesCommit());
  H5PutText(f, "about",
            scene->membrane.derivative == DERIVATIVE_SPECTRAL ? ABOUT "at marker k"
                                                              : ABOUT "on the edge from marker k-1 to marker k");
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscBool PlaneIsWrapped(Scheme s) {
  const Grid g = s->fluid->grid;
  return !g->free && !(g->wall[0] && g->wall[1]);
}

PetscErrorCode PlaneSeries(void *plane, AppendedKind *kind) {
  const Plane p = plane;
  const Scheme s = p->scheme;
  const Grid g = s->fluid->grid;
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscInt M = s->membrane->layout->M, W = o ? o->layout->M : 0,
                 moving = SceneObstaclesMove(&s->scene->obstacles) ? W : 0, n = g->n[0] * g->rows[FIELD_P],
                 tracers = p->tracers.n;
  const PetscBool single = s->scene->output.precision == PRECISION_SINGLE;
  const AppendedSeries all[] = {{"/fluid/u", g->n[1], g->n[0], single, "length/time"},
                                {"/fluid/v", g->n[1], g->n[0], single, "length/time"},
                                {"/fluid/p", g->n[1], g->n[0], single, "length^2/time^2"},
                                {"/vesicle/markers", M, 2, .unit = "length"},
                                {"/vesicle/velocity", M, 2, .unit = "length/time"},
                                {"/vesicle/tension", M, 1, .unit = "length^3/time^2"},
                                {"/obstacle/force", W, 2, .unit = "length^3/time^2"},
                                {"/vesicle/stretch", s->membrane->stretches ? M : 0, 1, .unit = "1"},
                                {"/obstacle/markers", moving, 2, .unit = "length"},
                                {"/vesicle/wrapped", PlaneIsWrapped(s) ? M : 0, 2, .unit = "length"},
                                {"/obstacle/wrapped", PlaneIsWrapped(s) ? moving : 0, 2, .unit = "length"},
                                {"/tracers/points", tracers, 2, .unit = "length"},
                                {"/tracers/wrapped", PlaneIsWrapped(s) ? tracers : 0, 2, .unit = "length"}};
  PetscFunctionBeginUser;
  for (size_t k = 0; k < sizeof(all) / sizeof(all[0]); k++)
    if (all[k].rows) AppendedAddSeries(kind, all[k]);
  AppendedAddSeries(kind, (AppendedSeries){"/fluid/pressure_gradient", 0, 1, .unit = "length/time^2"});
  PetscCall(PetscMalloc4(n, &p->cells[0], n, &p->cells[1], n, &p->cells[2],
                         PetscMax(2 * PetscMax(tracers, PetscMax(M, W)), g->rank ? 0 : g->n[0] * g->n[1]), &p->shown));
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

/* Shift markers X of all vesicles, or of all obstacles (solids), by whole periods into the box. */
static void FramesWrap(Scheme s, PetscBool solids, PetscReal X[]) {
  const Obstacles o = s->coupling->bodies->obstacles;
  const Layout l = solids ? o->layout : s->membrane->layout;
  for (PetscInt v = 0; v < l->bodies; v++) {
    const PetscInt n = LayoutCount(l, v);
    PetscReal *own = X + 2 * l->start[v];
    if (!solids)
      ShiftIntoBox(s->fluid->grid, n, own, n, own);
    else if (o->motion[v].carried)
      ShiftIntoBox(s->fluid->grid, 1, MotionPose(&o->motion[v], StateInstant(&s->state)).center, n, own);
  }
}

PetscErrorCode PlaneFrame(void *plane, AppendedFile *file) {
  const Plane p = plane;
  const Scheme s = p->scheme;
  const Obstacles o = s->coupling->bodies->obstacles;
  const PetscBool wrapped = PlaneIsWrapped(s), moving = SceneObstaclesMove(&s->scene->obstacles);
  PetscReal gradient;
  PetscInt k = 0;
  Layout rows;
  PetscFunctionBeginUser;
  PetscCall(CellFields(s, p->cells[0], p->cells[1], p->cells[2]));
  PetscCall(RowsLayout(s->fluid->grid, FIELD_P, s->fluid->grid->n[0], &rows));
  for (; k < 3; k++) {
    PetscCall(LayoutToRank(rows, 0, 1, p->cells[k], p->shown));
    AppendedSet(file, k, p->shown);
  }
  PetscCall(LayoutDestroy(&rows));
  for (int name = 0; name <= STATE_SOLIDS; name++) {
    const StatePart part = StatePartOf(s, &s->state, (StatePartName)name);
    if (!part.n) continue;
    PetscCall(StateShow(s, (StatePartName)name, p->shown));
    if (name == STATE_SOLIDS) CurvesReverse(o->layout->bodies, o->layout->start, o->container, p->shown);
    AppendedSet(file, k++, p->shown);
  }
  if (s->membrane->stretches) {
    PetscCall(StateStretch(s, p->shown));
    AppendedSet(file, k++, p->shown);
  }
  if (moving) {
    ObstaclesCurves(o, StateInstant(&s->state), p->shown);
    AppendedSet(file, k++, p->shown);
  }
  if (wrapped && s->membrane->layout->M) {
    const StatePart markers = StatePartOf(s, &s->state, STATE_MARKERS);
    PetscCall(StateGather(&markers, p->shown));
    FramesWrap(s, PETSC_FALSE, p->shown);
    AppendedSet(file, k++, p->shown);
  }
  if (wrapped && moving) {
    ObstaclesCurves(o, StateInstant(&s->state), p->shown);
    FramesWrap(s, PETSC_TRUE, p->shown);
    AppendedSet(file, k++, p->shown);
  }
  if (p->tracers.n) AppendedSet(file, k++, p->tracers.X);
  if (p->tracers.n && wrapped) {
    PetscCall(PetscArraycpy(p->shown, p->tracers.X, 2 * p->tracers.n));
    for (PetscInt i = 0; i < p->tracers.n; i++) ShiftIntoBox(s->fluid->grid, 1, p->shown + 2 * i, 1, p->shown + 2 * i);
    AppendedSet(file, k++, p->shown);
  }
  PetscCall(PressureGradient(s, &gradient));
  AppendedSet(file, k, &gradient);
  PetscFunctionReturn(PETSC_SUCCESS);
}
