/* The obstacles of a scene: circles, bumps or curves of a file, markers at equal distances on them, and what their
   surfaces do. */
#include "kernel/kernel.h"
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/vesicles.h"

#define SAMPLES 4000 /* of a curve, where it is looked for its places off a wall */
#define HALVINGS 50  /* of a sample, to find the place */
#define LEAST_RISE 2 /* cells off its wall, in its middle */
#define BUMP_POINTS 257

/* Distance (length) of X from a wall, negative behind it. */
static PetscReal ArcOff(const FluidSpec *f, PetscInt wall, const PetscReal X[2]) {
  return (wall % 2 ? -1 : 1) * (X[wall / 2] - f->box[wall]);
}

/* The parameter between two at which the curve leaves the height, low below it and high above. */
static PetscReal ArcLeave(const FluidSpec *f, const Curve *c, PetscInt wall, PetscReal height, PetscReal low,
                          PetscReal high) {
  for (int it = 0; it < HALVINGS; it++) {
    const PetscReal middle = 0.5 * (low + high);
    PetscReal X[2];
    CurveEvaluate(c, middle, X);
    if (ArcOff(f, wall, X) < height)
      low = middle;
    else
      high = middle;
  }
  return high;
}

/* clang-format off */
/* Both ends are on one wall, which is returned. */
static PetscErrorCode ArcCheckEnds(Scene scene, PetscInt b, const Curve *c, PetscReal height, PetscInt *wall) {
  const CurveRoom room = SceneRoom(scene);
  PetscInt at[2];
  PetscFunctionBeginUser;
  for (int end = 0; end < 2; end++) {
    PetscReal X[2];
    CurveEvaluate(c, end, X);
    const PetscReal off = CurveWallGap(1, X, &room, &at[end]);
    PetscCall(SCENE_REFUSE_IF(scene, at[end] < 0 || off > height,
      "-obstacle_shape: obstacle %.0f is open and ends at (%g, %g), on no wall; allowed: both ends on one wall of the box, closed curves, and ones whose last point is the first but for a period", {b + 1, X[0], X[1]}));
  }
  *wall = at[0];
  PetscFunctionReturn(SCENE_REFUSE_IF(scene, at[0] != at[1],
    "-obstacle_shape: obstacle %.0f is open and ends on two walls; allowed: both ends on one", {b + 1}));
}

/* Find which part of an open curve carries markers, part[2] of its parameter: from where it is half a marker spacing off
   the wall that its ends are on, wall = 2 direction + side, to where it is so again. b: its number, for messages. */
static PetscErrorCode ArcCut(Scene scene, PetscInt b, const Curve *c, PetscReal part[2], PetscInt *wall) {
  const FluidSpec *f = &scene->fluid;
  const PetscReal h = FluidSpecCellSize(f);
  const PetscReal height = PetscMax(0.5 * scene->obstacles.spacing, KERNEL_FOLDED_CELLS) * h;
  PetscReal least = PETSC_MAX_REAL, most = 0;
  PetscFunctionBeginUser;
  PetscCall(ArcCheckEnds(scene, b, c, height, wall));
  for (int end = 0; end < 2; end++) {
    const PetscReal step = (end ? -1. : 1.) / SAMPLES;
    PetscReal t = end, X[2];
    for (PetscInt k = 0; k < SAMPLES; k++, t += step) {
      CurveEvaluate(c, t + step, X);
      if (ArcOff(f, *wall, X) > height) break;
    }
    part[end] = ArcLeave(f, c, *wall, height, t, t + step);
  }
  for (PetscInt k = 0; k <= SAMPLES; k++) {
    PetscReal X[2];
    CurveEvaluate(c, part[0] + (part[1] - part[0]) * (PetscReal)k / SAMPLES, X);
    least = PetscMin(least, ArcOff(f, *wall, X));
    most = PetscMax(most, ArcOff(f, *wall, X));
  }
  const SceneRule rules[] = {
    {part[0] >= part[1] || most < LEAST_RISE * h,
     "-obstacle_shape: obstacle %.0f rises %.3g cells from its wall; allowed: at least %.0f", {b + 1, most / h, LEAST_RISE}},
    {least < height * (1 - 1e-6),
     "-obstacle_shape: obstacle %.0f comes back to its wall between its ends; allowed: a curve of its own for each bump", {b + 1}}};
  PetscCall(REFUSE(scene, rules));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

/* One bump of a constriction, (1 - throat)/2 of the channel high in its middle, a whole wave of a cosine long, on the
   lower (side 0) or the upper wall in y. */
static PetscErrorCode ArcBump(Scene scene, int side, Curve *curve) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscReal *box = scene->fluid.box, width = box[3] - box[2], middle = ListEntry(&own->center, 2, 0, 0);
  const PetscReal length = own->length > 0 ? own->length : width, height = 0.5 * (1 - own->throat) * width;
  const CurveKind open = {.type = CURVE_OPEN};
  PetscReal xy[2 * BUMP_POINTS];
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < BUMP_POINTS; k++) { /* the solid on the left */
    const PetscReal t = (PetscReal)k / (BUMP_POINTS - 1) - 0.5;
    const PetscReal rise = 0.5 * height * (1 + PetscCosReal(2 * PETSC_PI * t));
    xy[2 * k] = middle + (side ? t : -t) * length;
    xy[2 * k + 1] = side ? box[3] - rise : box[2] + rise;
  }
  PetscCall(CurveFromPoints(&open, BUMP_POINTS, xy, curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A curve before it has markers. */
typedef struct {
  Curve curve;
  PetscReal center[2]; /* added to the curve's points */
  CurveNote note;
  PetscReal part[2]; /* parameters of an open curve between which the markers are */
  PetscInt wall;     /* 2 direction + side of the wall that an open curve is on; -1 of other curves */
} Outline;

typedef struct {
  PetscInt count;
  Outline *of; /* [count] */
} Outlines;

/* The place of post k where columns and rows fill the box, each row a part of a column further than the one below. */
static void ObstaclePlaceInLattice(Scene scene, PetscInt k, PetscReal center[2]) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscReal *b = scene->fluid.box;
  const PetscInt columns = own->posts.lattice.v[0], rows = own->posts.lattice.v[1];
  const PetscReal at = k % columns + 0.5 + k / columns * own->posts.shift;
  center[0] = b[0] + (b[1] - b[0]) / columns * (at - columns * PetscFloorReal(at / columns));
  center[1] = b[2] + (b[3] - b[2]) / rows * (k / columns + 0.5);
}

/* Make circles, with the velocity and rotation that the options give each of them. */
static PetscErrorCode ObstaclesMakeCircles(Scene scene, PetscInt count, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscReal *packed = own->shape == OBSTACLE_POSTS ? own->posts.packed : NULL;
  const PetscBool lattice = own->posts.lattice.n == 2 && own->posts.lattice.v[0] > 0;
  PetscFunctionBeginUser;
  o->count = count;
  PetscCall(PetscCalloc1(count, &o->of));
  PetscCall(SceneCheckList(scene, "-obstacle_radius", 1, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_velocity", 2, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_rotation", 1, count, "obstacles", "each"));
  for (PetscInt k = 0; k < count; k++) {
    Outline *one = &o->of[k];
    if (lattice) ObstaclePlaceInLattice(scene, k, one->center);
    for (int c = 0; c < 2; c++) {
      one->curve.axes[c] = ListEntry(&own->radius, 1, k, 0);
      if (!lattice) one->center[c] = packed ? packed[2 * k + c] : ListEntry(&own->center, 2, k, c);
      one->note.velocity[c] = ListEntry(&own->move, 2, k, c);
    }
    one->note.rotation = ListEntry(&own->rotation, 1, k, 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* clang-format off */
static PetscErrorCode ObstaclesMakePosts(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscInt columns = own->posts.lattice.v[0], rows = own->posts.lattice.n == 2 ? own->posts.lattice.v[1] : -1;
  const PetscInt count = own->posts.count ? own->posts.count : columns * rows;
  const PetscReal turns = own->posts.shift * rows;
  const SceneRule rules[] = {
    {rows < 0 || (columns > 0) != (rows > 0),
     "-obstacle_lattice {-obstacle_lattice}: no lattice; allowed: columns,rows, both above 0, or 0,0 for none"},
    {scene->fluid.bc[1] == BC_PERIODIC && PetscAbsReal(turns - PetscFloorReal(turns + 0.5)) >= 1e-9,
     "-obstacle_shift {-obstacle_shift}: %.0f rows are shifted by %g columns, so that the lattice breaks where the box repeats; allowed: rows times shift a whole number", {rows, turns}},
    {own->posts.count && columns,
     "-obstacle_count {-obstacle_count}: given together with -obstacle_lattice; allowed: one of them"},
    {!count && own->center.n % 2, "-obstacle_center {-obstacle_center}: not pairs; allowed: x,y of each post"}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(scene, rules));
  PetscCall(ObstaclesMakeCircles(scene, count ? count : own->center.n / 2, o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstaclesMakeCouette(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const SceneRule rules[] = {
    {own->radius.n != 2,
     "-obstacle_shape couette: -obstacle_radius {-obstacle_radius}: not two numbers; allowed: the inner and the outer radius"},
    {own->radius.n == 2 && own->radius.v[0] >= own->radius.v[1],
     "-obstacle_shape couette: -obstacle_radius {-obstacle_radius}; allowed: the inner radius first, smaller than the outer one"}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(scene, rules));
  PetscCall(SceneCheckList(scene, "-obstacle_center", 2, 2, "obstacles", "each"));
  PetscCall(ObstaclesMakeCircles(scene, 2, o));
  o->of[1].note.clockwise = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bumps that face one another. */
static PetscErrorCode ObstaclesMakeConstriction(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const FluidSpec *f = &scene->fluid;
  const SceneRule rules[] = {
    {f->bc[1] != BC_WALL,
     "-obstacle_shape constriction: its bumps are on the walls y_min and y_max; allowed: -domain_bc_y wall"},
    {own->length >= f->box[1] - f->box[0],
     "-obstacle_length {-obstacle_length}: the box is %g long; allowed: less than that", {f->box[1] - f->box[0]}}};
  PetscFunctionBeginUser;
  PetscCall(REFUSE(scene, rules));
  PetscCall(SceneCheckList(scene, "-obstacle_center", 2, 1, "obstacles", "each"));
  o->count = 2;
  PetscCall(PetscCalloc1(2, &o->of));
  for (int side = 0; side < 2; side++) PetscCall(ArcBump(scene, side, &o->of[side].curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */

static PetscErrorCode ObstaclesMakeFromFile(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscReal period[2];
  Curve *curve;
  CurveNote *note;
  PetscFunctionBeginUser;
  PetvesCheck(*own->file, scene->comm,
              "-obstacle_shape file: no -obstacle_file given; allowed: a text file with x y a line");
  FluidSpecPeriods(&scene->fluid, period);
  PetscCall(CurvesFromFile(scene->comm, "-obstacle_file", own->file, period, &o->count, &curve, &note));
  PetscCall(PetscCalloc1(o->count, &o->of));
  for (PetscInt k = 0; k < o->count; k++) o->of[k] = (Outline){.curve = curve[k], .note = note[k]};
  PetscCall(PetscFree(curve));
  PetscCall(PetscFree(note));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define LEAST_MARKERS 15
#define MOST_MARKERS 40000
#define MOST_DENSE 4000    /* markers that a dense block of the preconditioner may have */
#define MOST_TOGETHER 2000 /* markers up to which all obstacles share a dense block */

/* clang-format off */
/* An odd number of markers on each curve that repeats; on open ones none farther apart than wanted, so that the first
   is half a spacing off its wall. */
static PetscErrorCode ObstaclesCreateShape(Scene scene, const Outlines *o, Shape *shape) {
  const PetscReal spacing = scene->obstacles.spacing * FluidSpecCellSize(&scene->fluid);
  PetscInt *markers, all = 0;
  CurveKind *kind;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(o->count, &markers, o->count, &kind));
  for (PetscInt k = 0; k < o->count; k++) {
    const Outline *one = &o->of[k];
    const PetscBool open = one->curve.kind.type == CURVE_OPEN;
    const PetscReal length = open ? CurvePartLength(&one->curve, one->part[0], one->part[1]) : CurveLength(&one->curve);
    const PetscReal wanted = length / spacing;
    PetscCall(SCENE_REFUSE_IF(scene, all + wanted > MOST_MARKERS,
      "-obstacle_spacing {-obstacle_spacing}: more than %.0f markers on the obstacles; allowed: at most that many, so a larger spacing, fewer obstacles or coarser -domain_cells", {MOST_MARKERS}));
    const PetscInt n = open ? 1 + (PetscInt)PetscCeilReal(wanted) : 2 * (PetscInt)PetscFloorReal(wanted / 2) + 1;
    markers[k] = PetscMax(LEAST_MARKERS, n);
    all += markers[k];
    kind[k] = one->curve.kind;
  }
  PetscCall(ShapeCreate(o->count, markers, kind, shape));
  PetscCall(PetscFree2(markers, kind));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Choose whether each obstacle has its own block in the preconditioner (-obstacle_factor). */
static PetscErrorCode ObstaclesChooseFactor(Scene scene, const Outlines *o, SceneObstacles *own) {
  const FluidSpec *f = &scene->fluid;
  const PetscInt markers = own->outline.start[o->count];
  const PetscBool periodic = f->bc[0] == BC_PERIODIC && f->bc[1] == BC_PERIODIC;
  /* modes know neither walls that obstacles stand on nor unbounded fluid */
  const PetscBool free = !strcmp(own->free.which, "all") && !FluidSpecIsFree(f);
  const PetscBool many = (free || periodic) && markers > MOST_TOGETHER;
  PetscInt most = 0;
  own->modes = own->factor == OBSTACLE_FACTOR_AUTO ? many : own->factor == OBSTACLE_FACTOR_MODES;
  for (PetscInt k = 0; k < o->count; k++) most = PetscMax(most, own->outline.start[k + 1] - own->outline.start[k]);
  if (!own->modes) most = markers;
  const SceneRule rules[] = {
    {most > MOST_DENSE && own->modes,
     "-obstacle_spacing {-obstacle_spacing}: %.0f markers on one obstacle; allowed: at most %.0f, so a larger spacing or coarser -domain_cells", {most, MOST_DENSE}},
    {most > MOST_DENSE,
     "-obstacle_spacing {-obstacle_spacing}: %.0f markers on the obstacles; allowed: at most %.0f, so a larger spacing, coarser -domain_cells, or -obstacle_factor modes", {most, MOST_DENSE}}};
  return REFUSE(scene, rules);
}
/* clang-format on */

static PetscErrorCode ObstaclesPlaceMarkers(Scene scene, const Outlines *o, SceneObstacles *own) {
  Shape *shape = &own->outline;
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(shape->digest, o->of[0].curve.digest, DIGEST));
  PetscCall(ObstaclesCreateShape(scene, o, shape));
  PetscCall(ObstaclesChooseFactor(scene, o, own));
  PetscCall(PetscMalloc2(scene->shape.vesicles + o->count, &own->holder, o->count, &own->vesicle));
  PetscCall(PetscCalloc5(2 * o->count, &own->velocity, o->count, &own->turn, o->count, &own->container, o->count,
                         &own->wall, o->count, &own->free.is));
  own->circles = own->shape == OBSTACLE_POSTS || own->shape == OBSTACLE_COUETTE;
  for (PetscInt k = 0; k < o->count; k++) {
    const Outline *one = &o->of[k];
    const PetscInt n = shape->start[k + 1] - shape->start[k];
    PetscReal *X = shape->X + 2 * shape->start[k];
    PetscCall(CurveEqualEdges(&one->curve, one->curve.kind.type == CURVE_OPEN ? one->part : NULL, PETSC_FALSE, n, X));
    for (PetscInt j = 0; j < 2 * n; j++) X[j] += one->center[j % 2];
    for (int c = 0; c < 2; c++) own->velocity[2 * k + c] = one->note.velocity[c];
    own->turn[k] = one->note.rotation;
    own->wall[k] = one->wall;
    own->container[k] = one->curve.kind.type == CURVE_CLOSED ? one->note.clockwise : PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneMakeObstacles(Draft scene) {
  static PetscErrorCode (*const make[])(Scene, Outlines *) = {NULL, ObstaclesMakePosts, ObstaclesMakeCouette,
                                                              ObstaclesMakeConstriction, ObstaclesMakeFromFile};
  Outlines o = {0};
  PetscFunctionBeginUser;
  if (scene->obstacles.shape == OBSTACLE_NONE) {
    scene->obstacles.moving = PETSC_FALSE;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(make[scene->obstacles.shape](scene, &o));
  for (PetscInt k = 0; k < o.count; k++) {
    Outline *one = &o.of[k];
    one->wall = -1;
    if (one->curve.kind.type == CURVE_OPEN) PetscCall(ArcCut(scene, k, &one->curve, one->part, &one->wall));
  }
  PetscCall(ObstaclesPlaceMarkers(scene, &o, &scene->obstacles));
  scene->fluid.held = PETSC_TRUE;
  for (PetscInt k = 0; k < o.count; k++) PetscCall(CurveDestroy(&o.of[k].curve));
  PetscCall(PetscFree(o.of));
  PetscCall(SceneChooseFreeBodies(scene));
  PetscCall(SceneCheckObstacles(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDropObstacles(Draft scene) {
  SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  PetscCall(PetscFree(own->posts.packed));
  if (!own->outline.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShapeDestroy(&own->outline));
  PetscCall(PetscFree2(own->holder, own->vesicle));
  PetscCall(PetscFree5(own->velocity, own->turn, own->container, own->wall, own->free.is));
  PetscFunctionReturn(PETSC_SUCCESS);
}
