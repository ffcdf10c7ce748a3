#include "bodies/obstacles.h"
#include "base/agree.h"
#include "curve/contacts.h"
#include "kernel/kernel.h"
#include "scene/properties.h"

/* N of one curve where it has been placed, and its length. */
static PetscErrorCode Normals(Obstacles o, PetscInt b, PetscReal *length) {
  const PetscInt first = 2 * o->layout->start[b], n = LayoutCount(o->layout, b);
  PetscReal *T, *N = o->N + first, sum = 0;
  PetscFunctionBeginUser;
  *length = 0;
  PetscCall(PetscMalloc1(2 * n, &T));
  PetscCall(CurveTangents(&o->kind[b], o->spectral[b], n, o->X + first, T));
  for (PetscInt k = 0; k < n; k++) {
    N[2 * k] = T[2 * k + 1];
    N[2 * k + 1] = -T[2 * k];
    for (int c = 0; c < 2; c++) sum += PetscSqr(T[2 * k + c]);
    *length += PetscHypotReal(T[2 * k], T[2 * k + 1]);
  }
  for (PetscInt k = 0; k < 2 * n; k++) N[k] /= PetscSqrtReal(sum);
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One curve's middle and mean edge, and its motion. */
static PetscErrorCode Describe(Obstacles o, const SceneObstacles *own, PetscInt b) {
  const PetscBool free = own->free.is[b];
  BodyMotion *m = &o->motion[b];
  PetscReal length;
  PetscFunctionBeginUser;
  ShapeMiddle(&own->outline, b, m->center);
  PetscCall(Normals(o, b, &length));
  o->ds[b] = length / LayoutCount(o->layout, b);
  m->frequency = own->frequency;
  for (int c = 0; c < 2; c++) m->velocity[c] = own->velocity[2 * b + c];
  m->rotation = own->turn[b];
  m->turned = !own->circles && (free || (own->moving && m->rotation != 0));
  m->carried = free || m->turned || (own->moving && (m->velocity[0] != 0 || m->velocity[1] != 0));
  o->moving = o->moving || m->carried;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The centroid and the area of a curve at rest. */
static PetscErrorCode ObstacleCentroid(Obstacles o, PetscInt b, PetscReal center[2], PetscReal *area) {
  const PetscInt n = LayoutCount(o->layout, b);
  const PetscReal *X = o->rest + 2 * o->layout->start[b];
  PetscReal *T, first[2] = {0, 0};
  PetscFunctionBeginUser;
  *area = 0;
  PetscCall(PetscMalloc1(2 * n, &T));
  PetscCall(CurveTangents(&o->kind[b], o->spectral[b], n, X, T));
  for (PetscInt k = 0; k < 2 * n; k += 2) {
    const PetscReal x[2] = {X[k] - X[0], X[k + 1] - X[1]}, sweep = x[0] * T[k + 1] - x[1] * T[k];
    *area += sweep / 2;
    for (int c = 0; c < 2; c++) first[c] += x[c] * sweep / 3;
  }
  for (int c = 0; c < 2; c++) center[c] = X[c] + first[c] / *area;
  PetscCall(PetscFree(T));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Motions, layout and loads of the free bodies. */
static PetscErrorCode ObstaclesFree(Obstacles o, Scene scene) {
  const SceneFreeBodies *own = &scene->obstacles.free;
  const Layout l = o->layout;
  PetscInt *start, *body, count = 0;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(own->count + 1, &start, l->size + 1, &body));
  PetscCall(PetscMalloc2(3 * own->count, &o->load, own->count, &o->density));
  for (PetscInt k = 0; k <= own->count; k++) start[k] = k;
  for (PetscInt b = 0; b < l->bodies; b++) {
    if (!own->is[b]) continue;
    BodyMotion *m = &o->motion[b];
    PetscReal *load = o->load + 3 * count, area;
    PetscCall(ObstacleCentroid(o, b, m->center, &area));
    o->density[count] = ListEntry(&own->density, 1, b, 0);
    for (int c = 0; c < 2; c++)
      load[c] = ListEntry(&own->force, 2, b, c) + (o->density[count] - 1) * area * scene->gravity.g.v[c];
    load[2] = ListEntry(&own->torque, 1, b, 0);
    m->free = ++count;
    for (PetscMPIInt r = 0; r <= l->size; r++) body[r] += b < l->body[r];
  }
  PetscCall(LayoutCreate(l->comm, own->count, start, body, &o->free));
  PetscCall(PetscFree2(start, body));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesCreate(Scene scene, Layout all, Obstacles *out) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscInt curves = own->outline.vesicles;
  Obstacles o;
  PetscFunctionBeginUser;
  *out = NULL;
  if (!curves) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscNew(&o));
  *out = o;
  o->all = all;
  o->modes = own->modes;
  o->beta = 1 / (4 * scene->fluid.nu);
  PetscCall(LayoutCreatePart(all, all->bodies - curves, all->bodies, &o->layout));
  const PetscInt W = o->layout->M;
  o->rest = own->outline.X;
  o->kind = own->outline.kind;
  o->container = own->container;
  o->vesicle = own->vesicle;
  PetscCall(PetscCalloc6(2 * W, &o->X, 2 * W, &o->N, curves, &o->motion, curves, &o->ds, curves, &o->spectral, curves,
                         &o->ratio));
  PetscCall(PetscArraycpy(o->X, o->rest, 2 * W));
  for (PetscInt b = 0; b < curves; b++) {
    PetscCall(SpectralCreate(LayoutCount(o->layout, b), &o->spectral[b]));
    PetscCall(Describe(o, own, b));
    o->ratio[b] = own->vesicle[b] < 0 ? 1 : SceneViscosityRatio(scene, own->vesicle[b]);
  }
  PetscCall(ObstaclesFree(o, scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The markers of one curve at an instant, X[2W]. */
static void ObstacleCarry(Obstacles o, PetscInt b, Instant at, PetscReal X[]) {
  const PetscInt first = 2 * o->layout->start[b];
  MotionCarry(&o->motion[b], at, LayoutCount(o->layout, b), o->rest + first, X + first);
}

PetscErrorCode ObstaclesPlace(Obstacles o, Instant at) {
  PetscReal length;
  PetscFunctionBeginUser;
  PetscCall(InstantCopy(at, &o->at));
  for (PetscInt b = 0; b < o->layout->bodies; b++) {
    if (o->motion[b].carried) ObstacleCarry(o, b, at, o->X);
    if (o->motion[b].turned) PetscCall(Normals(o, b, &length));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesDestroy(Obstacles *obstacles) {
  Obstacles o = *obstacles;
  PetscFunctionBeginUser;
  if (!o) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < o->layout->bodies; b++) PetscCall(SpectralDestroy(&o->spectral[b]));
  PetscCall(PetscFree6(o->X, o->N, o->motion, o->ds, o->spectral, o->ratio));
  PetscCall(VecDestroy(&o->at.place));
  PetscCall(LayoutDestroy(&o->free));
  PetscCall(PetscFree2(o->load, o->density));
  PetscCall(LayoutDestroy(&o->layout));
  PetscCall(PetscFree(*obstacles));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ObstaclesCurves(Obstacles o, Instant at, PetscReal X[]) {
  for (PetscInt b = 0; b < o->layout->bodies; b++) ObstacleCarry(o, b, at, X);
  CurvesReverse(o->layout->bodies, o->layout->start, o->container, X);
}

/* The first moving curve that is too near a wall. */
static PetscErrorCode CheckWalls(Obstacles o, const CurveRoom *room, PetscReal h, const PetscReal X[], char message[]) {
  static const char *const sides[] = {"x_min", "x_max", "y_min", "y_max"};
  PetscInt side;
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < o->layout->bodies && !*message; b++) {
    const PetscReal gap = CurveWallGap(LayoutCount(o->layout, b), X + 2 * o->layout->start[b], room, &side);
    if (o->motion[b].carried && gap < KERNEL_FOLDED_CELLS * h)
      PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                              "obstacle %" PetscInt_FMT " runs into the wall %s: it would come to %.3g cells of it",
                              b + 1, sides[side], (double)(gap / h)));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CheckOthers(Obstacles o, const CurveRoom *room, const PetscReal X[], char message[]) {
  const Layout l = o->layout;
  const CurveSet set = {l->bodies, l->bodies, l->start, o->kind, X, room->period, PETSC_TRUE, NULL};
  PetscReal edge = 0;
  CurveGap *gap;
  PetscInt n;
  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < l->bodies; b++) edge = PetscMax(edge, o->ds[b]);
  PetscCall(CurveGaps(&set, SCENE_LEAST_GAP * edge, &n, &gap));
  for (PetscInt k = 0; k < n && !*message; k++) {
    const PetscInt a = gap[k].curve[0], b = gap[k].curve[1];
    const PetscReal least = SCENE_LEAST_GAP * PetscMax(o->ds[a], o->ds[b]);
    if ((!o->motion[a].carried && !o->motion[b].carried) || gap[k].distance >= least) continue;
    if (a == b)
      PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                              "obstacle %" PetscInt_FMT " runs into its periodic image: the gap would be %.3g", a + 1,
                              (double)gap[k].distance));
    else
      PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                              "obstacles %" PetscInt_FMT " and %" PetscInt_FMT
                              " run into one another: the gap would be %.3g",
                              a + 1, b + 1, (double)gap[k].distance));
  }
  PetscCall(PetscFree(gap));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesCheck(Obstacles o, Scene scene, Instant at, char message[PETVES_MAX_MESSAGE]) {
  const CurveRoom room = SceneRoom(scene);
  PetscReal *X;
  PetscFunctionBeginUser;
  message[0] = 0;
  if (!o->moving) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(2 * o->layout->M, &X));
  ObstaclesCurves(o, at, X);
  PetscCall(CheckWalls(o, &room, FluidSpecCellSize(&scene->fluid), X, message));
  if (!*message) PetscCall(CheckOthers(o, &room, X, message));
  PetscCall(PetscFree(X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscReal ObstacleStride(Obstacles o, PetscInt b, Instant from, Instant to) {
  const PetscReal *center = o->motion[b].center;
  PetscReal reach = 0;
  for (PetscInt k = o->layout->start[b]; k < o->layout->start[b + 1]; k++)
    reach = PetscMax(reach, PetscHypotReal(o->rest[2 * k] - center[0], o->rest[2 * k + 1] - center[1]));
  return MotionStride(&o->motion[b], from, to, reach);
}

/* Half the width of a curve is its area over half its length. */
PetscErrorCode ObstaclesCheckStride(Obstacles o, Instant from, Instant to, char message[PETVES_MAX_MESSAGE]) {
  PetscReal center[2], area;
  PetscFunctionBeginUser;
  message[0] = 0;
  if (o->all->bodies == 1) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < o->layout->bodies && !*message; b++) {
    if (!o->motion[b].carried) continue;
    PetscCall(ObstacleCentroid(o, b, center, &area));
    const PetscReal half = area / (PETSC_PI * ObstacleRadius(o, b)), stride = ObstacleStride(o, b, from, to);
    if (stride > half)
      PetscCall(PetscSNPrintf(message, PETVES_MAX_MESSAGE,
                              "obstacle %" PetscInt_FMT " would go by %.3g in one step, more than half its width, %.3g",
                              b + 1, (double)stride, (double)half));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ObstaclesRows(Obstacles o, const PetscScalar F[], PetscScalar y[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const PetscInt at = 2 * LayoutOffset(l, b), n = 2 * LayoutCount(l, b);
    const PetscReal *N = o->N + 2 * l->start[b];
    PetscReal sum = 0;
    for (PetscInt k = 0; k < n; k++) sum += N[k] * F[at + k];
    for (PetscInt k = 0; k < n; k++) y[at + k] += o->beta * sum * N[k];
  }
}

void ObstaclesTurn(Obstacles o, Instant from, Instant to, PetscScalar F[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    MotionTurn(&o->motion[b], from, to, LayoutCount(l, b), F + 2 * LayoutOffset(l, b));
    if (o->motion[b].free) MotionTurn(&o->motion[b], from, to, 1, F + 2 * l->n + FreeBodyAt(o, b));
  }
}

void ObstaclesScale(Obstacles o, PetscReal weight, PetscBool inverse, PetscScalar y[]) {
  const Layout l = o->layout;
  for (PetscInt b = l->own; b < l->end; b++) {
    const PetscInt at = 2 * LayoutOffset(l, b);
    const PetscReal factor = inverse ? o->ds[b] / weight : weight / o->ds[b];
    for (PetscInt k = at; k < at + 2 * LayoutCount(l, b); k++) y[k] *= factor;
    for (int c = 0; c < 3 && o->motion[b].free; c++) {
      const PetscReal row = 1 / (o->ds[b] * (c < 2 ? 1 : ObstacleRadius(o, b)));
      y[2 * l->n + FreeBodyAt(o, b) + c] *= inverse ? 1 / row : row;
    }
  }
}

PetscErrorCode ObstaclesTarget(Obstacles o, const Flow *flow, Vec k, char message[PETVES_MAX_MESSAGE]) {
  const Layout l = o->layout;
  PetscScalar *a, *y;
  PetscReal *u, U[2];
  PetscInt size;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * l->n, &u));
  PetscCall(FlowVelocities(flow, o->at.t, l->n, o->X + 2 * l->first, u, message));
  PetscCall(VecGetLocalSize(k, &size));
  PetscCall(VecGetArray(k, &a));
  y = a + size - 2 * l->n;
  for (PetscInt b = l->own; b < l->end; b++)
    for (PetscInt i = l->start[b]; i < l->start[b + 1]; i++) {
      MotionVelocity(&o->motion[b], o->at, o->X + 2 * i, U);
      for (PetscInt c = 0, at = 2 * (i - l->first); c < 2; c++) y[at + c] += u[at + c] - o->ratio[b] * U[c];
    }
  PetscCall(VecRestoreArray(k, &a));
  PetscCall(PetscFree(u));
  if (FlowIsCustom(flow)) PetscCall(AgreeMessage(l->comm, message));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ObstaclesLoads(Obstacles o, Instant at, const PetscScalar F[], PetscReal load[]) {
  const Layout l = o->layout;
  PetscReal *all;
  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(load, 3 * l->bodies));
  PetscCall(PetscMalloc1(2 * l->M, &all));
  for (PetscInt b = l->own; b < l->end; b++) {
    const BodyPose p = MotionPose(&o->motion[b], at);
    ObstacleCarry(o, b, at, all);
    MotionSum(p.center, LayoutCount(l, b), all + 2 * l->start[b], F + 2 * LayoutOffset(l, b), load + 3 * b);
  }
  PetscCall(PetscFree(all));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, load, (PetscMPIInt)(3 * l->bodies), MPIU_REAL, MPI_SUM, l->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
