/* The obstacles of a scene: circles, bumps or curves of a file, markers at equal distances on them, and what their
   surfaces do. */
#include "scene/obstacles.h"
#include "scene/checks.h"
#include "scene/openbodies.h"
#include "scene/properties.h"

/* The curves before they have markers. */
typedef struct {
  PetscInt count;
  Curve *curve;
  PetscReal *center; /* [2 count] added to the curve's points */
  CurveNote *note;
  PetscReal *part; /* [2 count] of the parameter of open ones, that markers are on */
  PetscInt *wall;  /* [count] that open ones are on */
} Outlines;

/* Columns and rows of posts over the whole box, each row a part of a column further than the one below. */
static void PlaceLattice(Scene scene, PetscReal center[]) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscReal *b = scene->fluid.box;
  const PetscInt columns = own->lattice.v[0], rows = own->lattice.v[1];
  const PetscReal dx = (b[1] - b[0]) / columns, dy = (b[3] - b[2]) / rows;
  for (PetscInt k = 0; k < columns * rows; k++) {
    const PetscReal at = k % columns + 0.5 + k / columns * own->shift;
    center[2 * k] = b[0] + dx * (at - columns * PetscFloorReal(at / columns));
    center[2 * k + 1] = b[2] + dy * (k / columns + 0.5);
  }
}

static PetscErrorCode CheckLattice(Scene scene) {
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

static PetscErrorCode CreateOutlines(Scene scene, PetscInt count, Outlines *o) {
  PetscFunctionBeginUser;
  o->count = count;
  PetscCall(PetscCalloc1(count, &o->curve));
  PetscCall(PetscCalloc1(2 * count, &o->center));
  PetscCall(PetscCalloc1(count, &o->note));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Make circles, with the velocity and rotation that the options give each of them. */
static PetscErrorCode MakeCircles(Scene scene, PetscInt count, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const PetscBool lattice = own->lattice.n == 2 && own->lattice.v[0] > 0 ? PETSC_TRUE : PETSC_FALSE;
  PetscFunctionBeginUser;
  PetscCall(CreateOutlines(scene, count, o));
  PetscCall(SceneCheckList(scene, "-obstacle_radius", own->radius.n, 1, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_velocity", own->move.n, 2, count, "obstacles", "each"));
  PetscCall(SceneCheckList(scene, "-obstacle_rotation", own->rotation.n, 1, count, "obstacles", "each"));
  if (lattice) PlaceLattice(scene, o->center);
  for (PetscInt k = 0; k < count; k++)
    for (int c = 0; c < 2; c++) {
      o->curve[k].axes[c] = ListEntry(&own->radius, 1, k, 0);
      if (!lattice) o->center[2 * k + c] = ListEntry(&own->center, 2, k, c);
      o->note[k].velocity[c] = ListEntry(&own->move, 2, k, c);
      o->note[k].rotation = ListEntry(&own->rotation, 1, k, 0);
    }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakePosts(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  PetscCall(CheckLattice(scene));
  const PetscInt count = own->lattice.v[0] * own->lattice.v[1];
  PetscCheck(!count || !SceneGiven(scene, "-obstacle_center"), scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_center: given together with -obstacle_lattice; allowed: one of them");
  PetscCheck(count || own->center.n % 2 == 0, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_center: %" PetscInt_FMT " numbers given; allowed: x,y of each post", own->center.n);
  PetscCall(MakeCircles(scene, count ? count : own->center.n / 2, o));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeCouette(Scene scene, Outlines *o) {
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
  PetscCall(MakeCircles(scene, 2, o));
  o->note[1].clockwise = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Two bumps that face one another. */
static PetscErrorCode MakeConstriction(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  const FluidSpec *f = &scene->fluid;
  PetscFunctionBeginUser;
  PetscCheck(f->bc[1] == BC_WALL, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape constriction: its bumps are on the walls y_min and y_max; allowed: -domain_bc_y wall");
  PetscCheck(own->length < f->box[1] - f->box[0], scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_length %g: the box is %g long; allowed: less than that", (double)own->length,
             (double)(f->box[1] - f->box[0]));
  PetscCall(SceneCheckList(scene, "-obstacle_center", own->center.n, 2, 1, "obstacles", "each"));
  PetscCall(CreateOutlines(scene, 2, o));
  for (int side = 0; side < 2; side++) PetscCall(ArcBump(scene, side, &o->curve[side]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeFromFile(Scene scene, Outlines *o) {
  const SceneObstacles *own = &scene->obstacles;
  PetscReal period[2];
  PetscFunctionBeginUser;
  PetscCheck(*own->file, scene->comm, PETSC_ERR_USER_INPUT,
             "-obstacle_shape file: no -obstacle_file given; allowed: a text file with x y a line");
  FluidSpecPeriods(&scene->fluid, period);
  PetscCall(CurvesFromFile(scene->comm, "-obstacle_file", own->file, period, &o->count, &o->curve, &o->note));
  PetscCall(PetscCalloc1(2 * o->count, &o->center));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Find the parts of open curves that carry markers. */
static PetscErrorCode Cut(Scene scene, Outlines *o) {
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(2 * o->count, &o->part, o->count, &o->wall));
  for (PetscInt k = 0; k < o->count; k++) {
    o->wall[k] = -1;
    if (o->curve[k].kind.type == CURVE_OPEN) PetscCall(ArcCut(scene, k, &o->curve[k], o->part + 2 * k, &o->wall[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define LEAST_MARKERS 15
#define MOST_MARKERS 40000
#define MOST_DENSE 4000    /* markers that a dense block of the preconditioner may have */
#define MOST_TOGETHER 2000 /* markers up to which all obstacles share a dense block */

/* An odd number of markers on each curve that repeats; on open ones none farther apart than wanted, so that the first
   is half a spacing off its wall. */
static PetscErrorCode Number(Scene scene, const Outlines *o, Shape *shape) {
  const PetscReal spacing = scene->obstacles.spacing * FluidSpecCellSize(&scene->fluid);
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < o->count; k++) {
    const PetscBool open = o->curve[k].kind.type == CURVE_OPEN ? PETSC_TRUE : PETSC_FALSE;
    const PetscReal *part = o->part + 2 * k;
    const PetscReal length = open ? CurvePartLength(&o->curve[k], part[0], part[1]) : CurveLength(&o->curve[k]);
    const PetscReal wanted = length / spacing;
    PetscCheck(shape->start[k] + wanted <= MOST_MARKERS, scene->comm, PETSC_ERR_USER_INPUT,
               "-obstacle_spacing %g: more than %d markers on the obstacles; allowed: at most that many, so a larger "
               "spacing, fewer obstacles or coarser -domain_cells",
               (double)scene->obstacles.spacing, MOST_MARKERS);
    const PetscInt n = open ? 1 + (PetscInt)PetscCeilReal(wanted) : 2 * (PetscInt)PetscFloorReal(wanted / 2) + 1;
    shape->start[k + 1] = shape->start[k] + PetscMax(LEAST_MARKERS, n);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Choose whether each obstacle has its own block in the preconditioner (-obstacle_factor). */
static PetscErrorCode ChooseFactor(Scene scene, const Outlines *o, SceneObstacles *own) {
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

static PetscErrorCode PlaceMarkers(Scene scene, const Outlines *o, SceneObstacles *own) {
  Shape *shape = &own->outline;
  PetscFunctionBeginUser;
  shape->vesicles = o->count;
  PetscCall(PetscStrncpy(shape->digest, o->curve[0].digest, DIGEST));
  PetscCall(PetscCalloc1(o->count + 1, &shape->start));
  PetscCall(Number(scene, o, shape));
  PetscCall(ChooseFactor(scene, o, own));
  PetscCall(PetscMalloc1(2 * shape->start[o->count], &shape->X));
  PetscCall(PetscMalloc1(o->count, &shape->kind));
  PetscCall(PetscMalloc2(scene->shape.vesicles + o->count, &own->holder, o->count, &own->vesicle));
  PetscCall(PetscCalloc5(2 * o->count, &own->velocity, o->count, &own->turn, o->count, &own->container, o->count,
                         &own->circle, o->count, &own->wall));
  for (PetscInt k = 0; k < o->count; k++) {
    PetscReal *X = shape->X + 2 * shape->start[k];
    const PetscInt n = shape->start[k + 1] - shape->start[k];
    shape->kind[k] = o->curve[k].kind;
    own->wall[k] = o->wall[k];
    const PetscReal *part = o->curve[k].kind.type == CURVE_OPEN ? o->part + 2 * k : NULL;
    PetscCall(CurveEqualArcs(&o->curve[k], part, n, X));
    for (PetscInt j = 0; j < 2 * n; j++) X[j] += o->center[2 * k + j % 2];
    for (int c = 0; c < 2; c++) own->velocity[2 * k + c] = o->note[k].velocity[c];
    own->turn[k] = o->note[k].rotation;
    own->circle[k] = own->shape == OBSTACLE_POSTS || own->shape == OBSTACLE_COUETTE ? PETSC_TRUE : PETSC_FALSE;
    own->container[k] = o->curve[k].kind.type == CURVE_CLOSED ? o->note[k].clockwise : PETSC_FALSE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneMakeObstacles(Draft scene) {
  Outlines o = {0};
  PetscFunctionBeginUser;
  if (scene->obstacles.shape == OBSTACLE_NONE) scene->obstacles.moving = PETSC_FALSE;
  if (scene->obstacles.shape == OBSTACLE_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  if (scene->obstacles.shape == OBSTACLE_POSTS) PetscCall(MakePosts(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_COUETTE) PetscCall(MakeCouette(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_CONSTRICTION) PetscCall(MakeConstriction(scene, &o));
  if (scene->obstacles.shape == OBSTACLE_FILE) PetscCall(MakeFromFile(scene, &o));
  PetscCall(Cut(scene, &o));
  PetscCall(PlaceMarkers(scene, &o, &scene->obstacles));
  scene->fluid.held = PETSC_TRUE;
  for (PetscInt k = 0; k < o.count; k++) PetscCall(CurveDestroy(&o.curve[k]));
  PetscCall(PetscFree(o.curve));
  PetscCall(PetscFree(o.center));
  PetscCall(PetscFree(o.note));
  PetscCall(PetscFree2(o.part, o.wall));
  PetscCall(SceneCheckObstacles(scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDropObstacles(Draft scene) {
  SceneObstacles *own = &scene->obstacles;
  PetscFunctionBeginUser;
  if (!own->outline.vesicles) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ShapeDestroy(&own->outline));
  PetscCall(PetscFree2(own->holder, own->vesicle));
  PetscCall(PetscFree5(own->velocity, own->turn, own->container, own->circle, own->wall));
  PetscFunctionReturn(PETSC_SUCCESS);
}
