/* The obstacles of a scene: circles, bumps or curves of a file, markers at equal distances on them, and what their
   surfaces do. */
#include "scene/obstacles.h"
#include "scene/checks.h"
#include "scene/openbodies.h"
#include "scene/properties.h"

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
  const PetscInt columns = own->lattice.v[0], rows = own->lattice.v[1];
  const PetscReal at = k % columns + 0.5 + k / columns * own->shift;
  center[0] = b[0] + (b[1] - b[0]) / columns * (at - columns * PetscFloorReal(at / columns));
  center[1] = b[2] + (b[3] - b[2]) / rows * (k / columns + 0.5);
}

static PetscErrorCode ObstaclesCheckLattice(Scene scene) {
  const SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  PetscCheck(own->lattice.n == 2 && (own->lattice.v[0] > 0) == (own->lattice.v[1] > 0), scene->comm,
             PETSC_ERR_USER_INPUT,
             "-obstacle_lattice: %" PetscInt_FMT " numbers given; allowed: columns,rows, both above 0, or 0,0 for none",
             own->lattice.n);
  const PetscReal turns = own->shift * own->lattice.v[1];
  PetscCheck(scene->fluid.bc[1] != BC_PERIODIC || PetscAbsReal(turns - PetscFloorReal(turns + 0.5)) < 1e-9, scene->comm,
             PETSC_ERR_USER_INPUT,
             "-obstacle_shift %g: %" PetscInt_FMT " rows are shifted by %g columns, so that the lattice breaks where "
             "the box repeats; allowed: rows times shift a whole number",
             (double)own->shift, own->lattice.v[1], (double)turns);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make circles, with the velocity and rotation that the options give each of them. */
static PetscErrorCode ObstaclesMakeCircles(Scene scene, PetscInt count, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscBool lattice = own->lattice.n == 2 && own->lattice.v[0] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  o->count = count;
  PetscCall(PetscCalloc1(count, &o->of));
  PetscCall(SceneCheckList(scene, "-obstacle_radius", own->radius.n, 1, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_velocity", own->move.n, 2, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_rotation", own->rotation.n, 1, count, "obstacles", "each"));
  for (PetscInt k = 0; k < count; k++) {
    Outline *one = &o->of[k];
    if (lattice) ObstaclePlaceInLattice(scene, k, one->center);
    for (int c = 0; c < 2; c++) {
      one->curve.axes[c] = ListEntry(&own->radius, 1, k, 0);
      if (!lattice) one->center[c] = ListEntry(&own->center, 2, k, c);
      one->note.velocity[c] = ListEntry(&own->move, 2, k, c);
    }
    one->note.rotation = ListEntry(&own->rotation, 1, k, 0);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstaclesMakePosts(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  PetscCall(ObstaclesCheckLattice(scene));
  const PetscInt count = own->lattice.v[0] * own->lattice.v[1];
  PetscCheck(!count || !SceneGiven(scene, "-obstacle_center"), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_center: given together with -obstacle_lattice; allowed: one of them");
  PetscCheck(count || own->center.n % 2 == 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_center: %" PetscInt_FMT " numbers given; allowed: x,y of each post", own->center.n);
  PetscCall(ObstaclesMakeCircles(scene, count ? count : own->center.n / 2, o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstaclesMakeCouette(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  PetscCheck(own->radius.n == 2, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape couette: -obstacle_radius has %" PetscInt_FMT
             " numbers; allowed: two, the inner and the outer radius",
             own->radius.n);
  PetscCheck(
      own->radius.v[0] < own->radius.v[1], scene->comm, PETSC_ERR_USER_INPUT,
      "-obstacle_shape couette: -obstacle_radius %g,%g; allowed: the inner radius first, smaller than the outer one",
      (double)own->radius.v[0], (double)own->radius.v[1]);
  PetscCall(SceneCheckList(scene, "-obstacle_center", own->center.n, 2, 2, "obstacles", "each"));
  PetscCall(ObstaclesMakeCircles(scene, 2, o));
  o->of[1].note.clockwise = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bumps that face one another. */
static PetscErrorCode ObstaclesMakeConstriction(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const FluidSpec *f = &scene->fluid;
  PetscFunctionBeginUser;
  PetscCheck(f->bc[1] == BC_WALL, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape constriction: its bumps are on the walls y_min and y_max; allowed: -domain_bc_y wall");
  PetscCheck(own->length < f->box[1] - f->box[0], scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_length %g: the box is %g long; allowed: less than that", (double)own->length,
             (double)(f->box[1] - f->box[0]));
  PetscCall(SceneCheckList(scene, "-obstacle_center", own->center.n, 2, 1, "obstacles", "each"));
  o->count = 2;
  PetscCall(PetscCalloc1(2, &o->of));
  for (int side = 0; side < 2; side++) PetscCall(ArcBump(scene, side, &o->of[side].curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstaclesMakeFromFile(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscReal period[2];
  Curve *curve;
  CurveNote *note;
  PetscFunctionBeginUser;
  PetscCheck(*own->file, scene->comm, PETSC_ERR_USER_INPUT,
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
    const PetscBool open = one->curve.kind.type == CURVE_OPEN ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal length = open ? CurvePartLength(&one->curve, one->part[0], one->part[1]) : CurveLength(&one->curve);
    const PetscReal wanted = length / spacing;
    PetscCheck(all + wanted <= MOST_MARKERS, scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_spacing %g: more than %d markers on the obstacles; allowed: at most that many, so a larger "
               "spacing, fewer obstacles or coarser -domain_cells",
               (double)scene->obstacles.spacing, MOST_MARKERS);
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
  const PetscBool periodic = f->bc[0] == BC_PERIODIC && f->bc[1] == BC_PERIODIC ? PETSC_TRUE : PETSC_FALSE;
  PetscInt most = 0;
  PetscFunctionBeginUser;
  own->modes = own->factor == OBSTACLE_FACTOR_MODES ? PETSC_TRUE : PETSC_FALSE;
  if (own->factor == OBSTACLE_FACTOR_AUTO && markers > MOST_TOGETHER && periodic) own->modes = PETSC_TRUE;
  for (PetscInt k = 0; k < o->count; k++) most = PetscMax(most, own->outline.start[k + 1] - own->outline.start[k]);
  if (!own->modes) most = markers;
  PetscCheck(most <= MOST_DENSE, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_spacing %g: %" PetscInt_FMT " markers on %s; allowed: at most %d, so a larger spacing%s",
             (double)own->spacing, most, own->modes ? "one obstacle" : "the obstacles", MOST_DENSE,
             own->modes ? " or coarser -domain_cells" : ", coarser -domain_cells, or -obstacle_factor modes");
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ObstaclesPlaceMarkers(Scene scene, const Outlines *o, SceneObstacles *own) {
  Shape *shape = &own->outline;
  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(shape->digest, o->of[0].curve.digest, DIGEST));
  PetscCall(ObstaclesCreateShape(scene, o, shape));
  PetscCall(ObstaclesChooseFactor(scene, o, own));
  PetscCall(PetscMalloc2(scene->shape.vesicles + o->count, &own->holder, o->count, &own->vesicle));
  PetscCall(PetscCalloc4(2 * o->count, &own->velocity, o->count, &own->turn, o->count, &own->container, o->count,
                         &own->wall));
  own->circles = own->shape == OBSTACLE_POSTS || own->shape == OBSTACLE_COUETTE ? PETSC_TRUE : PETSC_FALSE;
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
  Outlines o = {0};
  PetscFunctionBeginUser;
  if (scene->obstacles.shape == OBSTACLE_NONE) scene->obstacles.moving = PETSC_FALSE;
  if (scene->obstacles.shape == OBSTACLE_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->obstacles.shape == OBSTACLE_POSTS) PetscCall(ObstaclesMakePosts(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_COUETTE) PetscCall(ObstaclesMakeCouette(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_CONSTRICTION) PetscCall(ObstaclesMakeConstriction(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_FILE) PetscCall(ObstaclesMakeFromFile(scene, &o));
  for (PetscInt k = 0; k < o.count; k++) {
    Outline *one = &o.of[k];
    one->wall = -1;
    if (one->curve.kind.type == CURVE_OPEN) PetscCall(ArcCut(scene, k, &one->curve, one->part, &one->wall));
  }
  PetscCall(ObstaclesPlaceMarkers(scene, &o, &scene->obstacles));
  scene->fluid.held = PETSC_TRUE;
  for (PetscInt k = 0; k < o.count; k++) PetscCall(CurveDestroy(&o.of[k].curve));
  PetscCall(PetscFree(o.of));
  PetscCall(SceneCheckObstacles(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDropObstacles(Draft scene) {
  SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  if (!own->outline.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShapeDestroy(&own->outline));
  PetscCall(PetscFree2(own->holder, own->vesicle));
  PetscCall(PetscFree4(own->velocity, own->turn, own->container, own->wall));
  PetscFunctionReturn(PETSC_SUCCESS);
}
