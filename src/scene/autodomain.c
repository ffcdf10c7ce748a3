/* -scheme_auto: boundaries, box and grid, where they are not given (docs/settings.md). */
#include "scene/auto.h"
#include "scene/checks.h"
#include "scene/properties.h"
#include "scene/vesicles.h"

/* Error of a vesicle in walls or periods over (R0/W)^2, W from its middle to a side of the box, against unbounded
   fluid, the worst of the calibration (tests/program/test_auto.py compares with the table). */
#define OF_IMAGES 1.9
#define MOST_BOX 1024 /* cells across, of a box that goes by them */

#define WINDOW 3        /* R0 around the vesicles, in unbounded fluid */
#define WINDOW_CELLS 10 /* a R0: what fields ask for */
#define MOST_WINDOW 512 /* cells across */

#define LEAST_CELLS 3      /* a R0, below which the fields show nothing */
#define BESIDE_OBSTACLES 2 /* times the cells: they are not in the calibration */

/* TRUE if -scheme_auto may choose the box: not in a channel, under gravity, among obstacles, with a packing, or in a
   custom flow. */
static PetscBool BoxIsOpen(Scene s) {
  const PetscInt flow = s->flow.type;
  if (flow == FLOW_POISEUILLE || flow == FLOW_CUSTOM || s->obstacles.shape != OBSTACLE_NONE) return PETSC_FALSE;
  return s->vesicles.packing == 0 && s->gravity.g.n == 2 && !SceneHasGravity(s);
}

static PetscErrorCode SceneCountVesicles(Scene s, PetscInt *count) {
  Curve *curve;
  PetscFunctionBeginUser;
  *count = s->vesicles.count;
  if (s->vesicles.shape != SHAPE_FILE || !*s->vesicles.file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CurvesFromFile(s->comm, "-vesicle_file", s->vesicles.file, NULL, count, &curve, NULL));
  for (PetscInt k = 0; k < *count; k++) PetscCall(CurveDestroy(&curve[k]));
  PetscCall(PetscFree(curve));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Find out whether the scene asks for something that unbounded fluid does not have. */
static PetscErrorCode SceneNeedsGrid(Scene s, PetscBool *needs) {
  const PetscBool box_part = SceneGiven(s, "-coupling_box_part") && s->coupling.box_part;
  PetscInt count;
  PetscFunctionBeginUser;
  PetscCall(SceneCountVesicles(s, &count));
  *needs = strcmp(s->scheme.type, "coupled") || s->coupling.near_field != NEAR_EXACT || box_part ||
           s->fluid.inertia == INERTIA_UNSTEADY || s->fluid.inertia == INERTIA_CONVECTIVE || count > SCENE_MOST_FREE ||
           SceneGiven(s, "-helmholtz_type") || SceneGiven(s, "-poisson_type");
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define UNBOUNDED "nothing asks for walls: unbounded, quasi-steady fluid"

/* Choose boundaries where the user gives neither box nor boundaries and -scheme_auto may choose the box. The fluid is
   unbounded; a scene that needs a grid has a period in x, except in extension, which is not periodic. */
PetscErrorCode SceneSuggestBoundaryX(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  PetscBool needs = PETSC_TRUE;
  PetscFunctionBeginUser;
  if (SceneGiven(s, "-domain_box")) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(why, AUTO_TEXT, "the default");
  if (SceneGiven(s, "-domain_bc_y") || s->vesicles.shape == SHAPE_NONE || !BoxIsOpen(s))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SceneNeedsGrid(s, &needs));
  if (needs && s->flow.type == FLOW_EXTENSION) PetscFunctionReturn(PETSC_SUCCESS);
  (void)snprintf(value, AUTO_TEXT, needs ? "periodic" : "free");
  (void)snprintf(why, AUTO_TEXT, needs ? "the default: a place between four walls is not stable" : UNBOUNDED);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneSuggestBoundaryY(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscBool free = FluidSpecIsFree(&s->fluid) && !SceneGiven(s, "-domain_bc_x");
  if (free) (void)snprintf(value, AUTO_TEXT, "free");
  if (free || !SceneGiven(s, "-domain_box")) (void)snprintf(why, AUTO_TEXT, free ? UNBOUNDED : "the default");
  return PETSC_SUCCESS;
}

/* The numbers that box and grid follow from: radii, the rectangle around all vesicles, and the least distance of a
   vesicle from a wall of the box. Packed vesicles are as near to walls as the grid allows. */
typedef struct {
  PetscInt vesicles;
  PetscReal small, large, around[4], gap;
} Extent;

static PetscErrorCode ExtentMeasure(Draft s, Extent *e) {
  const PetscReal *box = s->domain.box.v;
  Kinds kinds;
  Pose *pose;
  PetscFunctionBeginUser;
  PetscCall(KindsCreate(s, &kinds));
  *e = (Extent){kinds.vesicles, PETSC_MAX_REAL, 0, CURVE_NOWHERE, PETSC_MAX_REAL};
  for (PetscInt k = 0; k < kinds.kinds; k++) {
    e->small = PetscMin(e->small, kinds.kind[k].length / (2 * PETSC_PI));
    e->large = PetscMax(e->large, kinds.kind[k].length / (2 * PETSC_PI));
  }
  PetscCall(PetscMalloc1(kinds.vesicles, &pose));
  if (s->vesicles.packing == 0) {
    PetscCall(ScenePlace(s, &kinds, pose));
    for (PetscInt v = 0; v < kinds.vesicles; v++) KindExtend(&kinds.kind[kinds.of[v]], &pose[v], e->around);
    for (int d = 0; d < 2; d++)
      if (s->fluid.bc[d] == BC_WALL)
        e->gap = PetscMin(e->gap, PetscMin(e->around[2 * d] - box[2 * d], box[2 * d + 1] - e->around[2 * d + 1]));
  }
  PetscCall(PetscFree(pose));
  PetscCall(KindsDestroy(&kinds));
  PetscCall(SceneDropShape(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* x with two digits, rounded up (1), or to the nearest (0). */
static PetscReal BoxRounded(PetscReal x, PetscReal unit, PetscBool up) {
  return unit * (up ? PetscCeilReal(x / unit * (1 - 1e-9)) : PetscFloorReal(x / unit + 0.5));
}

/* Radii from a vesicle's middle to the sides of a box whose images leave half of the error. */
static PetscReal BoxReach(Scene s, PetscInt vesicles) {
  return PetscSqrtReal(2 * OF_IMAGES * vesicles / s->scheme.wanted);
}

/* The box is centred on the vesicles. Half its shorter side is half the extent of the vesicles plus the reach of the
   images; the sides are in proportion to cells that are given. */
PetscErrorCode SceneSuggestBox(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscBool free = FluidSpecIsFree(&s->fluid);
  PetscReal side[2], middle[2];
  Extent e;
  PetscFunctionBeginUser;
  if (!free && !BoxIsOpen(s))
    PetscCall(PetscStrncpy(why, "the default: walls are part of this scene, the box is yours to give", AUTO_TEXT));
  if (s->vesicles.shape == SHAPE_NONE || !(free || BoxIsOpen(s))) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ExtentMeasure(s, &e));
  if (free)
    PetscCall(PetscSNPrintf(why, AUTO_TEXT, "the window of the fields, %d R0 around the vesicles", WINDOW));
  else
    PetscCall(PetscSNPrintf(why, AUTO_TEXT, "%.3g R0 around the vesicles: its images leave up to %.1e",
                            (double)BoxReach(s, e.vesicles), (double)(s->scheme.wanted / 2)));
  const PetscReal wide = PetscMax(e.around[1] - e.around[0], e.around[3] - e.around[2]) / 2;
  const PetscReal half = wide + (free ? WINDOW : BoxReach(s, e.vesicles)) * e.large;
  const PetscReal unit = PetscPowReal(10, PetscFloorReal(PetscLog10Real(half)) - 1);
  for (int d = 0; d < 2; d++) {
    const PetscInt n = s->domain.cells.v[d], other = s->domain.cells.v[1 - d];
    const PetscBool longer = SceneGiven(s, "-domain_cells") && n > other;
    side[d] = BoxRounded(half, unit, PETSC_TRUE) * (longer ? (PetscReal)n / other : 1);
    middle[d] = BoxRounded((e.around[2 * d] + e.around[2 * d + 1]) / 2, unit, PETSC_FALSE);
  }
  PetscCall(PetscSNPrintf(value, AUTO_TEXT, "%.14g,%.14g,%.14g,%.14g", (double)(middle[0] - side[0]),
                          (double)(middle[0] + side[0]), (double)(middle[1] - side[1]), (double)(middle[1] + side[1])));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Edge of the largest cell that the error allows; in unbounded fluid the edge of the cells of the fields. */
static PetscReal GridLargestCell(Scene s, const Extent *e) {
  const PetscReal *box = s->domain.box.v, across = PetscMin(box[1] - box[0], box[3] - box[2]);
  const PetscReal finer = s->obstacles.shape == OBSTACLE_NONE ? 1 : BESIDE_OBSTACLES;
  if (FluidSpecIsFree(&s->fluid)) return PetscMax(e->small / WINDOW_CELLS, across / MOST_WINDOW);
  return e->small /
         (finer * PetscMax(LEAST_CELLS, SceneCellsFor(SceneAutoFluid(s, e->large), s->scheme.wanted / 2, PETSC_TRUE)));
}

/* clang-format off */
PetscErrorCode SceneSuggestCells(Draft s, char value[AUTO_TEXT], char why[AUTO_TEXT]) {
  const PetscReal *box = s->domain.box.v;
  const PetscBool free = FluidSpecIsFree(&s->fluid), by_images = !free && !SceneGiven(s, "-domain_box") && BoxIsOpen(s);
  PetscInt cells[2] = {0, 0};
  Extent e;
  PetscFunctionBeginUser;
  if (free)
    PetscCall(PetscSNPrintf(why, AUTO_TEXT, "of the fields alone, R0/%d", WINDOW_CELLS));
  else
    PetscCall(PetscSNPrintf(why, AUTO_TEXT, "the fewest square ones that are enough%s",
                            s->obstacles.shape != OBSTACLE_NONE ? ", twice as many beside obstacles" : ""));
  if (s->vesicles.shape == SHAPE_NONE) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ExtentMeasure(s, &e));
  const PetscReal h = GridLargestCell(s, &e);
  const PetscReal across = PetscCeilReal(PetscMax(box[1] - box[0], box[3] - box[2]) / h * (1 - 1e-9));
  const SceneRule rules[] = {
    {by_images && across > MOST_BOX,
     "-scheme_auto {-scheme_auto}: a box so large that its images leave half of it takes %g cells across; allowed: -domain_bc_x free -domain_bc_y free, a -domain_box, or a larger error", {across}},
    {!SceneSquareCells(box, h, cells),
     "-scheme_auto {-scheme_auto}: no square cells of %.3g, for the smallest vesicle, fill -domain_box {-domain_box} with up to %.0f in a direction; allowed: -domain_cells, or a box whose sides are in a simple ratio", {h, SCENE_MOST_ACROSS}}};
  PetscCall(REFUSE(s, rules));
  if (!free && e.gap > 0 && e.gap < PETSC_MAX_REAL)
    (void)SceneWallCells(SceneAutoFluid(s, e.large), box, h, e.small, e.gap, s->scheme.wanted / 2, cells);
  PetscCall(PetscSNPrintf(value, AUTO_TEXT, "%" PetscInt_FMT ",%" PetscInt_FMT, cells[0], cells[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}
/* clang-format on */
