#include "scene/checks.h"
#include "curve/contacts.h"
#include "curve/crossing.h"
#include "kernel/kernel.h"
#include "scene/properties.h"

#define LEAST_ACROSS 6 /* cells: the drag of such a circle is right to 6e-5 (docs/obstacles.md) */

/* With inertia the mobility of markers farther apart than 1.5 h is indefinite. */
/* clang-format off */
static PetscErrorCode ObstaclesCheckMethod(Scene s) {
  const SceneRule rules[] = {
    {FluidSpecIsFree(&s->fluid) && s->obstacles.free.count < s->obstacles.outline.vesicles,
     "-obstacle_shape: not with -domain_bc_x free, where a body held in a flow has no finite velocity in two dimensions; allowed: walls, or periodic boundaries, or -obstacle_free all"},
    {SceneIsProjection(s), "-obstacle_shape: not with -scheme_type {-scheme_type}; allowed: coupled"},
    {s->fluid.inertia != INERTIA_AUTO && s->fluid.inertia != INERTIA_NONE && s->obstacles.spacing > 1.5,
     "-obstacle_spacing {-obstacle_spacing}: with inertia of the fluid obstacles so far apart leak; allowed: at most 1.5, or -fluid_inertia none"},
    {s->coupling.near_field != NEAR_EXACT, "-obstacle_shape: not with -coupling_near_field none; allowed: exact"},
    {!SceneHasBoxPart(s) && s->coupling.box_part && !FluidSpecIsFree(&s->fluid),
     "-domain_box {-domain_box}: obstacles need a box at most %.0f times as long as high; allowed: shorter periods", {FLUID_LONGEST_PERIOD}},
    {!SceneHasBoxPart(s) && !FluidSpecIsFree(&s->fluid),
     "-coupling_box_part {-coupling_box_part}: without it forces of obstacles are wrong by parts of a hundred; allowed: true"}};
  return REFUSE(s, rules);
}

/* Check that a curve is at least LEAST_ACROSS cells across (a bump only along its wall; a spanning curve may be flat),
   fits into the box and keeps its distance from the walls that it does not stand on. The least distance is
   KERNEL_FOLDED_CELLS for closed curves, which have finer points next to a wall (layers/finecurve.h), and a marker
   spacing for others. */
static PetscErrorCode ObstacleCheckPlace(Scene scene, PetscInt b) {
  const SceneObstacles *own = &scene->obstacles;
  const FluidSpec *f = &scene->fluid;
  const Shape *s = &own->outline;
  const PetscInt type = s->kind[b].type, wall = own->wall[b];
  const PetscReal h = FluidSpecCellSize(f), least = type == CURVE_CLOSED ? KERNEL_FOLDED_CELLS : own->spacing;
  PetscReal around[4] = CURVE_NOWHERE;
  PetscFunctionBeginUser;
  CurveBounds(s->start[b + 1] - s->start[b], s->X + 2 * s->start[b], around);
  for (int d = 0; d < 2; d++) {
    const PetscBool walls = f->bc[d] == BC_WALL, along = wall < 0 || wall / 2 != d;
    const PetscReal low = around[2 * d], high = around[2 * d + 1], beyond = least * h * (1 - 1e-12);
    const PetscReal below = wall == 2 * d ? beyond : low - f->box[2 * d], above = wall == 2 * d + 1 ? beyond : f->box[2 * d + 1] - high;
    const PetscReal room = PetscMin(below, above);
    const SceneRule rules[] = {
      {along && type != CURVE_SPANNING && high - low < LEAST_ACROSS * h * (1 - 1e-2),
       "-obstacle_shape: obstacle %.0f is %.3g cells across in %c; allowed: at least %.0f, so finer -domain_cells or a larger one", {b + 1, (high - low) / h, "xy"[d], LEAST_ACROSS}},
      {high - low >= f->box[2 * d + 1] - f->box[2 * d],
       "-obstacle_shape: obstacle %.0f is %g long in %c; allowed: one that fits into -domain_box", {b + 1, high - low, "xy"[d]}},
      {walls && room < beyond && type == CURVE_CLOSED && own->shape == OBSTACLE_FILE,
       "-obstacle_file {-obstacle_file}: closed curve %.0f comes to %.3g cells of a wall in %c; allowed: at least %g, or the line # open before its points: a bump on the wall", {b + 1, room / h, "xy"[d], least}},
      {walls && room < beyond,
       "-obstacle_shape: obstacle %.0f comes to %.3g cells of a wall in %c; allowed: at least %g", {b + 1, room / h, "xy"[d], least}}};
    PetscCall(REFUSE(scene, rules));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* The spanning curve that a ray from X, upwards (1) or downwards (-1) in direction d, meets first and whose solid is
   towards X, or -1. Curves are looked at over their own period and its neighbours. */
static PetscInt ObstacleSolidAlong(const Shape *s, int d, int up, const PetscReal X[2], const PetscReal period[2]) {
  PetscReal least = PETSC_MAX_REAL;
  PetscInt found = -1;
  for (PetscInt b = 0; b < s->vesicles; b++)
    for (PetscInt k = s->start[b]; k < s->start[b + 1] && s->kind[b].span[1 - d] != 0; k++) {
      const PetscReal *A = s->X + 2 * k, *span = s->kind[b].span;
      const PetscBool last = k + 1 == s->start[b + 1];
      const PetscReal *B = last ? s->X + 2 * s->start[b] : A + 2;
      const PetscReal along = B[1 - d] + (last ? span[1 - d] : 0) - A[1 - d];
      PetscReal x = X[1 - d] - A[1 - d], off;
      x -= period[1 - d] * PetscFloorReal(x / period[1 - d] + (along < 0 ? 1 : 0)); /* 0 .. period, -period .. 0 */
      if (along == 0 || x / along < 0 || x / along >= 1) continue;
      off = up * (A[d] + (B[d] - A[d]) * x / along - X[d]);
      if (period[d] > 0) off -= period[d] * PetscFloorReal(off / period[d]);
      if (off < 0 || off >= least) continue;
      least = off;
      /* the solid is on the left of the curve's direction: above one that runs along +x, below one along +y */
      found = (along > 0) == (d == 1) ? (up < 0 ? b : -1) : (up > 0 ? b : -1);
    }
  return found;
}

/* The container that holds the point, not looking at curve `self`, or -1. */
static PetscInt ObstacleHolder(const SceneObstacles *own, PetscInt self, const PetscReal X[2],
                               const PetscReal period[2]) {
  for (PetscInt b = 0; b < own->outline.vesicles; b++)
    if (b != self && own->container[b] && ShapeHolds(&own->outline, b, X, period)) return b;
  return -1;
}

/* The obstacle in whose solid the point of curve `self` (-1: of a vesicle) lies, or -1: within a closed curve, outside
   all containers or, that of a container, inside another one, on the solid's side of a spanning curve. holder: the
   container that holds the point, or -1. */
static PetscInt ObstacleSolidAt(const SceneObstacles *own, PetscInt self, PetscInt holder, const PetscReal X[2],
                                const PetscReal period[2]) {
  const Shape *s = &own->outline;
  for (PetscInt b = 0; b < s->vesicles; b++) {
    if (b == self) continue;
    if (!own->container[b] ? ShapeHolds(s, b, X, period) : self >= 0 && own->container[self] ? b == holder : holder < 0)
      return b;
  }
  for (int ray = 0; ray < 4 && (self < 0 || s->kind[self].type == CURVE_CLOSED); ray++) {
    const PetscInt b = ObstacleSolidAlong(s, ray / 2, ray % 2 ? 1 : -1, X, period);
    if (b >= 0) return b;
  }
  return -1;
}

/* clang-format off */
/* Check that no vesicle and no obstacle is in a solid, given that no curves cross; find the containers around them and
   the vesicles around obstacles. */
static PetscErrorCode ObstaclesCheckInside(Draft scene, const PetscReal period[2]) {
  SceneObstacles *own = &scene->obstacles;
  const Shape *s = &own->outline, *vesicles = &scene->shape;
  const PetscInt n = vesicles->vesicles;
  PetscFunctionBeginUser;
  for (PetscInt c = -n; c < s->vesicles; c++) { /* vesicles first */
    const PetscInt self = PetscMax(c, -1);
    const PetscReal *X = c < 0 ? vesicles->X + 2 * vesicles->start[n + c] : s->X + 2 * s->start[c];
    own->holder[n + c] = ObstacleHolder(own, self, X, period);
    const PetscInt b = ObstacleSolidAt(own, self, own->holder[n + c], X, period);
    const SceneRule rules[] = {
      {b >= 0 && c < 0,
       "-vesicle_center: vesicle %.0f lies in the solid of obstacle %.0f; allowed: vesicles in the fluid", {n + c + 1, b + 1}},
      {b >= 0,
       "-obstacle_shape: obstacle %.0f lies in the solid of obstacle %.0f; allowed: obstacles in the fluid, apart from one another", {c + 1, b + 1}}};
    PetscCall(REFUSE(scene, rules));
    if (c >= 0) own->vesicle[c] = -1;
    for (PetscInt v = 0; v < n && c >= 0; v++)
      if (ShapeHolds(vesicles, v, X, period)) own->vesicle[c] = v;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Check that markers resolve the gaps between obstacles and between an obstacle and its images. */
static PetscErrorCode ObstaclesCheckGaps(Scene scene, const PetscReal period[2]) {
  const SceneObstacles *own = &scene->obstacles;
  const Shape *s = &own->outline;
  const PetscReal spacing = own->spacing * FluidSpecCellSize(&scene->fluid);
  PetscReal *X;
  CurveGap *gap;
  PetscInt n;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * s->start[s->vesicles], &X));
  PetscCall(PetscArraycpy(X, s->X, 2 * s->start[s->vesicles]));
  CurvesReverse(s->vesicles, s->start, own->container, X); /* clockwise where the fluid is inside */
  const CurveSet set = {s->vesicles, s->vesicles, s->start, s->kind, X, period, PETSC_TRUE, NULL};
  PetscCall(CurveGaps(&set, SCENE_LEAST_GAP * spacing, &n, &gap));
  if (n)
    PetscCall(SCENE_REFUSE_IF(scene, 1,
      "-obstacle_shape: the gap between obstacles %.0f and %.0f is %.3g, %.2g marker spacings; allowed: at least %g, so farther apart or a smaller -obstacle_spacing",
      {gap->curve[0] + 1, gap->curve[1] + 1, gap->distance, gap->distance / spacing, SCENE_LEAST_GAP}));
  PetscCall(PetscFree(gap));
  PetscCall(PetscFree(X));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Check that no obstacle crosses another one, itself or a vesicle. */
static PetscErrorCode ObstaclesCheckCrossing(Scene scene, const PetscReal period[2]) {
  const Shape *s = &scene->obstacles.outline, *v = &scene->shape;
  const PetscInt n = v->vesicles, M = v->start[n], all = n + s->vesicles;
  PetscInt *start, pair[2];
  CurveKind *kind;
  PetscReal *X;
  PetscFunctionBeginUser;
  PetscCall(PetscCalloc3(all + 1, &start, all, &kind, 2 * (M + s->start[s->vesicles]), &X));
  PetscCall(PetscArraycpy(kind + n, s->kind, s->vesicles));
  PetscCall(PetscArraycpy(start, v->start, n));
  for (PetscInt b = 0; b <= s->vesicles; b++) start[n + b] = M + s->start[b];
  PetscCall(PetscArraycpy(X, v->X, 2 * M));
  PetscCall(PetscArraycpy(X + 2 * M, s->X, 2 * s->start[s->vesicles]));
  const CurveSet set = {all, n, start, kind, X, period, PETSC_TRUE};
  PetscCall(CurvesCross(&set, pair));
  PetscCall(PetscFree3(start, kind, X));
  const PetscInt a = pair[0], b = pair[1] - n + 1;
  const SceneRule rules[] = {
    {a >= 0 && a < n,
     "-vesicle_center: vesicle %.0f crosses obstacle %.0f; allowed: vesicles in the fluid", {a + 1, b}},
    {a >= n,
     "-obstacle_shape: obstacles %.0f and %.0f cross; allowed: curves apart from one another, from themselves and from their images", {a - n + 1, b}}};
  PetscCall(REFUSE(scene, rules));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define MOST_FLUX 1e-6 /* of the sum of |U| ds */

/* Check that the velocity of a curve that is not closed, less a uniform flow, moves no fluid through the curve. Other
   flows have no flux through walls and across periods. */
static PetscErrorCode ObstacleCheckFlux(Scene scene, PetscInt b) {
  const SceneObstacles *own = &scene->obstacles;
  const Shape *s = &own->outline;
  const PetscInt first = s->start[b], n = s->start[b + 1] - first;
  const CurveSet set = {s->vesicles, 0, s->start, s->kind, s->X, NULL, PETSC_FALSE};
  PetscReal flux = 0, all = 0, middle[2], shift[2];
  PetscFunctionBeginUser;
  if (s->kind[b].type == CURVE_CLOSED) PetscFunctionReturn(PETSC_SUCCESS);
  ShapeMiddle(s, b, middle);
  for (int c = 0; c < 2; c++)
    shift[c] = own->velocity[2 * b + c] -
               (scene->flow.type == FLOW_UNIFORM ? ListEntry(&scene->flow.velocity, 2, 0, c) : 0);
  for (PetscInt k = 0; k < n; k++) { /* edges, exact for velocities that are linear in the place */
    PetscReal to[2], off[2], edge[2];
    if (!CurveSetWalk(&set, b, first + k, 1, to)) continue;
    for (int c = 0; c < 2; c++) {
      const PetscReal at = s->X[2 * (first + k) + c];
      off[c] = 0.5 * (at + to[c]) - middle[c];
      edge[c] = to[c] - at;
    }
    const PetscReal U[2] = {shift[0] - own->turn[b] * off[1], shift[1] + own->turn[b] * off[0]};
    flux += U[0] * edge[1] - U[1] * edge[0];
    all += PetscHypotReal(U[0], U[1]) * PetscHypotReal(edge[0], edge[1]);
  }
  PetscFunctionReturn(SCENE_REFUSE_IF(scene, PetscAbsReal(flux) > MOST_FLUX * all,
    "-obstacle_shape: obstacle %.0f has a flux of %.3g through it, of its surface's velocity less a uniform flow's, which no fluid can follow; allowed on a wall and across a period: velocities along them", {b + 1, flux}));
}

/* Check that only closed curves move, and that one of them does. */
static PetscErrorCode ObstaclesCheckMotion(Scene scene) {
  const SceneObstacles *own = &scene->obstacles;
  const Shape *s = &own->outline;
  PetscBool any = PETSC_FALSE;
  PetscFunctionBeginUser;
  if (!own->moving) PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt b = 0; b < s->vesicles; b++) {
    if (own->velocity[2 * b] == 0 && own->velocity[2 * b + 1] == 0 && own->turn[b] == 0) continue;
    any = PETSC_TRUE;
    const SceneRule rules[] = {
      {s->kind[b].type == CURVE_OPEN,
       "-obstacle_moving: obstacle %.0f has a velocity and stands on a wall; allowed: closed curves that move, others at rest", {b + 1}},
      {s->kind[b].type == CURVE_SPANNING,
       "-obstacle_moving: obstacle %.0f has a velocity and spans the box; allowed: closed curves that move, others at rest", {b + 1}}};
    PetscCall(REFUSE(scene, rules));
  }
  PetscFunctionReturn(SCENE_REFUSE_IF(scene, !any,
    "-obstacle_moving: no obstacle has a velocity or rotation; allowed: -obstacle_velocity or -obstacle_rotation of posts and couette, lines # velocity or # rotation in -obstacle_file"));
}
/* clang-format on */

PetscErrorCode SceneCheckObstacles(Draft scene) {
  PetscReal period[2];
  PetscFunctionBeginUser;
  PetscCall(ObstaclesCheckMethod(scene));
  FluidSpecPeriods(&scene->fluid, period);
  for (PetscInt b = 0; b < scene->obstacles.outline.vesicles; b++) PetscCall(ObstacleCheckPlace(scene, b));
  PetscCall(ObstaclesCheckCrossing(scene, period));
  PetscCall(ObstaclesCheckInside(scene, period));
  PetscCall(ObstaclesCheckGaps(scene, period));
  PetscCall(ObstaclesCheckMotion(scene));
  for (PetscInt b = 0; b < scene->obstacles.outline.vesicles; b++) PetscCall(ObstacleCheckFlux(scene, b));
  PetscFunctionReturn(PETSC_SUCCESS);
}
